// Gives seeds to workers and hears what becomes of them, until every point is decided or the run is stopped.
//
// One turn: hear what happened, book all of it in one transaction, and act only after the commit: a job is
// sent when its attempt is durable, a spool file goes when its result is. When the disk is full, what
// happened is kept and booked again every few seconds, and until that succeeds no seed is given out: workers
// go on with those they have.
//
// A worker whose jobs are short would wait for that commit longer than it works. Where its engine can do it,
// it has a second job, which it begins by itself when the first has ended; until then that one has not begun,
// and whatever the worker does is not its fault.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runner/engines/worker_pool.h"
#include "runner/folder/room.h"
#include "runner/owner/ledger.h"

namespace peclet::runner {

struct DispatchSettings {
  int threads = 1;  // of each worker
  std::chrono::duration<double> lease{120};
  double checkpoint_seconds = 60;
  std::optional<std::chrono::duration<double>> time_limit{};
  // Called at every turn, about twice a second or more often.
  std::function<void()> chore = [] {};
  // Called about once a second, between two bookings: carries out what people ask for. True when the ledger's
  // picture was taken again; a DatabaseError for want of room leaves it taken again, and nothing changed.
  std::function<bool()> requests = [] { return false; };
};

class Dispatcher {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Clock = std::function<Time()>;
  // Time during which this process ran. Leases and patience are measured in it: an owner that was stopped, or
  // frozen together with its workers, has heard nothing meanwhile and must not hold that against them.
  using Awake = std::chrono::duration<double>;

  // All references must outlive the dispatcher.
  Dispatcher(Database& database, Ledger& ledger, WorkerPool& pool, RunListener& listener,
             DispatchSettings settings, Clock clock);

  enum class Ending { finished, stopped };
  // Throws IntegrityError (an engine of another identity), InputError (a target that results do not have),
  // EngineError, DatabaseError. Whatever was reported until then is in the database or in the spool.
  Ending run();

 private:
  // A seed in the hands of a worker, and how far it is.
  struct Assignment {
    Grant grant;
    int phase = 0;
    std::int64_t step = 0, steps = 0;
    double strain = 0;
    Time given{};        // when the worker got it
    Time begun{};        // when there was no other before it any more, as far as we know
    Awake renewed{};     // when it last came forward
    bool shown = false;  // the database says how far it is
  };
  enum class Stage { absent, starting, idle, busy };
  struct Worker {
    Stage stage = Stage::absent;
    Awake since{};  // of the stage
    std::int64_t engine = 0;
    bool takes_ahead = false;
    std::optional<Assignment> assignment{};
    std::optional<Assignment> waiting{};        // behind the assignment; only of a busy worker
    std::int64_t finished_job = 0;              // the last one; attempts are numbered from 1
    std::optional<AttemptOutcome> condemned{};  // killed by us, and why
    bool recalled = false;                      // told to leave a seed that is not wanted any more
    std::string message{};
  };
  // What booking changes here, to be taken back with it.
  struct Picture {
    std::vector<Worker> workers;
    int results = 0;
    int early_exits = 0;                  // of workers without a job, in a row
    std::vector<std::string> warnings{};  // to be given after the commit
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
  void stay_awake();
  void listen();
  // Books what was heard. False: there is no room, and nothing has changed.
  bool book();
  void take_back(const Picture& before);
  void begin_shortage(const std::filesystem::path& folder, std::uint64_t bytes);
  void look_for_room();
  void end_shortage();
  void settle_spool();
  void obey_stop_signal();
  void hear_requests();
  // The ledger's picture is new: it hears who has which seeds, and workers with one that nobody wants leave.
  void mark_running_seeds();
  void start_workers();
  void give_out_seeds();
  void judge_leases();
  void judge_time();
  void show_leases();
  void stop(Stopping why);
  void report();

  std::optional<Assignment> next_assignment(int worker);
  bool takes_one_more(const Worker& worker) const;
  bool has_job(int worker, std::int64_t job);
  // Whether the worker may have failed because it could not write: no room, or no folder.
  bool lacked_room(int worker);
  void condemn(int worker, AttemptOutcome outcome, const std::string& message);
  // The worker is through with its job, and is at the one that waited or idle.
  void go_on(int worker);
  // Processor seconds that a worker can have spent since then.
  double processor_seconds_since(Time time) const;
  void end_assignment(int worker, const AttemptEnd& end);
  // Takes the result of a worker that has exited. False: it left none for this.
  bool left_result(int worker, const Assignment& about);
  // Of an assignment that has waited in vain.
  void give_back(const Assignment& waiting);
  void exited_during_job(int worker, const ExitStatus& ending);
  void exited_without_job(int worker, const ExitStatus& ending, Stage stage);
  Worker& at(int worker) { return now_.workers.at(static_cast<std::size_t>(worker)); }
  bool anyone_there() const;
  bool has_nothing_to_do() const;
  const char* why_nothing() const;

  Database& database_;
  Ledger& ledger_;
  WorkerPool& pool_;
  RunListener& listener_;
  DispatchSettings settings_;
  Clock clock_;
  Picture now_;
  std::vector<WorkerEvent> news_;             // and not booked yet
  std::vector<std::pair<int, Job>> to_send_;  // after the commit
  Shortage shortage_;
  bool unbooked_ = false;       // for want of room
  bool request_waits_ = false;  // for the same
  bool told_of_shortage_ = false;
  Stopping stopping_ = Stopping::no;
  Time started_, heard_, reported_, leases_shown_, requests_heard_{};
  Awake awake_{}, stopping_since_{};
};

}  // namespace peclet::runner
