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

// Tasks of one job at most, if the batch system does not say.
constexpr int usual_largest_array = 1000;
// Turns in a row, with tasks gone before they began a seed and no seed ended, after which --follow gives up.
constexpr int most_lifeless_turns = 3;
// Time that cancelled tasks get to leave.
constexpr std::chrono::seconds leaving_patience{60};

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

fs::path chosen_folder(const HandOverOptions& options) {
  return fs::absolute(options.shared).lexically_normal();
}

// Checks the options that need no campaign, before anything is written. Throws InputError.
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

// Throws InputError if the shared folder is gone while seeds are out in it. A new one below an unmounted file
// system would hide the old one once that is mounted again.
void refuse_lost_folder(const fs::path& shared, Database& database) {
  std::error_code error;
  if (fs::is_directory(shared, error) || !BundleStore(database.connection()).are_out_in(shared.string()))
    return;
  throw InputError("", "", shared.string(),
                   "is not there, and seeds are out in it: put it back, or give the seeds up with `peclet "
                   "ingest --forget`; `peclet ingest` names the bundles");
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
  settings.device = options.device;
  settings.options = options.options;
  // Later words win, such as --gres=gpu:a100:1 of the user.
  if (options.device == "cuda" && options.system == "slurm")
    settings.options.insert(settings.options.begin(), "--gres=gpu:1");
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

// The loop of --follow: settles bundles and hands seeds over, turn by turn.
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

  // Returns true if every point is decided, false if a signal came first.
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

  // Rolls the state back after an error that passes, such as a full disk or a lock; the next turn tries
  // again. Rethrows any other error.
  void wait_out(const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root_);
    if (!hindrance) throw;
    state_.roll_back();
    if (std::exchange(hindrance_, hindrance->kind()) != hindrance->kind()) {
      progress_.warn(
          fmt::format("{}; jobs go on, and results are taken in {}", hindrance->text, hindrance->end));
    }
  }

  // Throws SubmissionRefused if a job is refused and none is out. While jobs are out, the refusal may be a
  // limit on the user's jobs that passes, so each new one is only told.
  void give_up_on_refusals(const std::string& refusal) {
    if (!refusal.empty() && !bundles_.any_out()) throw SubmissionRefused(refusal);
    if (!refusal.empty() && refusal != refusal_) progress_.warn(refusal + "; it is tried again");
    refusal_ = refusal;
  }

  // Waits until the next turn is due or a request waits. Returns true if a signal came.
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
    report.to_go.reset();  // unknown: it depends on the queue of the batch system
    report.results = results_;
    report.elapsed = std::chrono::duration<double>(Clock::now() - started_).count();
    progress_.report(report);
  }

  // Cancels the jobs that are left, whose seeds are extra, and takes their results in while they leave.
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
  std::string refusal_, hindrance_;  // the last ones that were told
};

void admit(CampaignState& state, const OwnedCampaign& owned, const HandOverOptions& options,
           Progress& progress) {
  const bool is_accepted = !options.accept_engine.empty();
  if (is_accepted && !options.dry_run) accept_engine(state, owned.engine, progress);
  try {
    state.admit_engine(owned.engine);
  } catch (const OtherEngine& error) {
    // A dry run sets nothing aside, so that it cannot describe what would be handed over.
    if (is_accepted) {
      throw OtherEngine(
          error.what() +
          std::string(
              ". Without --dry-run, --accept-engine sets these results aside, and the points begin again"));
    }
    const std::string words = fmt::format("hand-over {} {}", shell_word(options.system),
                                          words_for(options.campaign, options.directory));
    throw OtherEngine(error.what() + acceptance_hint(words, owned.engine));
  }
}

// Throws InputError for a name that never was that of a bundle. A bundle that has been settled is accepted,
// because there is nothing to forget.
void check_names(const std::vector<std::string>& names, Database& database) {
  const BundleStore book(database.connection());
  for (const std::string& name : names) {
    if (book.has(name)) continue;
    std::vector<std::string> out;
    for (const HandedOver& bundle : book.handed_over()) out.push_back(bundle.bundle);
    throw InputError("", "", "--forget " + name,
                     out.empty() ? "is not a bundle; no seed is handed over"
                                 : fmt::format("is not a bundle; the bundles with seeds out are: {}",
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
  choose_device(options.device);
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
