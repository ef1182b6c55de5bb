#include "runner/batch/batch_task.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <random>
#include <utility>
#include <vector>

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
        pool_({command()}, CampaignDirectory(folder_.task(index)), signals),
        lease_(manifest_.lease_seconds),
        awake_(Clock::now(), lease_) {}

  void run() {
    fs::create_directories(CampaignDirectory(folder_.task(index_)).logs());
    fs::create_directories(folder_.left(index_));
    publish_results(folder_, manifest_, index_);
    for (const int place : manifest_.tasks.at(static_cast<std::size_t>(index_))) {
      if (!fs::exists(folder_.ended(place))) to_come_.push_back(place);
    }
    while (begin_seeds()) {
      turn();
      judge_lease();
    }
    if (drained_ || !to_come_.empty()) throw Stopped{};
    fs::remove(folder_.trouble(index_));
  }

 private:
  EngineCommand command() const {
    Campaign named;
    named.engine = manifest_.engine;
    EngineCommand command = resolve_engine(named, folder_.manifest());
    // A batch system sends these signals to every process of a job; LSF the last two at limits.
    command.blocked_signals = {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU};
    // An engine that needs files in its folder says so if they are absent; ours needs none.
    command.folder = fs::is_directory(manifest_.engine_folder) ? manifest_.engine_folder : fs::path();
    return command;
  }

  // A seed that the engine has.
  struct Seed {
    int place = 0, slot = 0;
    Job job{};
    AttemptReport report{};
    Clock::time_point noted{};
  };

  // Gives the engine seeds while it has room for them. Returns false once all have ended or, after a signal,
  // none is in the engine.
  bool begin_seeds();
  std::vector<int>::iterator next_place();
  void begin_seed(int place);
  void start_engine();
  void turn();
  void handle(const Hello& event);
  void handle(const Progressed& event);
  void handle(const ResultSpooled& event);
  void handle(const JobFailed& event);
  void handle(const Drained& event);
  void handle(const ShortOfRoom& event);
  void handle(const Carrying&) { condemn({AttemptOutcome::garbled, "carries files on this machine"}); }
  void handle(const Lost& event) { condemn({AttemptOutcome::garbled, event.message}); }
  void handle(const Garbled& event) { condemn({AttemptOutcome::garbled, event.message}); }
  void handle(const Exited& event);
  void handle(const StopSignal& event);
  // Returns the outcome, or `drained` if the engine may have failed because it could not write.
  AttemptOutcome unless_it_lacked_room(AttemptOutcome outcome) const {
    const bool lacked = is_blamed(outcome) && !in_hand_.empty() &&
                        unwritable_folder(in_hand_.begin()->second.job);  // as of all others
    return lacked ? AttemptOutcome::drained : outcome;
  }
  Seed* seed_of(std::int64_t job) {
    const auto known = in_hand_.find(job);
    return known == in_hand_.end() ? nullptr : &known->second;
  }
  int allowed_with(int place) const {
    return largest_company(capacity_, manifest_.seeds.at(static_cast<std::size_t>(place)).halvings);
  }
  void judge_lease();
  void condemn(AttemptReason reason);
  void note_running(Seed& seed);
  void end(const Seed& seed, const AttemptEnd& how);
  // Notes that the seed has been given back, for another run of this task.
  void note_drained(Seed& seed);

  Manifest manifest_;
  BundleFolder folder_;
  int index_;
  std::string run_;
  ProcessPool pool_;
  Awake lease_;
  AwakeClock awake_;
  WorkerWatch watch_;
  bool stopping_ = false;  // told to leave
  bool drained_ = false;   // a seed has been given back
  int capacity_ = 1;
  Json engine_;                           // provenance of the engine
  std::vector<int> to_come_;              // places
  std::map<std::int64_t, Seed> in_hand_;  // by the number of the job
};

void BatchTask::turn() {
  for (const WorkerEvent& event : pool_.wait(longest_wait)) {
    std::visit([this](const auto& happened) { handle(happened); }, event);
  }
  awake_.end_turn(Clock::now());
}

