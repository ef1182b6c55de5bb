#include "runner/batch/batch_task.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <utility>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/batch/bundle_files.h"
#include "runner/campaign/number_text.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/worker_process.h"
#include "runner/store/blame.h"
#include "runner/store/disk_room.h"
#include "runner/store/locks.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds longest_wait{500};
constexpr int the_worker = 0;

struct Stopped {};

// Returns a random name: two runs of a task (a node thought dead may come back) write different files.
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
        pool_(1, command(), CampaignDirectory(folder_.task(index)), signals),
        lease_(manifest_.lease_seconds),
        awake_(Clock::now(), lease_) {}

  void run() {
    fs::create_directories(CampaignDirectory(folder_.task(index_)).logs());
    fs::create_directories(folder_.left(index_));
    publish_results(folder_, manifest_, index_);
    for (const int place : manifest_.tasks.at(static_cast<std::size_t>(index_))) {
      if (fs::exists(folder_.forgotten())) break;  // its seeds are queued again
      if (!fs::exists(folder_.ended(place))) run_seed(place);
    }
    fs::remove(folder_.trouble(index_));
  }

 private:
  EngineCommand command() const {
    Campaign named;
    named.engine = manifest_.engine;
    EngineCommand command = resolve_engine(named, folder_.manifest());
    // A batch system sends these signals to every process of a job.
    command.blocked_signals = {SIGTERM, SIGINT, SIGUSR1};
    // An engine that needs files in its folder says so if they are absent; ours needs none.
    command.folder = fs::is_directory(manifest_.engine_folder) ? manifest_.engine_folder : fs::path();
    return command;
  }

  void run_seed(int place);
  void start_engine();
  void turn();
  void handle(const Hello& event);
  void handle(const Progressed& event);
  void handle(const ResultSpooled& event);
  void handle(const JobFailed& event);
  void handle(const Drained& event);
  void handle(const ShortOfRoom& event);
  void handle(const Garbled& event) { condemn({AttemptOutcome::garbled, event.message}); }
  void handle(const Exited& event);
  void handle(const StopSignal& event);
  // Returns the outcome, or `drained` if the engine may have failed because it could not write.
  AttemptOutcome unless_it_lacked_room(AttemptOutcome outcome) const {
    return is_blamed(outcome) && unwritable_folder(job_) ? AttemptOutcome::drained : outcome;
  }
  bool is_in_hand(std::int64_t job) const { return watch_.is_busy() && job == job_.attempt; }
  void judge_lease();
  void condemn(AttemptReason reason);
  void note_running();
  void end(const AttemptReason& how, const ExitStatus& ending = {});

  Manifest manifest_;
  BundleFolder folder_;
  int index_;
  std::string run_;
  ProcessPool pool_;
  Awake lease_;
  AwakeClock awake_;
  WorkerWatch watch_;
  bool stopping_ = false;

  // The seed in hand.
  int place_ = 0;
  Job job_;
  AttemptReport report_;
  bool drained_ = false;
  Clock::time_point noted_{};
};

void BatchTask::turn() {
  for (const WorkerEvent& event : pool_.wait(longest_wait)) {
    std::visit([this](const auto& happened) { handle(happened); }, event);
  }
  awake_.end_turn(Clock::now());
}

