#include "runner/hand_over.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "contract/input_error.h"
#include "runner/bundles.h"
#include "runner/dispatcher.h"
#include "runner/owned_campaign.h"
#include "runner/progress.h"
#include "runner/requests.h"
#include "runner/status.h"
#include "runner/stop_signals.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Where the batch system does not say how many tasks a job may have.
constexpr int usual_largest_array = 1000;
// Turns in a row in which tasks went without having begun and no seed ended: the next ones would fare no
// better.
constexpr int most_lifeless_turns = 3;
// After the last point is decided, for tasks that were cancelled.
constexpr std::chrono::seconds leaving_patience{60};

fs::path shared_folder(const HandOverOptions& options, Database& database) {
  if (!options.shared.empty()) return fs::absolute(options.shared).lexically_normal();
  const std::string last = BundleBook(database.connection()).last_shared();
  if (last.empty()) {
    throw InputError(
        "", "", "--shared",
        "must name a folder that this machine and the nodes see in the same place; later hand-overs use "
        "the same one unless told otherwise");
  }
  return last;
}

BundleSettings bundle_settings(const HandOverOptions& options, OwnedCampaign& owned) {
  BundleSettings settings;
  settings.shared = shared_folder(options, owned.database);
  settings.scripts = batch_template(options.system, options.template_folder);
  settings.seeds_per_task = options.seeds_per_task;
  settings.largest_array = options.largest_array > 0 ? options.largest_array
                                                     : largest_array(settings.scripts, usual_largest_array);
  settings.threads = options.threads;
  settings.lease_seconds = options.lease_seconds;
  settings.checkpoint_seconds = options.checkpoint_seconds;
  settings.ahead = options.ahead;
  settings.options = options.options;
  settings.engine = {owned.command.program.string()};
  settings.engine.insert(settings.engine.end(), owned.command.arguments.begin(),
                         owned.command.arguments.end());
  settings.engine_folder = owned.command.folder;
  settings.engine_provenance = owned.engine;
  settings.program = fs::read_symlink("/proc/self/exe").string();
  return settings;
}

// Settles and hands over, turn by turn.
class Follower {
 public:
  Follower(Ledger& ledger, Bundles& bundles, Requests& requests, Progress& progress,
           const HandOverOptions& options)
      : ledger_(ledger),
        bundles_(bundles),
        requests_(requests),
        progress_(progress),
        options_(options),
        started_(Clock::now()) {}

  // True when every point is decided, false when a signal came first.
  bool run(const BundleSettings& settings) {
    StopSignals signals;
    for (;;) {
      const Bundles::Settled settled = bundles_.settle();
      give_up_on_lifeless_tasks(settled);
      requests_.carry_out();
      if (ledger_.scheduler().finished()) break;
      bundles_.submit_unconfirmed();
      bundles_.hand_over(settings);
      report(settled);
      if (wait(signals)) {
        progress_.note("stopped; jobs go on, and the same command or `peclet ingest` takes their results in");
        return false;
      }
    }
    return call_back(signals);
  }

 private:
  // Until the next turn is due, or somebody asks for something. True: a signal came.
  bool wait(StopSignals& signals) {
    const auto end = Clock::now() + std::chrono::duration<double>(options_.interval);
    for (;;) {
      const double left = std::chrono::duration<double>(end - Clock::now()).count();
      if (came(signals, std::clamp(left, 0.0, 1.0))) return true;
      if (left <= 0 || requests_.any_waits()) return false;
    }
  }

  static bool came(StopSignals& signals, double seconds) {
    pollfd watched{signals.descriptor(), POLLIN, 0};
    return poll(&watched, 1, static_cast<int>(1000 * seconds)) > 0 && signals.take();
  }

  void give_up_on_lifeless_tasks(const Bundles::Settled& settled) {
    if (settled.ended > 0) lifeless_turns_ = 0;
    if (!settled.lifeless.empty() && ++lifeless_turns_ >= most_lifeless_turns)
      throw EngineError(settled.lifeless);
  }

