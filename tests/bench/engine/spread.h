// Processor times of a thread and their spread.
#pragma once

#include <time.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace peclet::engine {

struct Spread {
  double smallest = 0, median = 0, largest = 0;
};

// Returns smallest, median and largest value; throws std::invalid_argument if `values` is empty.
inline Spread spread_of(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("nothing has been measured");
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

// Returns the processor time of this thread [s], or wall-clock time if other threads work with it.
inline double seconds(bool wall = false) {
  timespec now{};
  clock_gettime(wall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace peclet::engine
