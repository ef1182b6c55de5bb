// Runs many jobs at once, whose steps an ensemble makes.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/realisation/ensemble.h"
#include "engine/realisation/job.h"

namespace peclet::engine {

// Jobs that share an ensemble. Each has a thread of its own, which packs its spheres, waits while the
// ensemble makes its steps, and writes its checkpoints and its result. So the ensemble waits for no packing
// and no disk.
//
// One thread owns the crew and takes turn after turn; run() alone is called by the threads of the jobs.
class Crew {
 public:
  // A scene that the ensemble cannot run is refused if the device is `cuda`; else the processor runs it.
  Crew(Ensemble& ensemble, Device device);
  // Drains the jobs and waits for them. Their events must let them end.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  // Calls work(), which must not throw, in a thread of its own.
  void begin(std::function<void()> work);
  // Runs a job as run_job(), with one thread, in the thread that calls. It waits until few enough other jobs
  // pack or are run by the processor. Its progress is also reported by the thread that takes turns.
  std::optional<Json> run(JobSpecification job, const JobEvents& events);

  // Adds realisations that are ready, advances the ensemble for about a tenth of a second, and hands back
  // those that have ended. With none to advance it waits about as long for one, or for a thread to end. If
  // the ensemble fails, all its jobs end by an error, which is thrown here too.
  void turn();
  // Gives all realisations back to their jobs, and begins no others. The events of jobs ask to drain already.
  void drain();

  // Returns the number of threads that have not ended.
  std::size_t active();

 private:
  using Clock = std::chrono::steady_clock;

  // A limit on the number of jobs that do the same at the same time.
  struct Places {
    int free;
  };
  // A realisation while its thread waits.
  struct Stay {
    Simulation* simulation;
    const JobEvents* events;
    double share;  // of the ensemble
    Clock::time_point until;
    bool holds_share = false, is_over = false;
    std::optional<Ending> ending;
    double processor_seconds = 0;
  };
  struct Member {
    std::thread thread;
    bool has_ended = false;
  };

  // Waits for a place. Returns false if the crew drains.
  bool take(Places& places);
  void give_back(Places& places);
  bool drains();
  std::optional<Ending> steps_of(Stay& stay);
  void release_share(Stay& stay);
  bool next_fits() const;  // into the ensemble, of those that are ready
  void take_aboard();
  void hand_back(Stay& stay);
  // Calls use(), which calls the ensemble. If that fails, all jobs end by an error.
  template <class Use>
  void with_ensemble(const Use& use);

  Ensemble& ensemble_;
  const Device device_;
  std::mutex mutex_;  // guards all below but aboard_
  std::condition_variable changed_;
  std::list<Member> members_;
  Places packing_, running_;
  std::deque<Stay*> ready_;    // to be added
  std::vector<Stay*> aboard_;  // in the ensemble
  double taken_ = 0;           // sum of shares
  bool drains_ = false;
  std::string failure_;  // of the ensemble; empty: none
};

}  // namespace peclet::engine
