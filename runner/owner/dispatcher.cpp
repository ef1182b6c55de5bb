#include "runner/owner/dispatcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <variant>

#include "runner/engines/engine_process.h"
#include "runner/store/disk_room.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

using std::chrono::seconds;

constexpr seconds report_interval{1};
// Longest wait for another program's lock. A longer lock is a pause, in which workers and signals are heard.
constexpr std::chrono::milliseconds lock_patience{500};
constexpr seconds lease_display_interval{2};
// Workers that have not left by then are killed; their seeds lose the steps since the last checkpoint.
constexpr seconds drain_patience{60};
constexpr seconds extra_patience{10};
// Exits before any job, in a row, after which the engine is given up.
constexpr int most_early_exits = 3;
// Kills from outside before any job, in a row, that are allowed: a fault drill may cause several.
constexpr int most_early_kills = 100;

// Mean wall time of jobs [s] below which a second job waits behind the first. A commit takes some hundredths
// of a second, so workers with longer jobs need no second one. A seed behind a long job would delay the
// decision of its point although idle workers could run it.
constexpr double longest_job_to_queue_behind = 1;

// Time until the hello of a worker. A launcher may have to wait for a place.
constexpr Awake hello_patience{60}, launch_patience{600};

// Longest wait of a turn. Leases and the time limit are judged at least this often.
constexpr std::chrono::milliseconds longest_wait{500};

constexpr std::chrono::seconds request_interval{1};

}  // namespace

Dispatcher::Dispatcher(Database& database, CampaignState& state, WorkerPool& pool, RunListener& listener,
                       DispatchSettings settings, Clock clock)
    : database_(database),
      state_(state),
      pool_(pool),
      listener_(listener),
      settings_(std::move(settings)),
      clock_(std::move(clock)),
      now_{.workers = std::vector<Worker>(static_cast<std::size_t>(pool.size())),
           .starts = WorkerStarts(settings_.hosts)},
      awake_(clock_(), settings_.lease),
      started_(awake_.heard()),
      reported_(started_),
      leases_shown_(started_) {
  database_.connection().wait_for_locks(static_cast<int>(lock_patience.count()));
}

Dispatcher::Ending Dispatcher::run() {
  while (!state_.scheduler().finished() && stopping_ == Stopping::no) {
    turn();
    if (has_nothing_to_do()) {
      listener_.note(why_nothing());
      break;
    }
  }
  if (stopping_ == Stopping::no) stop(Stopping::finished);
  while (anyone_there() || (unbooked_ && stopping_ == Stopping::finished)) turn();
  settle_spool();
  return state_.scheduler().finished() ? Ending::finished : Ending::stopped;
}

// True if a process of a worker still runs. An exit counts before it is booked.
bool Dispatcher::anyone_there() const {
  const auto present = std::count_if(now_.workers.begin(), now_.workers.end(),
                                     [](const Worker& worker) { return worker.watch.is_there(); });
  return present > news_.exits();
}

// True if no worker is busy, no seed is available, and a point is undecided.
bool Dispatcher::has_nothing_to_do() const {
  return busy() == 0 && !unbooked_ && !state_.scheduler().finished() && !state_.next();
}

int Dispatcher::busy() const {
  return static_cast<int>(std::count_if(now_.workers.begin(), now_.workers.end(),
                                        [](const Worker& worker) { return worker.watch.is_busy(); }));
}

const char* Dispatcher::why_nothing() const {
  if (state_.scheduler().next()) return "no seed that is still needed fits into what is left of the budget";
  return "every seed that is still to be run is handed over; `peclet ingest` takes results in";
}

void Dispatcher::turn() {
  if (settings_.chore()) std::ranges::for_each(now_.workers, &Worker::mark_lost_folders);
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
    if (!now_.starts.may_start(number, clock_())) continue;
    pool_.start(number);
    at(number) = Worker{};
    at(number).watch.start(awake_.awake(), are_launched() ? launch_patience : hello_patience);
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
  const seconds patience = stopping_ == Stopping::finished ? extra_patience : drain_patience;
  if ((stopping_ == Stopping::finished || stopping_ == Stopping::draining) &&
      awake_.awake() - stopping_since_ > patience) {
    stop(Stopping::at_once);
  }
}

