// How long a campaign will still take, from what its points cost so far. Pure.
#pragma once

#include <optional>
#include <vector>

#include "runner/cohorts.h"

namespace peclet::runner {

// What realisations of a point cost, in seconds of a worker.
struct Cost {
  int count = 0;
  double sum = 0, sum_of_squares = 0;
  void add(double seconds);
};

struct PointForecast {
  Cost cost;
  std::vector<Look> looks;
  int begun = 0;  // seeds that have ended or run now
  bool decided = false;
};

// Seconds until every point is decided. low and high: one standard deviation of the costs and of the number
// of seeds that the interval's width so far suggests.
struct TimeToGo {
  double likely = 0, low = 0, high = 0;
};

// Seeds at which the point may be expected to stop: the half-width falls as 1 / sqrt(n), so n (half-width /
// tolerated)^2, rounded up to a look. `factor` scales that square.
int expected_seeds(const std::vector<Look>& looks, const Target& target, int minimum, int maximum,
                   double factor = 1);

// Nothing while no realisation of any undecided point has ended.
std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers);

}  // namespace peclet::runner
