// Threads: loops over independent indices, teams with barriers, and how threads wait.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace peclet::engine {

// OpenMP's library is not compiled with the thread sanitizer, which has to be told where one thread hands its
// work to another: it releases here and acquires there. (What OpenMP itself passes on is written after that,
// which is why in_parallel() is not checked; the bodies are.) Nothing in other builds.
inline char handed_over = 0;
inline void release_work() {
#ifdef __SANITIZE_THREAD__
  __tsan_release(&handed_over);
#endif
}
inline void acquire_work() {
#ifdef __SANITIZE_THREAD__
  __tsan_acquire(&handed_over);
#endif
}

// Calls body(part, parts) on each of some threads: `threads` of them, or fewer where OpenMP has no more.
template <class Body>
[[gnu::no_sanitize("thread")]] void in_parallel(int threads, Body&& body) {
  release_work();
#pragma omp parallel num_threads(threads)
  {
    acquire_work();
    body(static_cast<std::size_t>(omp_get_thread_num()), static_cast<std::size_t>(omp_get_num_threads()));
    release_work();
  }
  acquire_work();
}

// Calls body(begin, end) for consecutive parts of [0, count), one per thread. One thread never enters OpenMP:
// a parallel region of a single thread still takes and frees a team, which costs more than a step of two
// spheres.
template <class Body>
[[gnu::no_sanitize("thread")]] void for_each_range(std::size_t count, int threads, Body&& body) {
  if (threads <= 1) {
    body(std::size_t{0}, count);
    return;
  }
  in_parallel(threads, [&](std::size_t part, std::size_t parts) {
    body(count * part / parts, count * (part + 1) / parts);
  });
}

// Calls body(i) for every index i in [0, count), as for_each_range().
template <class Body>
void for_each_index(std::size_t count, int threads, const Body& body) {
  for_each_range(count, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// A team of threads that do one piece of work together, as one of its members sees it. Nothing is defined
// here, because this is shared with files that are compiled for one processor only.
class Team {
 public:
  // How often each member has arrived, far enough apart for none to disturb another's.
  struct alignas(64) Arrivals {
    std::atomic<std::uint64_t> count = 0;
  };

  Team();  // of one
  Team(std::span<Arrivals> arrivals, std::size_t member);

  bool is_first() const;

  struct Part {
    std::size_t begin, end;
  };
  // This member's part of [0, count): consecutive, about as large as the others'.
  Part part_of(std::size_t count) const;

  // Whoever waits for this arrival sees what this member has done before it.
  void arrive();
  // Until every member has arrived as often as this one. Between arrival and wait there may be work: then
  // members seldom wait, though their parts take different times.
  void wait();
  void meet();  // arrives and waits

 private:
  std::span<Arrivals> arrivals_;
  std::size_t member_ = 0;
  std::uint64_t arrived_ = 0;
};

// Calls body(team) as each of the members of a team of that many threads. One thread never enters OpenMP.
template <class Body>
void run_team(int threads, Body&& body) {
  if (threads <= 1) {
    Team team;
    body(team);
    return;
  }
  std::vector<Team::Arrivals> arrivals(static_cast<std::size_t>(threads));
  in_parallel(threads, [&](std::size_t member, std::size_t members) {
    Team team({arrivals.data(), members}, member);
    body(team);
  });
}

// Lets threads that wait for each other sleep.
//
// libgomp's threads spin while they wait, for milliseconds as long as there are no more of them than
// processors. Where other work has the processors, a thread that spins takes the time of the one it waits
// for. This has them sleep much sooner, unless the environment says how they are to wait (OMP_WAIT_POLICY,
// GOMP_SPINCOUNT).
//
// libgomp reads the environment before main(), so this starts the program once more with the same process
// number, arguments and open files. Call it first of all. Where that cannot be done threads wait as libgomp
// has them: it costs time and changes no result.
void let_waiting_threads_sleep(char** arguments);

}  // namespace peclet::engine
