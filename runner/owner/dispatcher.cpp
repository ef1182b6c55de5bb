#include "runner/owner/dispatcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <utility>
#include <variant>

#include "runner/engines/engine_error.h"
#include "runner/store/disk_room.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

using std::chrono::seconds;

constexpr seconds report_interval{1};
// A lock of another program is a pause, in which workers and signals are to be heard.
constexpr std::chrono::milliseconds lock_patience{500};
constexpr seconds lease_display_interval{2};
// Workers that have not checkpointed and left by then are killed; the seeds lose what came after the last
// checkpoint.
constexpr seconds drain_patience{60};
constexpr seconds surplus_patience{10};
// An engine that exits by itself this often before it is given anything to do will not do better the next
// time.
constexpr int most_early_exits = 3;
// The same for kills from outside, which may be somebody's fault drill.
constexpr int most_early_kills = 100;

}  // namespace

Dispatcher::Dispatcher(Database& database, Ledger& ledger, WorkerPool& pool, RunListener& listener,
                       DispatchSettings settings, Clock clock)
    : database_(database),
      ledger_(ledger),
      pool_(pool),
      listener_(listener),
      settings_(std::move(settings)),
      clock_(std::move(clock)),
      now_{std::vector<Worker>(static_cast<std::size_t>(pool.size()))},
      awake_(clock_(), settings_.lease),
      started_(awake_.heard()),
      reported_(started_),
      leases_shown_(started_) {
  database_.connection().wait_for_locks(static_cast<int>(lock_patience.count()));
}

Dispatcher::Ending Dispatcher::run() {
  while (!ledger_.scheduler().finished() && stopping_ == Stopping::no) {
    turn();
    if (has_nothing_to_do()) {
      listener_.note(why_nothing());
      break;
    }
  }
  if (stopping_ == Stopping::no) stop(Stopping::finished);
  while (anyone_there() || (unbooked_ && stopping_ == Stopping::finished)) turn();
  settle_spool();
  return ledger_.scheduler().finished() ? Ending::finished : Ending::stopped;
}

// A process that has ended is no longer there, even if that could not be booked yet.
bool Dispatcher::anyone_there() const {
  const auto present = std::count_if(now_.workers.begin(), now_.workers.end(),
                                     [](const Worker& worker) { return worker.watch.is_there(); });
  const auto ended = std::count_if(news_.begin(), news_.end(), [](const WorkerEvent& event) {
    return std::holds_alternative<Exited>(event);
  });
  return present > ended;
}

// Nobody here has work, there is none to give out, and yet some point is open.
bool Dispatcher::has_nothing_to_do() const {
  const bool busy = std::any_of(now_.workers.begin(), now_.workers.end(),
                                [](const Worker& worker) { return worker.watch.is_busy(); });
  return !busy && !unbooked_ && !ledger_.scheduler().finished() && !ledger_.next();
}

const char* Dispatcher::why_nothing() const {
  if (ledger_.scheduler().next()) return "no seed that is still needed fits into what is left of the budget";
  return "every seed that is still to be run is handed over; `peclet ingest` takes results in";
}

void Dispatcher::turn() {
  if (settings_.chore()) mark_lost_folders();
  start_workers();
  listen();
  judge_time();
  look_whether_it_is_over();
  if (!unbooked_ && (uncarried_ || book()) && follow_up()) {
    judge_leases();
    hear_requests();
  }
  report();
}

void Dispatcher::start_workers() {
  if (stopping_ != Stopping::no || unbooked_) return;
  for (int number = 0; number < pool_.size(); ++number) {
    if (at(number).watch.is_there()) continue;
    pool_.start(number);
    at(number) = Worker{};
    at(number).watch.start(awake_.awake());
  }
}

void Dispatcher::judge_leases() {
  for (int number = 0; number < pool_.size(); ++number) {
    const WorkerWatch& watch = at(number).watch;
    if (!watch.is_overdue(awake_.awake(), settings_.lease)) continue;
    condemn(number, watch.overdue(settings_.lease, pool_.is_stopped(number)));
  }
}