  void report(const Bundles::Settled& settled) {
    results_ += settled.ended;
    RunReport report = ledger_.report(1);
    report.to_go.reset();  // the batch system knows when, if anybody does
    report.results = results_;
    report.elapsed = std::chrono::duration<double>(Clock::now() - started_).count();
    progress_.report(report);
  }

  // What is still out is surplus: cancelled, and taken in when it has gone.
  bool call_back(StopSignals& signals) {
    if (bundles_.settle().open == 0) return true;
    progress_.note("every point is decided; the jobs that are left are cancelled");
    bundles_.cancel();
    const auto patience = Clock::now() + leaving_patience;
    while (Clock::now() < patience && bundles_.settle().open > 0) {
      if (came(signals, std::min(options_.interval, 2.0))) break;
    }
    return true;
  }

  Ledger& ledger_;
  Bundles& bundles_;
  Requests& requests_;
  Progress& progress_;
  const HandOverOptions& options_;
  Clock::time_point started_;
  int results_ = 0, lifeless_turns_ = 0;
};

void admit(Ledger& ledger, const OwnedCampaign& owned, const HandOverOptions& options, Progress& progress) {
  if (!options.accept_engine.empty() && !options.dry_run) {
    accept_engine(ledger, owned.engine, options.accept_engine, progress);
  }
  try {
    ledger.admit_engine(owned.engine);
  } catch (const OtherEngine& error) {
    throw OtherEngine(error.what() + acceptance_hint("hand-over ...", owned.engine));
  }
}

std::string standing_text(Database& database) {
  std::string text;
  for (const HandedOver& bundle : BundleBook(database.connection()).handed_over()) {
    text += fmt::format("{}: {} seeds are out, job {}\n", bundle.bundle, bundle.seeds,
                        bundle.job.empty() ? "not confirmed" : bundle.job);
  }
  return text.empty() ? "no seed is handed over\n" : text;
}

}  // namespace

int hand_over_campaign(const HandOverOptions& options) {
  batch_template(options.system,
                 options.template_folder);  // a fault in it is found before anything is written
  OwnedCampaign owned(options.campaign, options.directory, options.force);
  const BundleSettings settings = bundle_settings(options, owned);
  bool finished = false;
  int code = 0;
  {
    Progress progress(Progress::style_of_stderr(options.quiet));
    Ledger ledger(owned.database, owned.campaign, owned.directory, progress, retries);
    Requests requests(owned.database, ledger, owned.directory, progress);
    if (!options.dry_run) requests.carry_out();
    admit(ledger, owned, options, progress);
    Bundles bundles(owned.database, ledger, owned.campaign, owned.directory, progress);
    if (options.dry_run) {
      std::fputs(bundles.describe(settings).c_str(), stdout);
      return 0;
    }
    if (!options.follow) {
      bundles.settle();
      bundles.submit_unconfirmed();
      bundles.hand_over(settings);
      std::fputs(standing_text(owned.database).c_str(), stdout);
      return 0;
    }
    finished = Follower(ledger, bundles, requests, progress, options).run(settings);
    code = exit_code(owned.database, ledger.scheduler(), finished);
  }
  std::fputs(status_table(owned.database).c_str(), stdout);
  return code;
}

int ingest_campaign(const IngestOptions& options) {
  OwnedCampaign owned(options.campaign, options.directory, options.force);
  Progress progress(Progress::style_of_stderr(options.quiet));
  Ledger ledger(owned.database, owned.campaign, owned.directory, progress, retries);
  Requests(owned.database, ledger, owned.directory, progress).carry_out();
  Bundles bundles(owned.database, ledger, owned.campaign, owned.directory, progress);
  Bundles::Settled settled = bundles.settle();
  if (options.cancel) {
    bundles.cancel();
    const auto patience = Clock::now() + leaving_patience;
    while (settled.open > settled.unconfirmed && Clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
      settled = bundles.settle();
    }
  }
  std::fputs(standing_text(owned.database).c_str(), stdout);
  return 0;
}

}  // namespace peclet::runner
