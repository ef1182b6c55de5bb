// Runs loops and teams of threads, and sets how threads wait.
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

// Tell the thread sanitizer that one thread hands its work to another, because OpenMP's library is not
// compiled with it. OpenMP writes what it passes on after release_work(), so in_parallel() is not checked;
// the bodies are. Other builds do nothing here.
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

// Calls body(part, parts) on each of `threads` threads, or on fewer if OpenMP provides fewer.
template <class Body>
__attribute__((no_sanitize("thread"))) void in_parallel(int threads, Body&& body) {
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
__attribute__((no_sanitize("thread"))) void for_each_range(std::size_t count, int threads, Body&& body) {
  if (threads <= 1) {
    body(std::size_t{0}, count);
    return;
  }
  in_parallel(threads, [&](std::size_t part, std::size_t parts) {
    body(count * part / parts, count * (part + 1) / parts);
  });
}

// Calls body(i) for every index i in [0, count), shared out as by for_each_range().
template <class Body>
void for_each_index(std::size_t count, int threads, const Body& body) {
  for_each_range(count, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// One member's view of a team of threads that work together. Its functions are not defined here because files
// that are compiled for one processor only include this header.
class Team {
 public:
  // The number of times that a member has arrived, in a cache line of its own.
  struct alignas(64) Arrivals {
    std::atomic<std::uint64_t> count = 0;
  };

  Team();  // a team of one
  Team(std::span<Arrivals> arrivals, std::size_t member);

  bool is_first() const;

  struct Part {
    std::size_t begin, end;
  };
  // Returns this member's part of [0, count): consecutive, about as large as the others'.
  Part part_of(std::size_t count) const;

  // Counts an arrival. Members that wait for it see all that this member wrote before.
  void arrive();
  // Waits until every member has arrived as often as this one. Work between arrive() and wait() hides that
  // parts take different times.
  void wait();
  void meet();  // arrives and waits

 private:
  std::span<Arrivals> arrivals_;
  std::size_t member_ = 0;
  std::uint64_t arrived_ = 0;
};

// Calls body(team) on each thread of a team. One thread never enters OpenMP.
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

// Makes waiting threads sleep soon, unless the environment sets OMP_WAIT_POLICY or GOMP_SPINCOUNT.
//
// By default libgomp's threads spin for milliseconds if there are no more of them than processors. If other
// work uses the processors, a spinning thread takes time from the one that it waits for.
//
// libgomp reads the environment before main(), so this starts the program once more with the same process id,
// arguments and open files. Call it first of all. If that fails, threads spin as before: it costs time and
// changes no result.
void let_waiting_threads_sleep(char** arguments);

}  // namespace peclet::engine
