// How long a campaign will still take, from what its points have cost and scattered so far. Pure.
//
// Of a point with v values the true variance is not known better than (v - 1) / chi^2(v - 1) times the
// sample's: the stop rule, carried out with its 10 % and 90 % quantiles, gives the range of the seeds to
// come. Seeds that jam or fail early end first, so that the mean of those that have ended is too small: seeds
// that still run count as longer than they have taken (mean_cost). With the number of seeds go the scatter of
// the costs and the error of their mean, each point's on its own, so that their squares add up. What all
// points have in common is the machine: other work, heat and clock rates change its speed, which nothing in
// the past tells. Both ends of a range leave room for that, see machine_allowance. results/planning has how
// often the ranges hold the truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// By what the mean speed of a machine in the time to come may differ from that so far, either way. Chosen so
// that ranges hold the time to go 93 to 98 % of the time where the speed wanders between 1 and 1/2
// (results/planning).
constexpr double machine_allowance = 1.3;

// What realisations of a point that have ended cost, in seconds of a worker.
struct Cost {
  std::vector<double> seconds{};
  double sum = 0;
  void add(double of_one);
  // Forgets those that were added last.
  void keep_first(int count);
  int count() const { return static_cast<int>(seconds.size()); }
  // Requires at least one.
  double mean() const { return sum / count(); }
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

struct PointForecast {
  Cost cost;
  std::vector<Estimate> so_far{};  // of the values that have ended, of Target::observables() in that order
  int ended = 0;                   // seeds, lost ones included
  int running = 0;                 // seeds that workers have
  bool decided = false;
  std::vector<Unfinished> unfinished{};  // of the running seeds those of which something is known

  // Values of the observable that has the fewest.
  int fewest_values() const;
};

// Seconds until every point is decided; low and high hold it some 95 % of the time.
struct TimeToGo {
  double likely = 0, low = 0, high = 0;
};

// "12 min to go (10 min to 18 min)"; "" below half a second.
std::string to_string(const TimeToGo& to_go);
// {"likely": 720, "low": 600, "high": 1080}; null for nothing.
Json to_json(const std::optional<TimeToGo>& to_go);

// Seeds at which the point may be expected to stop by the stop rule, if its spread is what it was at the last
// look. `factor` scales the variance.
int expected_seeds(const std::vector<Look>& looks, const Target& target, int minimum, int maximum,
                   double factor = 1);

// The longer of what the work takes that is shared by the workers, and of the looks of a point, which come
// one after another and wait for all of their seeds. Nothing while no realisation of any undecided point has
// ended.
std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers);

}  // namespace peclet::runner
