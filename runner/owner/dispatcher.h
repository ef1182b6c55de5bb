// Dispatcher gives seeds to workers and books their ends, until every point is decided or the run stops.
//
// Each turn collects events, books all of them in one transaction, and acts only after the commit: a job is
// sent when its attempt is durable, a spool file is removed when its result is. If something temporary is in
// the way (pause.h), the events are kept and booked again every few seconds. Until that succeeds no seed is
// given out, and workers continue with those they have.
//
// A worker has as many jobs as its engine runs at once. If an engine with several jobs dies, any of them may
// have done it, and none is blamed: blame.h says how the one is found.
//
// A worker whose jobs are shorter than a commit would mostly wait for commits. If its engine allows, it holds
// one more job, which it begins by itself when another has ended. Until then that job has not begun, and is
// not blamed for anything that the worker does.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/engines/worker_process.h"
#include "runner/owner/booked_worker.h"
#include "runner/owner/campaign_state.h"
#include "runner/owner/pause.h"
#include "runner/owner/worker_news.h"
#include "runner/owner/worker_starts.h"

namespace peclet::runner {

struct DispatchSettings {
  int threads = 1;  // per worker
  std::chrono::duration<double> lease{120};
  double checkpoint_seconds = 60;
  std::vector<std::string> hosts{};  // of launched workers; empty: workers run on this machine
  std::optional<std::chrono::duration<double>> time_limit{};
  // Called at every turn, about twice a second or more often. Returns true if folders into which engines
  // write had been deleted and were made anew.
  std::function<bool()> chore = [] { return false; };
  // Carries out requests, about once a second, between two bookings. Returns true if the state was read
  // again. It was also read again, with nothing changed, if a temporary hindrance is thrown.
  std::function<bool()> requests = [] { return false; };
};

class Dispatcher {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Clock = std::function<Time()>;

  // All references must outlive the dispatcher.
  Dispatcher(Database& database, CampaignState& state, WorkerPool& pool, RunListener& listener,
             DispatchSettings settings, Clock clock);

  enum class Ending { finished, stopped };
  // Throws IntegrityError (an engine of another identity), InputError (results lack the observable),
  // EngineError, DatabaseError. Everything reported until then is in the database or in the spool.
  Ending run();

 private:
  using Worker = BookedWorker;
  // State that booking changes; a copy is put back if booking fails.
  struct Snapshot {
    std::vector<Worker> workers;
    int results = 0;
    int early_exits = 0;                         // workers that ended without a job, in a row
    std::vector<std::pair<int, Job>> to_send{};  // jobs to be sent after the commit
    WorkerStarts starts{{}};                     // of launched workers
  };
  enum class Stopping { no, finished, draining, at_once };

  void handle(const Hello& event);
  void handle(const Progressed& event);
  void handle(const ResultSpooled& event);
  void handle(const JobFailed& event);
  void handle(const Drained& event);
  void handle(const ShortOfRoom& event);
  void handle(const Carrying& event);
  void handle(const Lost& event);
  void handle(const Garbled& event);
  void handle(const Exited& event);
  void handle(const StopSignal&) {}  // listen() has acted on it

  void turn();
  void listen();
  // Books the events. Returns false if something is in the way; then nothing has changed.
  bool book();
  // Does what follows the commit. Returns false if something is in the way of the rest.
  bool follow_up();
  fs::path root() const;
  void begin_pause(const Hindrance& hindrance);
  void look_whether_it_is_over();
  void end_pause();
  void settle_spool();
  void obey_stop_signal();
  void hear_requests();
  // Finds the places of the seeds that workers have after the state was read again. Recalls workers with a
  // seed that is no longer wanted.
  void find_running_seeds();
  void start_workers();
  void give_out_seeds();
  void judge_leases();
  void judge_time();
  void show_leases();
  void stop(Stopping why);
  void report();

  std::optional<Assignment> next_assignment(int worker);
  bool takes_a_further_job(const Worker& worker) const;
  // Returns the job that the worker runs. Condemns a worker that never had it, and returns null.
  Assignment* running_job(int worker, std::int64_t job);
  // True if the job may have failed because its worker could not write: a disk is full, or a deleted folder
  // was not made anew yet. Begins a pause if a disk is full now.
  bool lacked_room(const Assignment& about);
  void condemn(int worker, AttemptReason reason);
  // Returns the most processor time [s] that a worker can have spent since `time`.
  double processor_seconds_since(Time time) const;
  void end_assignment(int worker, const Assignment& about, const AttemptEnd& end);
  // Takes the result of a worker that exited at this step of its job. Returns false without a valid one.
  bool left_result(int worker, const Assignment& about, std::int64_t step);
  // Gives back a waiting assignment, which never began.
  void give_back(const Assignment& waiting);
  void exited_during_jobs(int worker, const ExitStatus& ending);
  void exited_without_job(int worker, const ExitStatus& ending);
  bool are_launched() const { return !settings_.hosts.empty(); }
  void launched_worker_ended(int worker, const ExitStatus& ending);
  Worker& at(int worker) { return now_.workers.at(static_cast<std::size_t>(worker)); }
  bool anyone_there() const;
  bool has_nothing_to_do() const;
  int busy() const;
  // Returns the number of jobs that all workers have room for.
  int places() const { return pool_.size() * capacity_; }
  const char* why_nothing() const;

  Database& database_;
  CampaignState& state_;
  WorkerPool& pool_;
  RunListener& listener_;
  DispatchSettings settings_;
  Clock clock_;
  Snapshot now_;
  WorkerNews news_;  // events not booked yet
  Pause pause_;
  bool unbooked_ = false;          // booking is blocked
  bool uncarried_ = false;         // effects of the last commit are not carried out yet
  bool request_waits_ = false;     // a request waits for something in the way
  std::set<std::string> told_of_;  // kinds of hindrances reported in the present pause
  Stopping stopping_ = Stopping::no;
  int capacity_ = 1;  // of the engine, as its last hello says
  AwakeClock awake_;
  Time started_, reported_, leases_shown_, requests_heard_{};
  Awake stopping_since_{};
};

}  // namespace peclet::runner
