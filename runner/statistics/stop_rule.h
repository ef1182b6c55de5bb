// When a stop test decides, and which interval it gives.
//
// The interval of a stop test is that of half_width() (statistics.h) at the level of adjusted_confidence():
// Student's, of shares Clopper and Pearson's. It depends on the values of the stop test, the confidence that
// is asked for, and minimum and maximum; the tolerance has no part in it. With a single stop test the level
// is the confidence itself.
//
// A stop test converges when its half-width is within the tolerance e. A relative one allows e |mean|; one
// that is relative to another observable allows e (|mean| - half-width) of that one, so that the error of the
// measure counts, too. Equal values have no spread to judge by: such a stop test never converges. As a
// measure they are taken for exact.
//
// A point stops where its spread has come out small. That harms nothing as long as all points stop some time:
// those that stop too early and those that stop too late make up for each other. The maximum cuts the late
// ones off, and then what has converged is a selection whose intervals hold the mean less often
// (results/coverage). is_near_maximum() tells of such a point.
//
// Without a tolerance there is one stop test, at the fixed number of realisations, and Student's interval.
//
// A target of several criteria is met at the first stop test at which each of them is by its own rule. What
// is said of the point is the least favourable of what is said of them.
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
  more,                   // nothing is decided: go on to the next stop test
  converged,              // within the tolerance
  converged_with_losses,  // within the tolerance, but seeds of the cohort were lost
  capped,                 // the maximum is reached without convergence
  failed,                 // fewer than two values at the maximum or every seed of the first cohort lost
  // Of a fixed number of realisations; `failed` where none of them has a value.
  complete,
  complete_with_losses
};

// "converged-with-losses"
const char* to_string(Verdict verdict);
// Returns nothing for a word that is no verdict.
std::optional<Verdict> verdict_of(std::string_view word);

// Within the tolerance, or complete; with losses or without.
bool is_reached(Verdict verdict);
// Converged or complete, but seeds were lost.
bool has_losses(Verdict verdict);

// Of two verdicts that the same stop test gave of two criteria, the one that counts for both.
Verdict less_favourable(Verdict one, Verdict other);

// The level that each interval must have so that the one at which a point stops holds the mean with
// `confidence`. Among several stop tests the first one within the tolerance is often one whose spread came
// out too small: with levels of 95 %, 93 to 95 % of the last intervals hold the mean from a minimum of 8 on,
// fewer with smaller ones. 1 - (1 - confidence) (1 - 1.4 / minimum) makes that 94.2 to 95.9 %, for normal
// populations of any spread (results/coverage). With a single stop test (minimum = maximum) Student's
// interval is exact.
double adjusted_confidence(double confidence, int minimum, int maximum);

// Numbers of seeds at which a point is looked at: minimum, then ceil(1.25 n) each, the last one is maximum.
std::vector<int> stop_test_schedule(int minimum, int maximum);

class StopRule {
 public:
  StopRule(const Target& target, int minimum, int maximum);

  // Below, estimates are those of Target::observables(), in that order, of a closed cohort of `seeds`: of
  // each observable those seeds count that have a value of it.
  using Estimates = std::span<const Estimate>;

  // What is said of one observable.
  struct Finding {
    std::optional<Verdict> verdict;  // none where it only measures others
    double half_width = 0;           // NaN where there is no interval
    // Half-width over the largest that is allowed; NaN without a tolerance.
    double share = std::numeric_limits<double>::quiet_NaN();
  };
  struct Judgement {
    Verdict verdict = Verdict::more;
    std::vector<Finding> findings;  // of each observable
  };
  Judgement judge(int seeds, Estimates estimates);
  bool has_tolerance() const { return has_tolerance_; }
  // Whether each criterion is within its tolerance.
  bool is_met(Estimates estimates);

  // At the adjusted level; NaN where there is no interval.
  double half_width(const Estimate& estimate);
  // Whether for each criterion some half-width is good enough: not so a share of 0, and of what is unknown.
  bool has_measure(Estimates estimates) const;

  const std::vector<int>& schedule() const { return schedule_; }

 private:
  // One criterion, and where its observable and the one that it is relative to stand among the estimates.
  struct Part {
    Tolerance tolerance;
    std::size_t place = 0, measure = 0;
  };
  // Half-width over the one that is allowed: converged at 1. Infinite or NaN where there is no measure.
  double share(const Part& part, Estimates estimates);
  Verdict verdict(int seeds, const Estimate& estimate, double share) const;

  std::vector<Part> parts_;
  std::size_t observables_;
  int minimum_, maximum_;
  bool has_tolerance_;
  double confidence_;
  std::vector<int> schedule_;
  std::map<int, double> student_;  // by number of values, each computed once
};

// Whether the maximum is so near that a stop test which has converged may have done so by luck: with the
// largest spread that its values leave open (variance_excess() at 5 %) the point would need more seeds than
// are allowed, n share^2 f > maximum. `share` is the largest of its criteria, of `values` values.
bool is_near_maximum(int seeds, int values, double share, int maximum);

}  // namespace peclet::runner
