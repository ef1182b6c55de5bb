// Gives seeds to workers and hears what becomes of them, until every point is decided or the run is stopped.
//
// One turn: hear what happened, book all of it in one transaction, and act only after the commit: a job is
// sent when its attempt is durable, a spool file goes when its result is. When something is in the way that
// passes (pause.h), what happened is kept and booked again every few seconds, and until that succeeds no seed
// is given out: workers go on with those they have.
//
// A worker whose jobs are short would wait for that commit longer than it works. Where its engine can do it,
// it has a second job, which it begins by itself when the first has ended; until then that one has not begun,
// and whatever the worker does is not its fault.
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
#include "runner/owner/campaign_state.h"
#include "runner/owner/pause.h"

namespace peclet::runner {

struct DispatchSettings {
  int threads = 1;  // of each worker
  std::chrono::duration<double> lease{120};
  double checkpoint_seconds = 60;
  std::optional<std::chrono::duration<double>> time_limit{};
  // Called at every turn, about twice a second or more often. True when folders into which engines write had
  // been deleted and were made anew.
  std::function<bool()> chore = [] { return false; };
  // Called about once a second, between two bookings: carries out what people ask for. True when the state's
  // picture was taken again; a hindrance that passes leaves it taken again, and nothing changed.
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
  // Throws IntegrityError (an engine of another identity), InputError (a target that results do not have),
  // EngineError, DatabaseError. Whatever was reported until then is in the database or in the spool.
  Ending run();

 private:
  // A seed in the hands of a worker.
  struct Assignment {
    GivenSeed given_seed;
    Time given{};                // when the worker got it
    Time begun{};                // when there was no other before it any more, as far as we know
    bool shown = false;          // the database says how far it is
    bool lost_a_folder = false;  // somebody deleted one into which it writes
  };
  struct Worker {
    WorkerWatch watch{};
    std::int64_t engine = 0;
    bool takes_ahead = false;
    std::optional<Assignment> assignment{};  // of a busy worker, and of no other
    std::optional<Assignment> waiting{};     // behind the assignment
    std::int64_t finished_job = 0;           // the last one; attempts are numbered from 1
  };
  // What booking changes here; a copy takes its place if booking fails.
  struct Picture {
    std::vector<Worker> workers;
    int results = 0;
    int early_exits = 0;                         // of workers without a job, in a row
    std::vector<std::pair<int, Job>> to_send{};  // after the commit
  };
  enum class Stopping { no, finished, draining, at_once };

  void handle(const Hello& event);
  void handle(const Progressed& event);
  void handle(const ResultSpooled& event);
  void handle(const JobFailed& event);
  void handle(const Drained& event);
  void handle(const ShortOfRoom& event);
  void handle(const Garbled& event);
  void handle(const Exited& event);
  void handle(const StopSignal&) {}  // listen() has acted on it

  void turn();
  void listen();
  // Books what was heard. False: something is in the way, and nothing has changed.
  bool book();
  // Does what follows the commit. False: something is in the way of the rest.
  bool follow_up();
  std::uint64_t bytes_of_news() const;
  fs::path root() const;
  void begin_pause(const Hindrance& hindrance);
  void look_whether_it_is_over();
  void end_pause();
  void settle_spool();
  void obey_stop_signal();
  void hear_requests();
  // Finds the seeds that workers have in the state's new picture, and recalls workers with one that nobody
  // wants.
  void find_running_seeds();
  void start_workers();
  void give_out_seeds();
  void judge_leases();
  void judge_time();
  void show_leases();
  void stop(Stopping why);
  void report();

  std::optional<Assignment> next_assignment(int worker);
  bool takes_a_second_job(const Worker& worker) const;
  bool has_job(int worker, std::int64_t job);
  // Whether the worker may have failed because it could not write: no room, or no folder.
  bool lacked_room(int worker);
  void mark_lost_folders();
  void condemn(int worker, AttemptReason reason);
  // The worker is through with its job, and is at the one that waited or idle.
  void go_on(int worker);
  // Processor seconds that a worker can have spent since then.
  double processor_seconds_since(Time time) const;
  void end_assignment(int worker, const AttemptEnd& end);
  // Takes the result of a worker that has exited at this step of the job. False: it left none.
  bool left_result(int worker, const Assignment& about, std::int64_t step);
  // Of an assignment that has waited in vain.
  void give_back(const Assignment& waiting);
  void exited_during_job(int worker, const ExitStatus& ending);
  void exited_without_job(int worker, const ExitStatus& ending);
  Worker& at(int worker) { return now_.workers.at(static_cast<std::size_t>(worker)); }
  bool anyone_there() const;
  bool has_nothing_to_do() const;
  int busy() const;
  const char* why_nothing() const;

  Database& database_;
  CampaignState& state_;
  WorkerPool& pool_;
  RunListener& listener_;
  DispatchSettings settings_;
  Clock clock_;
  Picture now_;
  std::vector<WorkerEvent> news_;  // and not booked yet
  Pause pause_;
  bool unbooked_ = false;          // something is in the way
  bool uncarried_ = false;         // booked, and what follows the commit is not done
  bool request_waits_ = false;     // for something in the way
  std::set<std::string> told_of_;  // kinds of what was in the way since the campaign last went on
  Stopping stopping_ = Stopping::no;
  AwakeClock awake_;
  Time started_, reported_, leases_shown_, requests_heard_{};
  Awake stopping_since_{};
};

}  // namespace peclet::runner