void Dispatcher::show_leases() {
  if (clock_() - leases_shown_ < lease_display_interval) return;
  leases_shown_ = clock_();
  for (Worker& worker : now_.workers) {
    for (Assignment& about : worker.running) {
      if (about.shown) continue;
      state_.renew_lease(about.given_seed, worker.watch.progress(about.job()));
      about.shown = true;
    }
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
  RunReport report = state_.report(places());
  report.workers = pool_.size();
  report.busy = busy();
  for (const Worker& worker : now_.workers) report.running += worker.watch.jobs();
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
  worker.engine = state_.admit_engine(event.engine);
  now_.starts.greet(event.worker);
  worker.takes_ahead = event.ahead;
  worker.capacity = capacity_ = event.capacity;
  worker.watch.greet();
}

void Dispatcher::handle(const Progressed& event) {
  Assignment* const about = running_job(event.worker, event.job);
  if (about == nullptr) return;
  at(event.worker).watch.hear(event, awake_.awake());
  about->shown = false;
}

void Dispatcher::handle(const ResultSpooled& event) {
  const Assignment* const about = running_job(event.worker, event.job);
  if (about == nullptr) return;
  std::string why;
  if (event.spool != about->given_seed.job.spool) {
    condemn(event.worker,
            {AttemptOutcome::garbled, "wrote its result to another file than the job names", event.job});
  } else if (state_.take_result(about->given_seed, event.sha256,
                                at(event.worker).watch.progress(event.job).step,
                                processor_seconds_since(about->given), why)) {
    ++now_.results;
    now_.early_exits = 0;
    now_.starts.get_on(event.worker);
    at(event.worker).end(event.job, awake_.awake(), clock_());
  } else if (lacked_room(*about)) {
    end_assignment(event.worker, *about, {AttemptOutcome::drained, 0, {}, why});
  } else {
    condemn(event.worker, {AttemptOutcome::garbled, why, event.job});
  }
}

void Dispatcher::handle(const JobFailed& event) {
  const Assignment* const about = running_job(event.worker, event.job);
  if (about == nullptr) return;
  const AttemptOutcome outcome = lacked_room(*about) ? AttemptOutcome::drained : AttemptOutcome::refused;
  end_assignment(event.worker, *about, {outcome, 0, {}, event.message});
}

void Dispatcher::handle(const Drained& event) {
  const Assignment* const about = running_job(event.worker, event.job);
  if (about == nullptr) return;
  Worker& worker = at(event.worker);
  if (stopping_ == Stopping::no && !worker.watch.is_recalled()) {  // it could do so again and again
    return condemn(event.worker,
                   {AttemptOutcome::garbled, "gave back a job without being asked to", event.job});
  }
  worker.watch.leave_at(event.job, event.step);
  if (const auto waiting = std::exchange(worker.waiting, std::nullopt)) give_back(*waiting);
  end_assignment(event.worker, *about, {AttemptOutcome::drained});
  pool_.drain(event.worker);  // an idle engine leaves
}

// The engine keeps its work and waits. It is not blamed as long as the disk is full.
void Dispatcher::handle(const ShortOfRoom& event) {
  const Assignment* const about = running_job(event.worker, event.job);
  if (about == nullptr) return;
  if (!is_file_of(about->given_seed.job, event.path)) {
    return condemn(event.worker,
                   {AttemptOutcome::garbled, "wrote a file that does not belong to its job", event.job});
  }
  const fs::path folder = event.path.parent_path();
  const int error = lack_of_room(folder, event.bytes);
  if (error == 0) return;
  begin_pause(lack_of_room_in(folder, event.bytes, error));
  at(event.worker).watch.renew(awake_.awake());
}

void Dispatcher::handle(const Carrying& event) {
  if (running_job(event.worker, event.job) == nullptr) return;
  if (!are_launched()) {
    return condemn(event.worker, {AttemptOutcome::garbled, "carries files on this machine", event.job});
  }
  at(event.worker).watch.renew(awake_.awake());
}

void Dispatcher::handle(const Lost& event) {
  const AttemptOutcome outcome = event.cause == "nonsense" || !are_launched() ? AttemptOutcome::garbled
                                 : event.cause == "no-room"                   ? AttemptOutcome::drained
                                                                              : AttemptOutcome::killed;
  condemn(event.worker, {outcome, event.message});
}

void Dispatcher::handle(const Garbled& event) {
  condemn(event.worker, {AttemptOutcome::garbled, event.message});
}

void Dispatcher::handle(const Exited& event) {
  Worker& worker = at(event.worker);
  const auto waiting = std::exchange(worker.waiting, std::nullopt);
  if (are_launched()) launched_worker_ended(event.worker, event.ending);
  if (worker.watch.is_busy()) {
    exited_during_jobs(event.worker, event.ending);
  } else if (!are_launched()) {
    exited_without_job(event.worker, event.ending);
  }
  if (waiting && !left_result(event.worker, *waiting, 0)) give_back(*waiting);
  worker = Worker{};
}

void Dispatcher::exited_during_jobs(int number, const ExitStatus& ending) {
  const WorkerWatch& watch = at(number).watch;
  std::vector<Assignment> jobs = at(number).running;
  std::erase_if(jobs, [&](const Assignment& about) {
    return left_result(number, about, watch.progress(about.job()).step);
  });
  AttemptReason how = watch.ended(ending, stopping_ != Stopping::no);
  // All jobs write into the same folders.
  if (!watch.condemned() && (stopping_ == Stopping::at_once ||
                             (is_blamed(how.outcome) && !jobs.empty() && lacked_room(jobs.front())))) {
    how.outcome = AttemptOutcome::drained;
  }
  const int others = static_cast<int>(jobs.size()) - 1;
  for (const Assignment& about : jobs)
    end_assignment(number, about, end_with_engine(how, ending, about.job(), others));
  if (others > 0 && how.job == 0 && is_blamed(how.outcome)) {
    state_.warn(fmt::format(
        "worker {}: {} with {} realisations: {}; none is blamed, and they are tried again in smaller groups",
        number, to_string(how.outcome), jobs.size(), how.message));
  }
}

void Dispatcher::launched_worker_ended(int number, const ExitStatus& ending) {
  const WorkerWatch& watch = at(number).watch;
  if (stopping_ != Stopping::no || watch.is_recalled()) return;
  const bool is_of_engine = watch.is_busy() && !watch.condemned() && is_blamed(outcome_of(ending));
  if (is_of_engine) return;
  const std::string how = watch.condemned() ? watch.condemned()->message : to_string(ending);
  const std::string warning = now_.starts.end(number, how, clock_());
  if (now_.starts.is_over()) throw EngineError(warning);
  if (!warning.empty()) state_.warn(warning);
}

void Dispatcher::exited_without_job(int number, const ExitStatus& ending) {
  const WorkerWatch& watch = at(number).watch;
  if (stopping_ != Stopping::no || watch.is_recalled()) return;
  const bool own_doing = watch.condemned() || outcome_of(ending) != AttemptOutcome::killed;
  const std::string how = watch.condemned() ? watch.condemned()->message : to_string(ending);
  state_.warn(fmt::format("worker {} ended {}: {}", number,
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

// Fills the workers in turn, then gives jobs ahead, so that no seed waits while a worker could run it.
void Dispatcher::give_out_seeds() {
  if (stopping_ != Stopping::no || pause_.lasts() || state_.scheduler().finished()) return;
  for (bool any = true; any;) {
    any = false;
    for (int number = 0; number < pool_.size(); ++number) {
      Worker& worker = at(number);
      if (!worker.has_place()) continue;
      std::optional<Assignment> given = next_assignment(number);
      if (!given && state_.has_suspects()) continue;  // another worker may get the seed
      if (!given) return;
      worker.begin(std::move(*given), awake_.awake());
      any = true;
    }
  }
  for (int number = 0; number < pool_.size(); ++number) {
    Worker& worker = at(number);
    if (!takes_a_further_job(worker)) continue;
    worker.waiting = next_assignment(number);
    if (!worker.waiting && !state_.has_suspects()) return;
  }
}

// Books the next seed as this worker's, to be sent after the commit. Returns nothing if there is no seed.
std::optional<Assignment> Dispatcher::next_assignment(int number) {
  const Worker& worker = at(number);
  std::optional<GivenSeed> given_seed =
      state_.give_out(number, pool_.process(number), worker.engine, worker.company());
  if (!given_seed) return std::nullopt;
  given_seed->job.threads = settings_.threads;
  given_seed->job.checkpoint_seconds = settings_.checkpoint_seconds;
  // Several reports fit into a lease.
  given_seed->job.progress_seconds = std::min(1.0, settings_.lease.count() / 5);
  now_.to_send.emplace_back(number, given_seed->job);
  given_seed->job.scene = nullptr;  // sent once; the rest is copied at every turn
  Assignment about{std::move(*given_seed)};
  about.given = about.begun = clock_();
  return about;
}

bool Dispatcher::takes_a_further_job(const Worker& worker) const {
  return worker.takes_one_ahead() &&
         std::any_of(worker.running.begin(), worker.running.end(), [this](const Assignment& about) {
           const std::optional<double> seconds = state_.wall_seconds(about.given_seed);
           return seconds && *seconds < longest_job_to_queue_behind;
         });
}

Assignment* Dispatcher::running_job(int number, std::int64_t job) {
  Worker& worker = at(number);
  if (worker.watch.condemned()) return nullptr;
  if (Assignment* const known = worker.find(job)) return known;
  if (!worker.has_finished(job))  // a repeated message does no harm
    condemn(number, {AttemptOutcome::garbled, fmt::format("spoke of job {}, which it does not have", job)});
  return nullptr;
}

double Dispatcher::processor_seconds_since(Time time) const {
  return settings_.threads * std::chrono::duration<double>(clock_() - time).count();
}

void Dispatcher::end_assignment(int number, const Assignment& about, const AttemptEnd& end) {
  Worker& worker = at(number);
  const std::int64_t job = about.job();
  AttemptEnd complete = end;
  complete.step = worker.watch.progress(job).step;
  complete.held_seconds = processor_seconds_since(about.begun) / worker.capacity;
  state_.end_attempt(about.given_seed, complete);
  worker.end(job, awake_.awake(), clock_());
}

// A result may be durable although its worker could not announce it. A rejected result stays rejected.
bool Dispatcher::left_result(int number, const Assignment& about, std::int64_t step) {
  const std::optional<AttemptReason>& condemned = at(number).watch.condemned();
  std::string why;
  if ((condemned && condemned->outcome == AttemptOutcome::garbled) || !is_there(about.given_seed.job.spool) ||
      !state_.take_result(about.given_seed, "", step, processor_seconds_since(about.given), why)) {
    return false;
  }
  ++now_.results;
  return true;
}

void Dispatcher::give_back(const Assignment& waiting) {
  state_.end_attempt(waiting.given_seed, {AttemptOutcome::drained, 0, {}, "waited behind another job"});
}

// Obeys signals at once, whatever becomes of the booking.
void Dispatcher::listen() {
  for (WorkerEvent& event : pool_.wait(longest_wait)) {
    if (std::holds_alternative<StopSignal>(event)) {
      obey_stop_signal();
      continue;
    }
    if (unbooked_ && std::holds_alternative<ShortOfRoom>(event)) continue;  // it repeats this message
    // Tells a drained worker to leave now: booking may take long.
    if (const auto* const drained = std::get_if<Drained>(&event); unbooked_ && drained != nullptr) {
      pool_.drain(drained->worker);
    }
    news_.add(std::move(event));
  }
  awake_.end_turn(clock_());
}

bool Dispatcher::book() {
  Snapshot before = now_;
  try {
    Transaction booking(database_.connection());
    for (const WorkerEvent& event : news_.events()) {
      std::visit([this](const auto& happened) { handle(happened); }, event);
    }
    if (state_.choose_values()) find_running_seeds();
    give_out_seeds();
    show_leases();
    booking.commit();
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root(), news_.bytes());
    if (!hindrance) throw;
    now_ = std::move(before);
    state_.roll_back();
    find_running_seeds();
    unbooked_ = true;
    begin_pause(*hindrance);
    return false;
  }
  news_.clear();
  return true;
}

bool Dispatcher::follow_up() {
  try {
    state_.after_commit();  // removes discarded checkpoints before the next attempts begin
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root());
    if (!hindrance) throw;
    uncarried_ = unbooked_ = true;
    begin_pause(*hindrance);
    return false;
  }
  uncarried_ = false;
  for (const auto& [worker, job] : std::exchange(now_.to_send, {})) pool_.assign(worker, job);
  if (!told_of_.empty() && !pause_.lasts() && !request_waits_) end_pause();
  return true;
}

fs::path Dispatcher::root() const { return fs::path(database_.connection().path()).parent_path(); }

// Tells of each kind of hindrance once a pause.
void Dispatcher::begin_pause(const Hindrance& hindrance) {
  pause_.begin(hindrance, clock_());
  if (!told_of_.insert(hindrance.kind()).second) return;
  listener_.happened(ShortageBegan{hindrance.text});
  listener_.warn(
      fmt::format("{}; workers keep what they have, no further seed is given out, and the campaign continues "
                  "by itself {}",
                  hindrance.text, hindrance.end));
}

void Dispatcher::look_whether_it_is_over() {
  if (!pause_.lasts()) return;
  const Time now = clock_();
  // The write-ahead log keeps its largest size, which may fill a small disk.
  if (pause_.is_looked_at(now)) database_.connection().empty_log();
  if (pause_.is_over(now)) {
    unbooked_ = false;
    return;
  }
  if (stopping_ != Stopping::no) return;
  const std::string why = pause_.in_vain(root(), now);
  if (why.empty()) return;
  listener_.warn(why + "; workers checkpoint and stop");
  stop(Stopping::draining);
}

void Dispatcher::end_pause() {
  told_of_.clear();
  listener_.note("nothing is in the way any more: the campaign continues");
  listener_.happened(ShortageEnded{});
  for (Worker& worker : now_.workers) {
    worker.watch.renew(awake_.awake());  // workers were not heard during the pause
  }
}

bool Dispatcher::lacked_room(const Assignment& about) {
  if (about.lost_a_folder) return true;
  const std::optional<fs::path> folder = unwritable_folder(about.given_seed.job);
  if (folder && fs::exists(*folder)) {
    if (const int error = lack_of_room(*folder, 0); error != 0)
      begin_pause(lack_of_room_in(*folder, 0, error));
  }
  return folder.has_value();
}

// Takes in results of earlier owners' workers, and results of this run that could not be booked.
void Dispatcher::settle_spool() {
  try {
    state_.ingest_spool();
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root());
    if (!hindrance) throw;
    state_.roll_back();  // decisions count only if they are in the database
    listener_.warn(hindrance->text + "; what workers did last is booked by the next run");
  }
}

// Requests wait for the next owner while workers stop, and for the end of a pause.
void Dispatcher::hear_requests() {
  if (stopping_ != Stopping::no || pause_.lasts() || clock_() - requests_heard_ < request_interval) return;
  requests_heard_ = clock_();
  try {
    if (settings_.requests()) find_running_seeds();
    request_waits_ = false;
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root(), 1 << 20);
    if (!hindrance) throw;
    find_running_seeds();
    request_waits_ = true;
    begin_pause(*hindrance);
  }
}

void Dispatcher::find_running_seeds() {
  for (int number = 0; number < pool_.size(); ++number) {
    Worker& worker = at(number);
    bool wanted = true;
    for (Assignment& about : worker.running) wanted = state_.find_place(about.given_seed) && wanted;
    if (worker.waiting) wanted = state_.find_place(worker.waiting->given_seed) && wanted;
    if (wanted || worker.watch.is_recalled()) continue;
    worker.watch.recall();
    pool_.drain(number);
  }
}

}  // namespace peclet::runner