void BatchTask::start_engine() {
  while (!watch_.is_idle()) {
    if (!watch_.is_there()) {
      if (stopping_) throw Stopped{};
      pool_.start(the_worker);
      watch_.start(awake_.awake());
    }
    turn();
    if (watch_.is_overdue(awake_.awake(), lease_)) throw EngineError("the engine did not say hello");
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
  watch_.begin_job(awake_.awake());
  note_running();
  pool_.assign(the_worker, job_);
  while (watch_.is_busy()) {
    turn();
    judge_lease();
  }
  if (drained_) throw Stopped{};
}

void BatchTask::handle(const Hello& event) {
  report_.engine = event.engine;
  std::string identity;
  try {
    identity = engine_identity(event.engine);
  } catch (const ResultError& error) {
    throw EngineError(fmt::format("the engine's hello does not say what it is: {}", error.what()));
  }
  if (identity != manifest_.engine_identity) {
    throw IntegrityError(
        fmt::format("the engine is {}, the owner's is {}; PECLET_INSTRUCTION_SET makes machines of "
                    "different kinds alike",
                    identity, manifest_.engine_identity));
  }
  if (watch_.is_starting()) watch_.rest(awake_.awake());
}

void BatchTask::handle(const Progressed& event) {
  if (!is_in_hand(event.job)) return;
  watch_.hear(event, awake_.awake());
  report_.step = event.step;
  if (Clock::now() - noted_ > std::chrono::duration<double>(manifest_.checkpoint_seconds)) note_running();
}

void BatchTask::handle(const JobFailed& event) {
  if (is_in_hand(event.job)) end({unless_it_lacked_room(AttemptOutcome::refused), event.message});
}

void BatchTask::handle(const Drained& event) {
  if (is_in_hand(event.job) && !stopping_) {  // it could do so again and again
    return condemn({AttemptOutcome::garbled, "gave back a job without being asked to"});
  }
  if (is_in_hand(event.job)) drained_ = true;
  pool_.drain(the_worker);  // an idle engine leaves
}

// The engine keeps its work and waits. It is not blamed as long as the disk is full.
void BatchTask::handle(const ShortOfRoom& event) {
  if (is_in_hand(event.job) && !has_room(job_.spool.parent_path(), event.bytes)) watch_.renew(awake_.awake());
}

// Only the first signal counts: a batch system sends several, and kills the task in the end.
void BatchTask::handle(const StopSignal&) {
  if (std::exchange(stopping_, true)) return;
  pool_.drain(the_worker);
}

void BatchTask::handle(const ResultSpooled& result) {
  if (!is_in_hand(result.job)) return;
  try {
    if (result.spool != job_.spool) throw ResultError("wrote its result to another file than the job names");
    const RealisationResult read = read_spool_file(job_.spool, result.sha256);
    if (read.point != job_.point || read.seed != job_.seed) {
      throw ResultError("its result is of another point or seed than the job");
    }
    open_files_in_spool(read.document, job_.spool);
  } catch (const ResultError& error) {
    if (fs::exists(job_.spool)) reject(folder_.shared(), job_.spool);
    condemn({AttemptOutcome::garbled, error.what()});
    return;
  }
  end({AttemptOutcome::result});
  publish_results(folder_, manifest_, index_);
}

void BatchTask::handle(const Exited& event) {
  const WorkerWatch watch = std::exchange(watch_, {});
  if (!watch.is_busy()) {
    if (!watch.is_starting() || stopping_) return;
    throw EngineError("the engine ended before it said hello: " + to_string(event.ending));
  }
  // A result may be durable although its worker could not announce it.
  if (!watch.condemned()) publish_results(folder_, manifest_, index_);
  if (fs::exists(folder_.ended(place_))) return;
  AttemptReason how = watch.ended(event.ending, stopping_);
  if (!watch.condemned()) how.outcome = unless_it_lacked_room(how.outcome);
  if (watch.condemned() || (!drained_ && how.outcome != AttemptOutcome::drained))
    return end(how, event.ending);
  drained_ = true;
  report_.outcome = AttemptOutcome::drained;
  note_running();
}

void BatchTask::judge_lease() {
  if (stopping_ || !watch_.is_busy() || !watch_.is_overdue(awake_.awake(), lease_)) return;
  condemn(watch_.overdue(lease_, pool_.is_stopped(the_worker)));
}

void BatchTask::condemn(AttemptReason reason) {
  watch_.condemn(std::move(reason));
  pool_.kill(the_worker);
}

void BatchTask::note_running() {
  noted_ = Clock::now();
  write_report(folder_.running(index_), place_, report_);
}

// Ends the seed in hand. A worker that is still there becomes idle.
void BatchTask::end(const AttemptReason& how, const ExitStatus& ending) {
  report_.outcome = how.outcome;
  report_.message = how.message;
  report_.ending = ending;
  write_report(folder_.ended(place_), place_, report_);
  fs::remove(folder_.running(index_));
  if (watch_.is_busy()) watch_.rest(awake_.awake());
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
    // The error says nothing about any seed, but the owner must learn of it.
    write_durably(folder.trouble(options.index),
                  Json{{"host", host_name()}, {"message", error.what()}}.dump() + '\n');
    throw;
  }
}

}  // namespace peclet::runner