void Dispatcher::judge_time() {
  if (settings_.time_limit && stopping_ == Stopping::no &&
      awake_.heard() - started_ >= *settings_.time_limit) {
    listener_.note("the time limit is reached: workers checkpoint and stop");
    stop(Stopping::draining);
  }
  const seconds patience = stopping_ == Stopping::finished ? surplus_patience : drain_patience;
  if ((stopping_ == Stopping::finished || stopping_ == Stopping::draining) &&
      awake_.awake() - stopping_since_ > patience) {
    stop(Stopping::at_once);
  }
}

void Dispatcher::show_leases() {
  if (clock_() - leases_shown_ < lease_display_interval) return;
  leases_shown_ = clock_();
  for (Worker& worker : now_.workers) {
    if (!worker.assignment || worker.assignment->shown) continue;
    Assignment& about = *worker.assignment;
    ledger_.renew_lease(about.given_seed, worker.watch.progress());
    about.shown = true;
  }
}

void Dispatcher::stop(Stopping why) {
  stopping_ = why;
  stopping_since_ = awake_.awake();
  for (int number = 0; number < pool_.size(); ++number) {
    if (!at(number).watch.is_there()) continue;
    if (why == Stopping::at_once) {
      pool_.kill(number);
    } else {
      pool_.drain(number);
    }
  }
}

void Dispatcher::report() {
  const Time now = clock_();
  if (now - reported_ < report_interval) return;
  reported_ = now;
  RunReport report = ledger_.report(pool_.size());
  report.workers = pool_.size();
  report.busy = static_cast<int>(std::count_if(now_.workers.begin(), now_.workers.end(),
                                               [](const Worker& worker) { return worker.watch.is_busy(); }));
  report.results = now_.results;
  report.elapsed = std::chrono::duration<double>(now - started_).count();
  listener_.report(report);
}

void Dispatcher::condemn(int number, AttemptReason reason) {
  at(number).watch.condemn(std::move(reason));
  pool_.kill(number);
}

void Dispatcher::handle(const Hello& event) {
  Worker& worker = at(event.worker);
  if (worker.watch.condemned()) return;
  if (!worker.watch.is_starting()) {
    condemn(event.worker, {AttemptOutcome::garbled, "said hello twice"});
    return;
  }
  worker.engine = ledger_.admit_engine(event.engine);
  worker.takes_ahead = event.ahead;
  worker.watch.rest(awake_.awake());
}

void Dispatcher::handle(const Progressed& event) {
  if (!has_job(event.worker, event.job)) return;
  Worker& worker = at(event.worker);
  worker.watch.hear(event, awake_.awake());
  worker.assignment->shown = false;
}

void Dispatcher::handle(const ResultSpooled& event) {
  if (!has_job(event.worker, event.job)) return;
  const Worker& worker = at(event.worker);
  const Assignment& about = *worker.assignment;
  std::string why;
  if (event.spool != about.given_seed.job.spool) {
    condemn(event.worker, {AttemptOutcome::garbled, "spooled its result elsewhere"});
  } else if (ledger_.take_result(about.given_seed, event.sha256, worker.watch.progress().step,
                                 processor_seconds_since(about.given), why)) {
    ++now_.results;
    now_.early_exits = 0;
    go_on(event.worker);
  } else if (lacked_room(event.worker)) {
    end_assignment(event.worker, {AttemptOutcome::drained, 0, {}, why});
  } else {
    condemn(event.worker, {AttemptOutcome::garbled, why});
  }
}

void Dispatcher::handle(const JobFailed& event) {
  if (!has_job(event.worker, event.job)) return;
  const AttemptOutcome outcome =
      lacked_room(event.worker) ? AttemptOutcome::drained : AttemptOutcome::refused;
  end_assignment(event.worker, {outcome, 0, {}, event.message});
}

