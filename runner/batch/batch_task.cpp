#include "runner/batch/batch_task.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <random>
#include <tuple>
#include <utility>

#include "contract/durable_file.h"
#include "contract/exit_codes.h"
#include "contract/input_error.h"
#include "contract/integrity_error.h"
#include "runner/batch/bundle_files.h"
#include "runner/engines/attempt_report.h"
#include "runner/engines/engine_error.h"
#include "runner/engines/worker_process.h"
#include "runner/folder/room.h"
#include "runner/folder/spool.h"
#include "runner/owner/dispatcher.h"
#include "runner/text/host_name.h"
#include "runner/text/utc_time.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds longest_wait{500};
// A turn that took longer was not this process's to use: it or the machine stood still.
constexpr std::chrono::seconds longest_turn{5};
constexpr std::chrono::seconds hello_patience{60};
constexpr int the_worker = 0;

struct Stopped {};

// Runs of a task on two nodes (a node that was thought to be dead comes back) write under different names.
std::string name_of_this_run() {
  std::random_device chance;
  return fmt::format("{:08x}{:08x}", chance(), chance());
}

class BatchTask {
 public:
  BatchTask(Manifest manifest, BundleFolder folder, int index, StopSignals& signals)
      : manifest_(std::move(manifest)),
        folder_(std::move(folder)),
        index_(index),
        run_(name_of_this_run()),
        pool_(1, command(), CampaignDirectory(folder_.task(index)), signals) {}

  void run() {
    fs::create_directories(CampaignDirectory(folder_.task(index_)).logs());
    publish_results(folder_, manifest_, index_);
    for (const int place : manifest_.tasks.at(static_cast<std::size_t>(index_))) {
      if (fs::exists(folder_.forgotten())) break;  // its seeds are somebody else's by now
      if (!fs::exists(folder_.ended(place))) run_seed(place);
    }
    fs::remove(folder_.trouble(index_));
  }

 private:
  EngineCommand command() const {
    Campaign named;
    named.engine = manifest_.engine;
    EngineCommand command = resolve_engine(named, folder_.manifest());
    // A batch system sends them to every process of a job.
    command.blocked_signals = {SIGTERM, SIGINT, SIGUSR1};
    // An engine that needs its files there says so when they are not; ours needs none.
    command.folder = fs::is_directory(manifest_.engine_folder) ? manifest_.engine_folder : fs::path();
    return command;
  }

  void run_seed(int place);
  void start_engine();
  void handle(const WorkerEvent& event);
  void take_result(const ResultSpooled& result);
  void exited(const ExitStatus& ending);
  void judge_lease();
  void condemn(AttemptOutcome outcome, const std::string& message);
  void note_running() const { write_report(folder_.running(index_), place_, report_); }
  void end(AttemptOutcome outcome, const std::string& message = "", const ExitStatus& ending = {});

  Manifest manifest_;
  BundleFolder folder_;
  int index_;
  std::string run_;
  ProcessPool pool_;
  bool engine_there_ = false, engine_ready_ = false, stopping_ = false;

  // Of the seed in hand.
  int place_ = 0;
  Job job_;
  AttemptReport report_;
  int phase_ = 0;
  bool busy_ = false, drained_ = false;
  Clock::time_point noted_{}, heard_{};
  // The time during which this process ran: a job that was suspended as a whole has lost none of its lease.
  std::chrono::duration<double> awake_{}, renewed_{};
  std::optional<std::pair<AttemptOutcome, std::string>> condemned_;
};

void BatchTask::start_engine() {
  const auto patience = Clock::now() + hello_patience;
  while (!engine_ready_) {
    if (!engine_there_) {
      if (stopping_) throw Stopped{};
      pool_.start(the_worker);
      engine_there_ = true;
    }
    for (const WorkerEvent& event : pool_.wait(longest_wait)) handle(event);
    if (Clock::now() > patience) throw EngineError("the engine did not say hello");
  }
}

void BatchTask::run_seed(int place) {
  if (stopping_) throw Stopped{};
  start_engine();
  if (stopping_) throw Stopped{};
  const BundledSeed& seed = manifest_.seeds.at(static_cast<std::size_t>(place));
  place_ = place;
  job_ = Job{place + 1,
             seed.point,
             seed.seed,
             manifest_.scenes.at(seed.point),
             manifest_.threads,
             folder_.shared().checkpoint(seed.point, seed.seed),
             folder_.task(index_) / (result_name(seed) + run_ + ".result"),
             folder_.shared().failures(),
             manifest_.checkpoint_seconds,
             std::min(1.0, manifest_.lease_seconds / 5)};
  report_.outcome = AttemptOutcome::running;
  report_.step = 0;
  report_.host = host_name();
  report_.process = pool_.process(the_worker);
  report_.started_at = utc_now();
  phase_ = 0;
  noted_ = heard_ = Clock::now();
  renewed_ = awake_;
  condemned_.reset();
  busy_ = true;
  note_running();
  pool_.assign(the_worker, job_);
  while (busy_) {
    for (const WorkerEvent& event : pool_.wait(longest_wait)) handle(event);
    judge_lease();
  }
  if (drained_) throw Stopped{};
}

