// How many seeds points still need, and how long a campaign will take, from what its seeds have cost and how
// they scatter. Pure.
//
// Seeds. Of n values with the sample variance s^2 the true variance is distributed as
//   (n - 1) s^2 / chi^2(n - 1),
// and the true share of k ones in n values as Beta(k + 1/2, n - k + 1/2). For each quantile of these the stop
// rule, carried out with the estimates that are expected of more seeds, gives the stop test at which the
// point stops: stop_after(). The median is what is expected, and two outer quantiles are the ends of the
// range. All observables of a target have the same quantile.
//
// A sum over points is known better than each of them, since their errors partly cancel. There the variances
// of all points are off by one factor, f / chi^2(f), with Satterthwaite's degrees of freedom of a sum of
// variances,
//   f = (sum w)^2 / sum(w^2 / (n - 1)),
// w being what a point is expected to cost. Of one point, or one that outweighs the others, f = n - 1.
//
// Time. Seeds that jam or fail early end first, so that the mean of those that have ended is too small: seeds
// that still run count as longer than they have taken (mean_cost). With the number of seeds go the scatter of
// the costs and the error of their mean, each point's on its own, so that their squares add up. What all
// points have in common is the machine: other work, heat and clock rates change its speed, which nothing in
// the past tells. Both ends of a range leave room for that, see machine_allowance.
//
// results/planning has how often the ranges hold the truth.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// What is expected, with the range that holds it 95 % of the time.
template <typename Number>
struct Expected {
  Number likely{}, lower{}, upper{};
};

// How the truth may differ from a sample. The default is as the sample says.
struct Truth {
  double variance = 1;               // over the sample's
  std::optional<double> quantile{};  // of a share, from 0 or 1 towards 1/2
};
// Returns the truth at a quantile for a sample with these degrees of freedom; if they are NaN, the variance
// is known.
Truth truth_at(double degrees, double quantile);

// Returns numbers_at(quantile) at the median and at the ends of the range. These lie beyond 2.5 and 97.5 %,
// because the estimates at the stop tests scatter, too (results/planning).
template <typename Numbers>
auto expected(const Numbers& numbers_at) {
  constexpr double outside = 0.02;
  const auto [lower, upper] = std::minmax({numbers_at(outside), numbers_at(1 - outside)});
  return Expected<decltype(numbers_at(0.5))>{numbers_at(0.5), lower, upper};
}

// Returns the first look after `ended` seeds at which the point stops if it goes on as its first `ended`
// seeds, which have these estimates, let expect; the last stop test if none stops it. Requires two values of
// each observable, unless the rule has no tolerance.
int stop_after(const std::vector<Estimate>& all_seeds, int ended, StopRule& rule, const Truth& truth = {});
// Returns the rounds of all workers in which a point comes from `ended` to `seeds` ended seeds: a stop test
// waits for all its seeds.
double rounds_until(int ended, int seeds, const std::vector<int>& schedule, int workers);

// Why nothing can be predicted of a point.
enum class Obstacle {
  none,
  too_few,    // fewer than two seeds have ended
  lost,       // fewer than two of them with a value
  no_spread,  // all values of an observable are equal, and it is no share
  near_zero   // the mean of a relative tolerance is within two standard errors of zero: it means nothing yet
};

struct Prediction {
  Obstacle obstacle = Obstacle::none;
  int pilot = 0;  // seeds that it was made from: 0 .. pilot - 1
  int lost = 0;   // of them, to the observable that lacks most; later ones are taken to be lost as often
  std::vector<Estimate> estimates{};  // of the pilot
  Expected<int> seeds;                // of the deciding stop test
  double capped = 0;                  // probability of ending at the maximum without convergence

  int fewest_values() const { return pilot - lost; }
};

// Predicts the seeds of a point that is not decided from outcomes as of replay_stop_tests(), up to the first
// seed that has not ended. Without a tolerance there is no obstacle, and the number of seeds is sure.
Prediction predict(const std::vector<std::optional<Outcome>>& outcomes, const Target& target, int minimum,
                   int maximum);

// "2 of 4 seeds are lost", for people; "" without an obstacle.
std::string obstacle_text(const Prediction& prediction);

// Returns the number of seeds at which a point with these stop tests is expected to stop if its spread stays
// that of the last stop test.
int expected_seeds(const std::vector<StopTest>& stop_tests, const Target& target, int minimum, int maximum);

// The factor by which the mean speed of a machine may change, either way. Chosen so that ranges hold the time
// to go 93 to 98 % of the time if the speed wanders between 1 and 1/2 (results/planning).
constexpr double machine_allowance = 1.3;

// The costs of realisations that have ended, in seconds of a worker.
class Cost {
 public:
  Cost() = default;
  explicit Cost(std::vector<double> seconds);
  void add(double seconds);
  int count() const { return static_cast<int>(seconds_.size()); }
  double sum() const { return sum_; }
  double squares() const { return squares_; }
  // Requires at least one.
  double mean() const { return sum_ / count(); }
  const std::vector<double>& ascending() const { return seconds_; }

 private:
  std::vector<double> seconds_;  // ascending
  double sum_ = 0, squares_ = 0;
};

// What is known of a seed that a worker has.
struct Unfinished {
  double taken = 0;               // seconds of a worker so far
  std::optional<double> whole{};  // seconds of all its steps, at the rate so far
};

// The cost [s] of a seed that is yet to come, from seeds that have ended and seeds that run: the mean of
// Kaplan and Meier's estimate, by redistribution to the right (Efron, Proc. 5th Berkeley Symp. 4, 831, 1967).
// Each seed has a share of 1 / n. A running seed hands its share in equal parts to the seeds that have taken
// longer. Where none of these has ended, it is expected to run to its end. Requires a seed.
double mean_cost(const Cost& ended, const std::vector<Unfinished>& running);

// What the time to go of a point depends on.
struct PointForecast {
  Cost cost;
  std::vector<Estimate> all_seeds{};  // of the values that have ended, of Target::observables() in that order
  int ended = 0;                      // seeds, lost ones included
  int running = 0;                    // seeds that workers have
  bool decided = false;
  std::vector<Unfinished> unfinished{};  // of the running seeds those of which something is known
};

using TimeToGo = Expected<double>;  // seconds until every point is decided

// "12 min to go (10 min to 18 min)"; "" below half a second.
std::string to_string(const TimeToGo& to_go);
// {"likely": 720, "low": 600, "high": 1080}; null if nothing is known.
Json to_json(const std::optional<TimeToGo>& to_go);

// Returns the longer one of two times: of the work, shared by the workers, and of the stop tests of a point,
// which come one after another and wait for all of their seeds. Nothing if no realisation has ended yet.
std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers);

}  // namespace peclet::runner