void Dispatcher::handle(const Drained& event) {
  if (!has_job(event.worker, event.job)) return;
  Worker& worker = at(event.worker);
  if (stopping_ == Stopping::no && !worker.watch.is_recalled()) {  // it could do so for ever
    condemn(event.worker, {AttemptOutcome::garbled, "gave back a job that nobody wanted back"});
    return;
  }
  worker.watch.leave_at(event.step);
  if (const auto waiting = std::exchange(worker.waiting, std::nullopt)) give_back(*waiting);
  end_assignment(event.worker, {AttemptOutcome::drained});
  pool_.drain(event.worker);  // an idle engine leaves
}

// It keeps its work and stands still: as long as there really is no room, that is not its fault.
void Dispatcher::handle(const ShortOfRoom& event) {
  if (!has_job(event.worker, event.job)) return;
  const Job& job = at(event.worker).assignment->given_seed.job;
  const std::filesystem::path folder = event.path.parent_path();
  const bool is_beside_result =
      folder == left_folder(job.spool) && event.path.filename().string().starts_with(left_stem(job.spool));
  if (event.path != job.spool && checkpoint_of(event.path) != job.checkpoint && folder != job.failures &&
      !is_beside_result) {
    condemn(event.worker, {AttemptOutcome::garbled, "wrote a file that is none of its job"});
    return;
  }
  const int error = lack_of_room(folder, event.bytes);
  if (error == 0) return;
  begin_pause(lack_of_room_in(folder, event.bytes, error));
  at(event.worker).watch.renew(awake_.awake());
}

void Dispatcher::handle(const Garbled& event) {
  condemn(event.worker, {AttemptOutcome::garbled, event.message});
}

void Dispatcher::handle(const Exited& event) {
  Worker& worker = at(event.worker);
  const auto waiting = std::exchange(worker.waiting, std::nullopt);
  if (worker.assignment) {
    exited_during_job(event.worker, event.ending);
  } else {
    exited_without_job(event.worker, event.ending);
  }
  if (waiting && !left_result(event.worker, *waiting, 0)) give_back(*waiting);
  worker = Worker{};
}

void Dispatcher::exited_during_job(int number, const ExitStatus& ending) {
  const Worker& worker = at(number);
  if (left_result(number, *worker.assignment, worker.watch.progress().step)) return;
  AttemptReason how = worker.watch.ended(ending, stopping_ != Stopping::no);
  if (!worker.watch.condemned() &&
      (stopping_ == Stopping::at_once || (is_blamed(how.outcome) && lacked_room(number)))) {
    how.outcome = AttemptOutcome::drained;
  }
  end_assignment(number, {how.outcome, 0, ending, how.message});
}

void Dispatcher::exited_without_job(int number, const ExitStatus& ending) {
  const WorkerWatch& watch = at(number).watch;
  if (stopping_ != Stopping::no || watch.is_recalled()) return;
  const bool own_doing = watch.condemned() || outcome_of(ending) != AttemptOutcome::killed;
  const std::string how = watch.condemned() ? watch.condemned()->message : to_string(ending);
  ledger_.warn(fmt::format("worker {} ended {}: {}", number,
                           watch.is_starting() ? "before it said hello" : "without a job", how));
  now_.early_exits += own_doing ? most_early_kills / most_early_exits + 1 : 1;
  if (now_.early_exits > most_early_kills) {
    throw EngineError(
        fmt::format("the engine does not stay until it is given work: {}; what it printed is in the log "
                    "of worker {}",
                    how, number));
  }
}

void Dispatcher::obey_stop_signal() {
  if (stopping_ == Stopping::draining || stopping_ == Stopping::finished) {
    listener_.note("stopping at once");
    stop(Stopping::at_once);
  } else if (stopping_ == Stopping::no) {
    listener_.note("workers checkpoint and stop; a second signal stops at once");
    stop(Stopping::draining);
  }
}

}  // namespace peclet::runner
