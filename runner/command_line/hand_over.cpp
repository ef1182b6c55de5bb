#include "runner/command_line/hand_over.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/errors.h"
#include "runner/batch/bundles.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/engines/engine_process.h"
#include "runner/maintenance/backup.h"
#include "runner/owner/dispatcher.h"
#include "runner/owner/owned_campaign.h"
#include "runner/owner/pause.h"
#include "runner/owner/progress.h"
#include "runner/owner/request_handler.h"
#include "runner/reports/status.h"

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

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

fs::path chosen_folder(const HandOverOptions& options) {
  return fs::absolute(options.shared).lexically_normal();
}

// What can be found without the campaign, so that nothing is written before.
void check(const HandOverOptions& options) {
  const BatchTemplate scripts = batch_template(options.system, options.template_folder);
  if (!options.shared.empty()) check_template(scripts, chosen_folder(options), own_program());
}

fs::path shared_folder(const HandOverOptions& options, Database& database) {
  if (!options.shared.empty()) return chosen_folder(options);
  const std::string last = BundleStore(database.connection()).last_shared();
  if (last.empty()) {
    throw InputError("", "", "--shared",
                     "must name a folder that this machine and the nodes see in the same place; later "
                     "hand-overs use the same one unless told otherwise");
  }
  return last;
}

// Made anew below a file system that is not mounted, it would hide what comes back with it.
void refuse_lost_folder(const fs::path& shared, Database& database) {
  std::error_code error;
  if (fs::is_directory(shared, error) || !BundleStore(database.connection()).are_out_in(shared.string()))
    return;
  throw InputError("", "", shared.string(),
                   "is not there, and seeds are out in it: put it back, or give them up with `peclet ingest "
                   "--forget`; `peclet ingest` names the bundles");
}

BundleSettings bundle_settings(const HandOverOptions& options, OwnedCampaign& owned) {
  BundleSettings settings;
  settings.shared = shared_folder(options, owned.database);
  refuse_lost_folder(settings.shared, owned.database);
  settings.scripts = batch_template(options.system, options.template_folder);
  settings.program = own_program();
  check_template(settings.scripts, settings.shared, settings.program);
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
  return settings;
}

// Returns why the batch system takes no job; "" if it has taken what there was.
std::string submit(Bundles& bundles, const BundleSettings& settings) {
  const std::string refusal = bundles.submit_unconfirmed();
  return refusal.empty() ? bundles.hand_over(settings) : refusal;
}

// Settles and hands over, turn by turn.
class Follower {
 public:
  Follower(CampaignState& state, Bundles& bundles, RequestHandler& requests, Progress& progress,
           const CampaignDirectory& directory, const HandOverOptions& options)
      : state_(state),
        bundles_(bundles),
        requests_(requests),
        progress_(progress),
        root_(directory.root()),
        options_(options),
        started_(Clock::now()),
        backup_(directory, std::chrono::duration<double>(options.backup_seconds), progress, started_) {}

  // True when every point is decided, false when a signal came first.
  bool run(const BundleSettings& settings) {
    const bool finished = follow(settings);
    backup_.finish();
    return finished;
  }

 private:
  bool follow(const BundleSettings& settings) {
    StopSignals signals;
    for (;;) {
      try {
        const Bundles::SettleReport settled = bundles_.settle();
        give_up_on_lifeless_tasks(settled);
        requests_.carry_out();
        if (state_.scheduler().finished()) break;
        give_up_on_refusals(submit(bundles_, settings));
        report(settled);
        hindrance_.clear();
      } catch (const std::exception& error) {
        wait_out(error);
      }
      backup_.attend(Clock::now());
      if (wait(signals)) {
        progress_.note("stopped; jobs go on, and the same command or `peclet ingest` takes their results in");
        return false;
      }
    }
    return call_back(signals);
  }

  // What a turn could not book is found again by the next one; what follows a commit is done by it. Throws
  // what does not pass.
  void wait_out(const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root_);
    if (!hindrance) throw;
    state_.roll_back();
    if (std::exchange(hindrance_, hindrance->kind()) != hindrance->kind()) {
      progress_.warn(
          fmt::format("{}; jobs go on, and results are taken in {}", hindrance->text, hindrance->end));
    }
  }

  // A limit on a user's jobs passes when some of them have ended; what else is refused stays so.
  void give_up_on_refusals(const std::string& refusal) {
    if (!refusal.empty() && !bundles_.any_out()) throw SubmissionRefused(refusal);
    if (!refusal.empty() && refusal != refusal_) progress_.warn(refusal + "; it is tried again");
    refusal_ = refusal;
  }

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

  void give_up_on_lifeless_tasks(const Bundles::SettleReport& settled) {
    if (settled.ended > 0) lifeless_turns_ = 0;
    if (!settled.lifeless.empty() && ++lifeless_turns_ >= most_lifeless_turns)
      throw EngineError(settled.lifeless);
  }

  void report(const Bundles::SettleReport& settled) {
    results_ += settled.ended;
    RunReport report = state_.report(1);
    report.to_go.reset();  // the batch system knows when, if anybody does
    report.results = results_;
    report.elapsed = std::chrono::duration<double>(Clock::now() - started_).count();
    progress_.report(report);
  }

  // What is still out is extra: cancelled, and taken in when it has gone.
  bool call_back(StopSignals& signals) {
    if (!bundles_.settle().any_awaited()) return true;
    progress_.note("every point is decided; the jobs that are left are cancelled");
    bundles_.cancel();
    const auto patience = Clock::now() + leaving_patience;
    while (Clock::now() < patience && bundles_.settle().any_awaited()) {
      if (came(signals, std::min(options_.interval, 2.0))) break;
    }
    return true;
  }

  CampaignState& state_;
  Bundles& bundles_;
  RequestHandler& requests_;
  Progress& progress_;
  fs::path root_;
  const HandOverOptions& options_;
  Clock::time_point started_;
  PeriodicBackup backup_;
  int results_ = 0, lifeless_turns_ = 0;
  std::string refusal_, hindrance_;  // as they were told
};