void BatchTask::handle(const WorkerEvent& event) {
  if (const auto* hello = std::get_if<Hello>(&event)) {
    report_.engine = hello->engine;
    std::string identity;
    try {
      identity = engine_identity(hello->engine);
    } catch (const ResultError& error) {
      throw EngineError(fmt::format("the engine's hello does not say what it is: {}", error.what()));
    }
    if (identity != manifest_.engine_identity) {
      throw IntegrityError(
          fmt::format("the engine is {}, the owner's is {}; PECLET_INSTRUCTION_SET makes machines of "
                      "different kinds alike",
                      identity, manifest_.engine_identity));
    }
    engine_ready_ = true;
  } else if (const auto* progress = std::get_if<Progressed>(&event)) {
    if (!busy_ || progress->job != job_.attempt) return;
    // Steps count; being alive does not.
    if (std::tie(progress->phase, progress->step) > std::tie(phase_, report_.step)) renewed_ = awake_;
    phase_ = progress->phase;
    report_.step = progress->step;
    if (Clock::now() - noted_ > std::chrono::duration<double>(manifest_.checkpoint_seconds)) {
      noted_ = Clock::now();
      note_running();
    }
  } else if (const auto* result = std::get_if<ResultSpooled>(&event)) {
    if (busy_ && result->job == job_.attempt) take_result(*result);
  } else if (const auto* failed = std::get_if<JobFailed>(&event)) {
    if (busy_ && failed->job == job_.attempt) end(AttemptOutcome::refused, failed->message);
  } else if (const auto* drained = std::get_if<Drained>(&event)) {
    if (busy_ && drained->job == job_.attempt) drained_ = true;
    pool_.drain(the_worker);  // an idle engine leaves
  } else if (const auto* garbled = std::get_if<Garbled>(&event)) {
    condemn(AttemptOutcome::garbled, garbled->message);
  } else if (const auto* gone = std::get_if<Exited>(&event)) {
    exited(gone->ending);
  } else if (const auto* shortage = std::get_if<ShortOfRoom>(&event)) {
    // The engine keeps its work and stands still; as long as there really is no room, nobody blames it.
    if (busy_ && shortage->job == job_.attempt && !has_room(job_.spool.parent_path(), shortage->bytes)) {
      renewed_ = awake_;
    }
  } else if (!stopping_) {
    // Only the first signal counts: a batch system sends several, and has the last word itself.
    stopping_ = true;
    pool_.drain(the_worker);
  }
}

void BatchTask::take_result(const ResultSpooled& result) {
  try {
    if (result.spool != job_.spool) throw ResultError("spooled its result elsewhere");
    const RealisationResult read = read_spool_file(job_.spool, result.sha256);
    if (read.point != job_.point || read.seed != job_.seed) {
      throw ResultError("its result is of another point or seed than the job");
    }
  } catch (const ResultError& error) {
    if (fs::exists(job_.spool)) reject(folder_.shared(), job_.spool);
    condemn(AttemptOutcome::garbled, error.what());
    return;
  }
  end(AttemptOutcome::result);
  publish_results(folder_, manifest_, index_);
}

void BatchTask::exited(const ExitStatus& ending) {
  const bool was_ready = std::exchange(engine_ready_, false);
  engine_there_ = false;
  if (!busy_) {
    if (was_ready || stopping_) return;
    throw EngineError("the engine ended before it said hello: " + to_string(ending));
  }
  if (condemned_) {
    end(condemned_->first, condemned_->second, ending);
    return;
  }
  // A result may be durable although nobody could announce it any more.
  publish_results(folder_, manifest_, index_);
  if (fs::exists(folder_.ended(place_))) {
    busy_ = false;
  } else if (drained_ || (stopping_ && ending.status == 0)) {
    drained_ = true;
    busy_ = false;
    report_.outcome = AttemptOutcome::drained;
    note_running();
  } else {
    end(outcome_of(ending), to_string(ending), ending);
  }
}

void BatchTask::judge_lease() {
  const auto now = Clock::now();
  awake_ += std::min<std::chrono::duration<double>>(
      {now - heard_, longest_turn, std::chrono::duration<double>(manifest_.lease_seconds / 2)});
  heard_ = now;
  if (!busy_ || condemned_ || stopping_ || (awake_ - renewed_).count() <= manifest_.lease_seconds) return;
  const bool stopped = pool_.is_stopped(the_worker);
  condemn(stopped ? AttemptOutcome::killed : AttemptOutcome::hung,
          fmt::format("no new step after {} for {:g} s{}", report_.step, manifest_.lease_seconds,
                      stopped ? ": its process has been stopped" : ""));
}

void BatchTask::condemn(AttemptOutcome outcome, const std::string& message) {
  if (!condemned_) condemned_.emplace(outcome, message);
  pool_.kill(the_worker);
}

void BatchTask::end(AttemptOutcome outcome, const std::string& message, const ExitStatus& ending) {
  report_.outcome = outcome;
  report_.message = message;
  report_.ending = ending;
  write_report(folder_.ended(place_), place_, report_);
  fs::remove(folder_.running(index_));
  busy_ = false;
}

}  // namespace

int run_task(const TaskOptions& options) {
  Manifest manifest = read_manifest(options.manifest);
  if (options.index < 0 || options.index >= static_cast<int>(manifest.tasks.size())) {
    throw InputError(options.manifest.string(), "/tasks", std::to_string(options.index),
                     fmt::format("must be a task below {}", manifest.tasks.size()));
  }
  const BundleFolder folder = BundleFolder::of_manifest(options.manifest);
  StopSignals signals(SIGUSR1);
  try {
    BatchTask(std::move(manifest), folder, options.index, signals).run();
    return ExitCode::done;
  } catch (const Stopped&) {
    return ExitCode::stopped;
  } catch (const std::runtime_error& error) {
    // It says nothing about any seed; the owner must hear of it all the same.
    write_durably(folder.trouble(options.index),
                  Json{{"host", host_name()}, {"message", error.what()}}.dump() + '\n');
    throw;
  }
}

}  // namespace peclet::runner
