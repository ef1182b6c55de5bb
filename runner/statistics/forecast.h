// Forecasts the seeds that points still need and the duration of a campaign, from the costs and the scatter
// of its seeds. All functions are pure.
//
// Seeds. For n values with the sample variance s^2 the true variance is distributed as
//   (n - 1) s^2 / chi^2(n - 1),
// and the true share of k ones in n values as Beta(k + 1/2, n - k + 1/2). For each quantile of these
// distributions, stop_after() returns the stop test at which the estimates of more seeds are expected to
// stop the point. The median is the expected number, and two outer quantiles are the ends of the range. All
// observables of a target have the same quantile.
//
// A sum over points is known better than each point, since their errors partly cancel. For a sum, the
// variances of all points deviate by one factor, f / chi^2(f), with Satterthwaite's degrees of freedom of a
// sum of variances,
//   f = (sum w)^2 / sum(w^2 / (n - 1)),
// where w is the expected cost of a point. For one point, or one that outweighs the others, f = n - 1.
//
// Time. Seeds that jam or fail early end first, so the mean cost of ended seeds is too small. Running seeds
// therefore count as longer than they have taken (mean_cost). The number of seeds, the scatter of the costs
// and the error of their mean are uncertain for each point independently, so the squares add up. All points
// share the speed of the machine, which other work, heat and clock rates change unpredictably. Both ends of
// a range allow for that by machine_allowance.
//
// results/planning measures how often the ranges hold the truth.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// An expected number, with the range that holds the true one 95 % of the time.
template <typename Number>
struct Expected {
  Number likely{}, lower{}, upper{};
};

// The assumed deviation of the truth from a sample; none by default.
struct Truth {
  double variance = 1;               // true variance over that of the sample
  std::optional<double> quantile{};  // of a share, counted from 0 or 1 towards 1/2
};
// Returns the truth at a quantile for a sample with these degrees of freedom. If they are NaN, the variance
// is exact.
Truth truth_at(double degrees, double quantile);

// Returns numbers_at(quantile) at the median and at the ends of the range. The ends are 2 and 98 % instead of
// 2.5 and 97.5 %, because the estimates at the stop tests scatter, too (results/planning).
template <typename Numbers>
auto expected(const Numbers& numbers_at) {
  constexpr double outside = 0.02;
  const auto [lower, upper] = std::minmax({numbers_at(outside), numbers_at(1 - outside)});
  return Expected<decltype(numbers_at(0.5))>{numbers_at(0.5), lower, upper};
}

// Returns the first stop test after `ended` seeds at which the point is expected to stop, from the estimates
// of its first `ended` seeds. Returns the last stop test if none is expected to stop it. Requires two values
// of each observable, unless the rule has no tolerance.
int stop_after(const std::vector<Estimate>& all_seeds, int ended, StopRule& rule, const Truth& truth = {});
// Returns the rounds of all workers in which a point gets from `ended` to `seeds` ended seeds. Each stop test
// waits for all its seeds.
double rounds_until(int ended, int seeds, const std::vector<int>& schedule, int workers);

// The reason why a point cannot be predicted.
enum class Obstacle {
  none,
  too_few,    // fewer than two seeds have ended
  lost,       // fewer than two of them have a value
  no_spread,  // all values of an observable are equal, and it is not a share
  near_zero   // the mean to which a tolerance is relative is within two standard errors of zero
};

// A prediction of the number of seeds that a point needs.
struct Prediction {
  Obstacle obstacle = Obstacle::none;
  int pilot = 0;  // it is made from the seeds 0 .. pilot - 1
  int lost = 0;   // of these, by the observable with the fewest values; later seeds are lost as often
  std::vector<Estimate> estimates{};  // of the pilot
  Expected<int> seeds;                // at the deciding stop test
  double capped = 0;                  // probability of ending at the maximum without convergence

  int fewest_values() const { return pilot - lost; }
};

// Predicts the seeds of an undecided point from its outcomes, in seed order, up to the first seed that has
// not ended. Without a tolerance there is no obstacle, and the number of seeds is certain.
Prediction predict(const std::vector<std::optional<Outcome>>& outcomes, const Target& target, int minimum,
                   int maximum);

// Returns the obstacle in words, such as "2 of 4 seeds are lost"; "" without an obstacle.
std::string obstacle_text(const Prediction& prediction);

// Returns the number of seeds at which a point with these stop tests is expected to stop if its spread stays
// that of the last stop test. This is the minimum before the first stop test, and the maximum if the last
// one allows no forecast.
int expected_seeds(const std::vector<StopTest>& stop_tests, const Target& target, int minimum, int maximum);

// The factor by which the mean speed of a machine may rise or fall. With it, ranges hold the time to go in 93
// to 98 % of the cases if the speed wanders between 1 and 1/2 (results/planning).
constexpr double machine_allowance = 1.3;

// The costs of realisations that have ended [s of a worker].
class Cost {
 public:
  Cost() = default;
  explicit Cost(std::vector<double> seconds);
  void add(double seconds);
  int count() const { return static_cast<int>(seconds_.size()); }
  double sum() const { return sum_; }
  double squares() const { return squares_; }
  // Requires at least one cost.
  double mean() const { return sum_ / count(); }
  const std::vector<double>& ascending() const { return seconds_; }

 private:
  std::vector<double> seconds_;  // ascending
  double sum_ = 0, squares_ = 0;
};

// The progress of a seed that runs.
struct Unfinished {
  double taken = 0;               // time since its start [s of a worker]
  std::optional<double> whole{};  // expected time of all its steps [s]; none if its rate is unknown
};

// Returns the expected cost [s] of a future seed, from ended and running seeds: the mean of Kaplan and
// Meier's estimate, by redistribution to the right (Efron, Proc. 5th Berkeley Symp. 4, 831, 1967). Each of n
// seeds has a share of 1 / n. A running seed passes its share in equal parts to the seeds that have taken
// longer. If none of these has ended, it is expected to run to its end. Requires a seed.
double mean_cost(const Cost& ended, const std::vector<Unfinished>& running);

// The state of a point, from which its time to go is forecast.
struct PointForecast {
  Cost cost;
  std::vector<Estimate> all_seeds{};  // over all ended seeds, of Target::observables() in that order
  int ended = 0;                      // seeds, lost ones included
  int running = 0;                    // seeds that workers have
  bool decided = false;
  std::vector<Unfinished> unfinished{};  // running seeds with known progress
};

using TimeToGo = Expected<double>;  // until every point is decided [s]

// Returns "12 min to go (10 min to 18 min)", or "" below half a second.
std::string to_string(const TimeToGo& to_go);
// Returns {"likely": 720, "low": 600, "high": 1080} [s], or null if nothing is known.
Json to_json(const std::optional<TimeToGo>& to_go);

// Returns the seeds at which each point is expected to stop. `curves` are those of the target: their points
// are decided together (curve_forecast.h), which takes a fraction of a second.
std::vector<Expected<int>> expected_stops(const std::vector<PointForecast>& points, const Target& target,
                                          int minimum, int maximum, const std::vector<Curve>& curves = {});

// Returns the longer of two times: that of all work, shared by the workers, and that of the slowest point,
// whose stop tests follow one another and wait for all their seeds. Returns nothing if no realisation has
// ended yet. `stops` are the expected_stops(), and `are_joint` says that the points are those of curves.
std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points,
                                   const std::vector<Expected<int>>& stops, int minimum, int maximum,
                                   int workers, bool are_joint);
std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers,
                                   const std::vector<Curve>& curves = {});

}  // namespace peclet::runner