void BatchTask::start_engine() {
  while (!watch_.takes_jobs() && !stopping_) {
    if (!watch_.is_there()) {
      pool_.start(the_worker);
      watch_.start(awake_.awake());
    }
    turn();
    if (watch_.is_overdue(awake_.awake(), lease_)) throw EngineError("the engine did not say hello");
  }
}

bool BatchTask::begin_seeds() {
  if (!stopping_ && !drained_ && !to_come_.empty() && !watch_.is_there()) start_engine();
  if (stopping_ || drained_) return watch_.is_busy();
  while (watch_.takes_jobs()) {
    const auto next = next_place();
    if (next == to_come_.end()) break;
    if (fs::exists(folder_.forgotten())) {  // its seeds are queued again
      to_come_.clear();
      break;
    }
    const int place = *next;
    to_come_.erase(next);
    if (!fs::exists(folder_.ended(place))) begin_seed(place);
  }
  return watch_.is_busy() || !to_come_.empty();
}

// Returns the first place whose seed may join those in the engine.
std::vector<int>::iterator BatchTask::next_place() {
  const int jobs = watch_.jobs();
  const bool is_full = jobs >= capacity_ ||
                       std::any_of(in_hand_.begin(), in_hand_.end(),
                                   [&](const auto& seed) { return allowed_with(seed.second.place) <= jobs; });
  if (is_full) return to_come_.end();
  return std::find_if(to_come_.begin(), to_come_.end(),
                      [&](int place) { return allowed_with(place) > jobs; });
}

void BatchTask::begin_seed(int place) {
  const BundledSeed& about = manifest_.seeds.at(static_cast<std::size_t>(place));
  Seed seed;
  seed.place = place;
  const auto is_taken = [&](int slot) {
    return std::any_of(in_hand_.begin(), in_hand_.end(),
                       [&](const auto& other) { return other.second.slot == slot; });
  };
  while (is_taken(seed.slot)) ++seed.slot;
  seed.job = Job{place + 1,
                 about.point,
                 about.seed,
                 manifest_.scenes.at(about.point),
                 manifest_.threads,
                 folder_.shared().checkpoint(about.point, about.seed),
                 folder_.task(index_) / (result_name(about) + run_ + ".result"),
                 folder_.shared().failures(),
                 manifest_.checkpoint_seconds,
                 std::min(1.0, manifest_.lease_seconds / 5)};
  seed.report.outcome = AttemptOutcome::running;
  seed.report.host = host_name();
  seed.report.process = pool_.process(the_worker);
  seed.report.started_at = utc_now();
  seed.report.engine = engine_;
  watch_.begin_job(seed.job.attempt, awake_.awake());
  note_running(seed);
  pool_.assign(the_worker, seed.job);
  in_hand_.emplace(seed.job.attempt, std::move(seed));
}

void BatchTask::handle(const Hello& event) {
  engine_ = event.engine;
  capacity_ = event.capacity;
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
  if (watch_.is_starting()) watch_.greet();
}

void BatchTask::handle(const Progressed& event) {
  Seed* const seed = seed_of(event.job);
  if (seed == nullptr) return;
  watch_.hear(event, awake_.awake());
  seed->report.step = event.step;
  if (Clock::now() - seed->noted > std::chrono::duration<double>(manifest_.checkpoint_seconds))
    note_running(*seed);
}

void BatchTask::handle(const JobFailed& event) {
  if (const Seed* const seed = seed_of(event.job))
    end(*seed, {unless_it_lacked_room(AttemptOutcome::refused), 0, {}, event.message});
}

void BatchTask::handle(const Drained& event) {
  Seed* const seed = seed_of(event.job);
  if (seed != nullptr && !stopping_) {  // it could do so again and again
    return condemn({AttemptOutcome::garbled, "gave back a job without being asked to", event.job});
  }
  if (seed != nullptr) note_drained(*seed);
  pool_.drain(the_worker);  // an idle engine leaves
}