void admit(CampaignState& state, const OwnedCampaign& owned, const HandOverOptions& options,
           Progress& progress) {
  const bool is_accepted = !options.accept_engine.empty();
  if (is_accepted && !options.dry_run) accept_engine(state, owned.engine, progress);
  try {
    state.admit_engine(owned.engine);
  } catch (const OtherEngine& error) {
    // What would be set aside is not described by what is there now.
    if (is_accepted) {
      throw OtherEngine(
          error.what() +
          std::string(
              ". Without --dry-run --accept-engine keeps its results apart, and the points begin again"));
    }
    const std::string words = fmt::format("hand-over {} {}", shell_word(options.system),
                                          words_for(options.campaign, options.directory));
    throw OtherEngine(error.what() + acceptance_hint(words, owned.engine));
  }
}

// Of a bundle that has been settled meanwhile there is nothing to forget; a name that never was one is a
// mistake.
void check_names(const std::vector<std::string>& names, Database& database) {
  const BundleStore book(database.connection());
  for (const std::string& name : names) {
    if (book.has(name)) continue;
    std::vector<std::string> out;
    for (const HandedOver& bundle : book.handed_over()) out.push_back(bundle.bundle);
    throw InputError("", "", "--forget " + name,
                     out.empty() ? "is no bundle, and no seed is handed over"
                                 : fmt::format("is no bundle; those of which seeds are out are: {}",
                                               fmt::join(out, ", ")));
  }
}

std::string status_text(Database& database) {
  std::string text;
  for (const HandedOver& bundle : BundleStore(database.connection()).handed_over()) {
    text += fmt::format("{}: {} seeds are out, job {}\n", bundle.bundle, bundle.seeds,
                        bundle.job.empty() ? "not confirmed" : bundle.job);
  }
  return text.empty() ? "no seed is handed over\n" : text;
}

}  // namespace

int hand_over_campaign(const HandOverOptions& options) {
  check(options);
  OwnedCampaign owned(options.campaign, options.directory, options.force, options.accept_engine);
  const BundleSettings settings = bundle_settings(options, owned);
  bool finished = false;
  int code = 0;
  {
    Progress progress(Progress::style_of_stderr(options.quiet));
    if (const std::string doubt = doubt_about_file_system(owned.directory.root()); !doubt.empty())
      progress.warn(doubt);
    CampaignState state(owned.database, owned.campaign, owned.directory, progress, retries);
    RequestHandler requests(owned.database, state, owned.directory, progress);
    if (!options.dry_run) requests.carry_out();
    admit(state, owned, options, progress);
    Bundles bundles(owned.database, state, owned.campaign, owned.directory, progress);
    if (options.dry_run) {
      std::fputs(bundles.describe(settings).c_str(), stdout);
      return 0;
    }
    if (!options.follow) {
      bundles.settle();
      const std::string refusal = submit(bundles, settings);
      std::fputs(status_text(owned.database).c_str(), stdout);
      if (!refusal.empty()) throw SubmissionRefused(refusal);
      return 0;
    }
    owned.database.connection().wait_for_locks(1000);  // a lock is waited for turn by turn
    finished = Follower(state, bundles, requests, progress, owned.directory, options).run(settings);
    code = ending(read_status(owned.database), finished);
  }
  std::fputs(status_table(read_status(owned.database, getpid())).c_str(), stdout);
  return code;
}

int ingest_campaign(const IngestOptions& options) {
  OwnedCampaign owned(options.campaign, options.directory, options.force);
  check_names(options.forget, owned.database);
  Progress progress(Progress::style_of_stderr(options.quiet));
  CampaignState state(owned.database, owned.campaign, owned.directory, progress, retries);
  RequestHandler(owned.database, state, owned.directory, progress).carry_out();
  Bundles bundles(owned.database, state, owned.campaign, owned.directory, progress);
  Bundles::SettleReport settled = bundles.settle();
  if (options.cancel) {
    bundles.cancel();
    const auto patience = Clock::now() + leaving_patience;
    while (settled.any_awaited() && Clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
      settled = bundles.settle();
    }
  }
  for (const std::string& name : options.forget) bundles.forget(name);
  if (!options.forget.empty()) settled = bundles.settle();
  const std::string advice = handed_over_advice(BundleStore(owned.database.connection()).handed_over(),
                                                words_for(options.campaign, options.directory));
  std::fputs((status_text(owned.database) + advice).c_str(), stdout);
  return settled.unreachable > 0 ? ExitCode::error : 0;
}

}  // namespace peclet::runner
