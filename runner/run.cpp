#include "runner/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "runner/dispatcher.h"
#include "runner/owned_campaign.h"
#include "runner/progress.h"
#include "runner/status.h"
#include "runner/worker_process.h"

namespace peclet::runner {
namespace {

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
  OwnedCampaign owned(options.campaign, options.directory, options.force);
  int code = 0;
  {
    Progress progress(Progress::style_of_stderr(options.quiet));
    Ledger ledger(owned.database, owned.campaign, owned.directory, progress, retries);
    const Dispatcher::Ending ending =
        dispatch(owned.database, ledger, options, owned.command, owned.directory, progress);
    code = exit_code(owned.database, ledger.scheduler(), ending == Dispatcher::Ending::finished);
  }
  std::fputs(status_table(owned.database).c_str(), stdout);
  return code;
}

}  // namespace peclet::runner
