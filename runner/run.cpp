#include "runner/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "contract/input_error.h"
#include "runner/dispatcher.h"
#include "runner/progress.h"
#include "runner/scene_check.h"
#include "runner/spool.h"
#include "runner/status.h"
#include "runner/worker_process.h"

namespace peclet::runner {
namespace {

constexpr int exit_converged = 0;
constexpr int exit_unconverged = 3;
constexpr int exit_integrity = 6;
constexpr int exit_stopped = 75;

// A seed may fail so often beyond the first time.
constexpr int retries = 2;

struct Team {
  int workers, threads;
};

// What is not given follows from what is: together they fill the machine.
Team team(const RunOptions& options) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (options.workers > 0 && options.threads > 0) return {options.workers, options.threads};
  if (options.workers > 0) return {options.workers, std::max(1, cores / options.workers)};
  const int threads = std::max(1, options.threads);
  return {std::max(1, cores / threads), threads};
}

void refuse_network_file_system(const CampaignDirectory& directory, bool force) {
  const std::optional<std::string> kind = network_file_system(directory.root());
  if (kind && !force) {
    throw InputError(
        directory.root().string(), "", *kind,
        "a campaign must be on a local file system, where locks and fsync can be trusted: choose another "
        "--directory, or --force it at your own risk");
  }
}

int exit_code(Database& database, const Scheduler& scheduler, Dispatcher::Ending ending) {
  const std::vector<PointRecord> points = database.points();
  if (std::any_of(points.begin(), points.end(), [](const PointRecord& point) { return point.suspect; })) {
    return exit_integrity;
  }
  if (ending == Dispatcher::Ending::stopped) return exit_stopped;
  for (int place = 0; place < scheduler.points(); ++place) {
    if (scheduler.looks(place).back().verdict != Verdict::converged) return exit_unconverged;
  }
  return exit_converged;
}

Dispatcher::Ending dispatch(Database& database, Ledger& ledger, const RunOptions& options,
                            const EngineCommand& command, const CampaignDirectory& directory,
                            Progress& progress) {
  const Team size = team(options);
  DispatchSettings settings;
  settings.threads = size.threads;
  settings.lease = std::chrono::duration<double>(options.lease_seconds);
  settings.checkpoint_seconds = options.checkpoint_seconds;
  if (options.time_limit) settings.time_limit = std::chrono::duration<double>(*options.time_limit);
  StopSignals signals;
  ProcessPool pool(size.workers, command, directory, signals);
  Dispatcher dispatcher(database, ledger, pool, progress, settings, std::chrono::steady_clock::now);
  return dispatcher.run();
}

}  // namespace

int run_campaign(const RunOptions& options) {
  const Campaign campaign = read_campaign(options.campaign);
  const EngineCommand command = resolve_engine(campaign, options.campaign);
  const CampaignDirectory directory = campaign_directory(options.campaign, options.directory);
  refuse_network_file_system(directory, options.force);
  check_scenes(campaign, options.campaign, command);

  // From here on things are written.
  std::filesystem::create_directories(directory.root());
  const OwnerLock lock(directory);
  create_folders(directory);
  remove_unfinished_files(directory.spool());
  remove_unfinished_files(directory.checkpoints());
  Database database = Database::open_owner(directory.database());
  Queue(database).adopt(campaign);

  Dispatcher::Ending ending{};
  int code = 0;
  {
    Progress progress(Progress::style_of_stderr(options.quiet));
    Ledger ledger(database, campaign, directory, progress, retries);
    ending = dispatch(database, ledger, options, command, directory, progress);
    code = exit_code(database, ledger.scheduler(), ending);
  }
  std::fputs(status_table(database).c_str(), stdout);
  return code;
}

}  // namespace peclet::runner
