// How many seeds a point will need, from its first ones, before the others run. Pure.
//
// The stop rule is carried out in many futures. In each of them the true mean mu and standard deviation sigma
// are drawn from what n values of mean m and sample variance s^2 leave open,
//   (n - 1) s^2 / sigma^2 ~ chi^2(n - 1),   mu ~ N(m, sigma^2 / n),
// and the values to come from a normal population of these (of a share of k in n, from one with p ~ Beta(k +
// 1/2, n - k + 1/2)), look by look, until the stop rule (stop_rule.h) calls it converged or the maximum is
// reached. What is expected is the median of the futures' deciding looks; 95 % of them lie within the range.
// Several observables of a target are drawn independently of each other.
//
// Of a sum over points more is known than of each, since their errors partly cancel. There the variances of
// all points are off by one factor, f / chi^2(f), with the degrees of freedom that Satterthwaite gives a sum
// of variances: f = (sum w)^2 / sum(w^2 / (n - 1)), w being what a point is expected to cost. For one point,
// or one that outweighs the others, that is the same as above.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runner/statistics/cohorts.h"
#include "runner/statistics/expected.h"

namespace peclet::runner {

// Why nothing can be said of a point.
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
  Expected<int> seeds;  // of the deciding look
  double capped = 0;    // share of the futures that end at the maximum without convergence
};

constexpr int futures = 2000;

// Requires a point that is not decided. Outcomes are those of replay_looks(); seeds before the first one that
// has not ended count. `stream` keeps points independent of each other; equal arguments give equal answers.
Prediction predict(const std::vector<std::optional<Outcome>>& outcomes, const Target& target, int minimum,
                   int maximum, std::uint64_t stream);

// "2 of 4 seeds are lost", for people; nothing without an obstacle.
std::string obstacle_text(const Prediction& prediction);

// By what the variances of all points are off in each future, for a sum of what they cost; of a stream that
// no point has.
struct CostShare {
  double cost = 0;  // w
  int values = 0;   // n, 2 or more
};
std::vector<double> common_factors(const std::vector<CostShare>& shares);

// The deciding look in each of these futures, as its place in the schedule. As predict(), without an
// obstacle.
std::vector<int> places_of_looks(const std::vector<std::optional<Outcome>>& outcomes, const Target& target,
                                 int minimum, int maximum, std::uint64_t stream,
                                 const std::vector<double>& factors);

// The middle of the values and the range that holds 95 % of them. Requires at least one.
Expected<double> middle(std::vector<double> values);

}  // namespace peclet::runner
