// Decides stop tests and gives their intervals.
//
// The interval of a stop test is that of half_width() (statistics.h) at the level of adjusted_confidence():
// Student's, or Clopper and Pearson's for shares. It depends on the values, the confidence, the minimum and
// the maximum, but not on the tolerance. With a single stop test the level is the confidence itself.
//
// A stop test converges if its half-width is within the tolerance e. A relative tolerance allows e |mean|.
// One that is relative to another observable allows e (|mean| - half-width) of that one, so that its error
// counts, too. Equal values have no spread to judge by: their stop test never converges. If another
// observable is relative to them, they count as exact.
//
// A point stops when its spread happens to be small. This does no harm as long as all points stop some time,
// because those that stop too early and too late balance. A near maximum cuts off the late ones. The
// converged points are then a selection whose intervals hold the mean less often (results/coverage).
// is_near_maximum() marks them.
//
// Without a tolerance there is one stop test, at the fixed number of realisations, and Student's interval.
//
// A target of several criteria is met at the first stop test at which each criterion is met. The verdict of
// the point is the least favourable one of its criteria.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/statistics.h"

namespace peclet::runner {

enum class Verdict {
  more,                   // undecided: continue to the next stop test
  converged,              // within the tolerance
  converged_with_losses,  // within the tolerance, but seeds of the cohort were lost
  capped,                 // the maximum is reached without convergence
  failed,                 // fewer than two values at the maximum, or every seed of the first cohort lost
  // For a fixed number of realisations; `failed` if none of them has a value.
  complete,
  complete_with_losses
};

// Returns a name such as "converged-with-losses".
const char* to_string(Verdict verdict);
// Returns nothing for a word that is not a verdict.
std::optional<Verdict> verdict_of(std::string_view word);

// Returns true if the verdict is converged or complete, with losses or without.
bool is_reached(Verdict verdict);
// Returns true if the verdict is converged or complete, but seeds were lost.
bool has_losses(Verdict verdict);

// Returns the verdict of a stop test on two criteria together: the less favourable one.
Verdict less_favourable(Verdict one, Verdict other);

// Returns the level of each interval at which the interval of the last stop test holds the mean with
// `confidence`. Of several stop tests, the first within the tolerance often has a spread that is too small by
// chance. With levels of 95 %, 93 to 95 % of the last intervals hold the mean from a minimum of 8 on, and
// fewer below. With
//   1 - (1 - confidence) (1 - 1.4 / minimum)
// 94.2 to 95.9 % do, for normal populations of any spread (results/coverage). With a single stop test
// (minimum = maximum) the level is the confidence, because Student's interval is exact.
double adjusted_confidence(double confidence, int minimum, int maximum);

// Returns the numbers of seeds of the stop tests: minimum, then ceil(1.25 n) of the one before, last maximum.
std::vector<int> stop_test_schedule(int minimum, int maximum);

class StopRule {
 public:
  StopRule(const Target& target, int minimum, int maximum);

  // The estimates of Target::observables(), in that order, over a closed cohort of `seeds`. The estimate of
  // an observable counts the seeds that have a value of it.
  using Estimates = std::span<const Estimate>;

  // The result for one observable.
  struct Finding {
    std::optional<Verdict> verdict;  // none if tolerances are only relative to this observable
    double half_width = 0;           // NaN if there is no interval
    // Half-width over the largest allowed one; NaN without a tolerance.
    double share = std::numeric_limits<double>::quiet_NaN();
  };
  struct Judgement {
    Verdict verdict = Verdict::more;
    std::vector<Finding> findings;  // of each observable
  };
  Judgement judge(int seeds, Estimates estimates);
  bool has_tolerance() const { return has_tolerance_; }
  // Returns the level of each interval: adjusted_confidence().
  double confidence() const { return confidence_; }
  // Returns true if each criterion is within its tolerance.
  bool is_met(Estimates estimates);

  // Returns the half-width at the adjusted level; NaN if there is no interval.
  double half_width(const Estimate& estimate);
  // Returns true if each criterion allows a half-width above 0: not a share of a mean that is 0 or unknown.
  bool has_measure(Estimates estimates) const;

  const std::vector<int>& schedule() const { return schedule_; }

 private:
  // One criterion, with the indices of its observable and of the one to which it is relative.
  struct Part {
    Tolerance tolerance;
    std::size_t place = 0, measure = 0;
  };
  // Returns half-width over the largest allowed one: converged at 1 or less. Infinite or NaN if the allowed
  // one is 0 or unknown.
  double share(const Part& part, Estimates estimates);
  Verdict verdict(int seeds, const Estimate& estimate, double share) const;

  std::vector<Part> parts_;
  std::size_t observables_;
  int minimum_, maximum_;
  bool has_tolerance_;
  double confidence_;
  std::vector<int> schedule_;
  std::map<int, double> student_;  // Student's factors by number of values
};

// Returns true if a converged stop test may be luck, because the maximum is near. With the largest spread
// that its values leave open, f = variance_excess() at 5 %, the point would need more seeds than the maximum:
//   n share^2 f > maximum.
// `share` is half-width over tolerance of a criterion with `values` values.
bool is_near_maximum(int seeds, int values, double share, int maximum);

}  // namespace peclet::runner
