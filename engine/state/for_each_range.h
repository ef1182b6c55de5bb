// Loops over independent indices, shared among threads.
#pragma once

#include <omp.h>

#include <cstddef>

namespace peclet::engine {

// Calls body(begin, end) for consecutive parts of [0, count), one per thread. One thread never enters OpenMP:
// a parallel region of a single thread still takes and frees a team, which costs more than a step of two
// spheres.
template <class Body>
void for_each_range(std::size_t count, int threads, Body&& body) {
  if (threads <= 1) {
    body(std::size_t{0}, count);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    const auto parts = static_cast<std::size_t>(omp_get_num_threads());
    const auto part = static_cast<std::size_t>(omp_get_thread_num());
    body(count * part / parts, count * (part + 1) / parts);
  }
}

}  // namespace peclet::engine
