// Loops over independent indices, shared among threads.
#pragma once

#include <omp.h>

#include <cstddef>

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

}  // namespace peclet::engine
