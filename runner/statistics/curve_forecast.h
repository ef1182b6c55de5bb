// Forecasts the seeds of the points of a curve, which are decided together.
//
// The rounds of curve_stop_tests.h are made on what is known: a further seed at a point narrows the band as
// if it were the mean of the curve there, with the spread of the seeds that have ended. A point is met when
// its own interval is expected to be (stop_after), or when the band is. If the curve is refused, or is of too
// few points, each point is expected to stop by its own interval.
#pragma once

#include <functional>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/forecast.h"

namespace peclet::runner {

// The seeds of a point that have ended, and what they say of it.
struct SeedsSoFar {
  std::vector<Estimate> estimates{};  // over all ended seeds, of Target::observables() in that order
  int ended = 0;                      // seeds, lost ones included
  double cost = 0;                    // of a seed, in any unit; 0: unknown
  bool is_done = false;               // decided or cancelled: gets no more seeds
};

// Returns how the truth deviates from a sample with this number of values. An empty function: not at all.
using TruthOf = std::function<Truth(int values)>;

class CurveForecast {
 public:
  // `points` has all points of the sweep.
  CurveForecast(const Curve& curve, const std::vector<SeedsSoFar>& points, const Target& target, int minimum,
                int maximum);
  CurveForecast(CurveForecast&&) noexcept;
  CurveForecast& operator=(CurveForecast&&) = delete;
  ~CurveForecast();

  // Returns the number of seeds at which each point of the curve, in its order, is expected to be decided.
  std::vector<int> stops(const TruthOf& truth_of = {}) const;

 private:
  class OneCriterion;
  std::vector<OneCriterion> criteria_;
};

}  // namespace peclet::runner