// The engine keeps its work and waits. It is not blamed as long as the disk is full.
void BatchTask::handle(const ShortOfRoom& event) {
  const Seed* const seed = seed_of(event.job);
  if (seed != nullptr && !has_room(seed->job.spool.parent_path(), event.bytes)) watch_.renew(awake_.awake());
}

// Only the first signal counts: a batch system sends several, and kills the task in the end.
void BatchTask::handle(const StopSignal&) {
  if (std::exchange(stopping_, true)) return;
  pool_.drain(the_worker);
}

void BatchTask::handle(const ResultSpooled& result) {
  const Seed* const seed = seed_of(result.job);
  if (seed == nullptr) return;
  const Job& job = seed->job;
  try {
    if (result.spool != job.spool) throw ResultError("wrote its result to another file than the job names");
    const RealisationResult read = read_spool_file(job.spool, result.sha256);
    if (read.point != job.point || read.seed != job.seed) {
      throw ResultError("its result is of another point or seed than the job");
    }
    open_files_in_spool(read.document, job.spool);
  } catch (const ResultError& error) {
    if (fs::exists(job.spool)) reject(folder_.shared(), job.spool);
    condemn({AttemptOutcome::garbled, error.what(), result.job});
    return;
  }
  const fs::path spool = job.spool;
  end(*seed, {AttemptOutcome::result});
  publish_result(folder_, manifest_, index_, spool);
}

void BatchTask::handle(const Exited& event) {
  const WorkerWatch watch = std::exchange(watch_, {});
  if (!watch.is_busy()) {
    if (!watch.is_starting() || stopping_) return;
    throw EngineError("the engine ended before it said hello: " + to_string(event.ending));
  }
  // A result may be durable although its worker could not announce it.
  if (!watch.condemned()) publish_results(folder_, manifest_, index_);
  std::erase_if(in_hand_, [this](const auto& seed) {
    const bool has_ended = fs::exists(folder_.ended(seed.second.place));
    if (has_ended) fs::remove(folder_.running(index_, seed.second.slot));
    return has_ended;
  });
  AttemptReason how = watch.ended(event.ending, stopping_);
  if (!watch.condemned()) how.outcome = unless_it_lacked_room(how.outcome);
  const int others = static_cast<int>(in_hand_.size()) - 1;
  while (!in_hand_.empty()) {
    Seed& seed = in_hand_.begin()->second;
    if (!watch.condemned() && how.outcome == AttemptOutcome::drained) {
      note_drained(seed);
    } else {
      end(seed, end_with_engine(how, event.ending, seed.job.attempt, others));
    }
  }
}

void BatchTask::judge_lease() {
  if (stopping_ || !watch_.is_busy() || !watch_.is_overdue(awake_.awake(), lease_)) return;
  condemn(watch_.overdue(lease_, pool_.is_stopped(the_worker)));
}

void BatchTask::condemn(AttemptReason reason) {
  watch_.condemn(std::move(reason));
  pool_.kill(the_worker);
}

void BatchTask::note_running(Seed& seed) {
  seed.noted = Clock::now();
  write_report(folder_.running(index_, seed.slot), seed.place, seed.report);
}

void BatchTask::note_drained(Seed& seed) {
  drained_ = true;
  seed.report.outcome = AttemptOutcome::drained;
  note_running(seed);
  const std::int64_t job = seed.job.attempt;
  watch_.end_job(job);
  in_hand_.erase(job);
}

void BatchTask::end(const Seed& seed, const AttemptEnd& how) {
  AttemptReport report = seed.report;
  static_cast<AttemptEnd&>(report) = how;
  report.step = seed.report.step;
  write_report(folder_.ended(seed.place), seed.place, report);
  fs::remove(folder_.running(index_, seed.slot));
  const std::int64_t job = seed.job.attempt;
  watch_.end_job(job);
  in_hand_.erase(job);
}

}  // namespace

int run_task(const TaskOptions& options) {
  Manifest manifest = read_manifest(options.manifest);
  choose_device(manifest.device);
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
