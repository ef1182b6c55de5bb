// When a look decides, and which interval it gives.
//
// Let n be the seeds of the look, w = half-width / |mean| of Student's interval at the level of
// adjusted_confidence(), and e the tolerance. A look is within the tolerance when w <= e. Points stop where
// their spread has come out small, which harms nothing as long as all points stop some time: those that stop
// too early and those that stop too late make up for each other. The maximum cuts the late ones off, and
// then what has converged is a selection (results/coverage). So a look converges only if the point would
// have done so within the maximum with a larger spread, too:
//   needed = n (w (1 + w) / e)^2 f  <=  maximum,
// f being by what the true variance may exceed the sample's, (v - 1) / chi^2_p(v - 1) for v >= 8 values, p =
// 0.02 before the last look, where it costs only seeds that are allowed, and 0.05 at the last one. 1 + w is
// for the mean, which may come out too large. Where `needed` is more than a third of the maximum, the
// interval that is given is no narrower than the tolerance. At the last look, what is within the tolerance
// but no more than that is near the maximum, also if it is the mean that came out too small (w <= e (1 + w)):
// its interval is wider than the tolerance by the same f,
//   max(e, w (1 + w) sqrt(f)) |mean|,   p = 0.02.
// An absolute tolerance takes the same rule with w and e in the observable's unit, and 1 in the place of
// |mean| and of 1 + w. One relative to another observable takes |mean| and 1 + w of that one. Where a floor
// counts, the tolerance is an absolute one.
//
// A target of several criteria is met at the first look at which each of them is by its own rule. What is
// said of the point is the least favourable of what is said of them.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/statistics.h"

namespace peclet::runner {

enum class Verdict {
  more,                    // nothing is decided: go on to the next look
  converged,               // within the tolerance
  converged_with_losses,   // within the tolerance, but seeds of the cohort were lost
  converged_near_maximum,  // perhaps within it by luck: the maximum is too near to tell
  capped,                  // the maximum is reached without convergence
  failed                   // fewer than two values at the maximum or every seed of the first cohort lost
};

// "converged-with-losses"
const char* to_string(Verdict verdict);
// Nothing for a word that is no verdict.
std::optional<Verdict> verdict_of(std::string_view word);

// With losses or without.
bool is_converged(Verdict verdict);

// Of two verdicts that the same look gave of two criteria, the one that counts for both.
Verdict less_favourable(Verdict one, Verdict other);

// The level that each interval must have so that the one at which a point stops holds the mean with
// `confidence`. Among several looks the first one within the tolerance is often one whose spread came out too
// small: with levels of 95 %, 93 to 95 % of the last intervals hold the mean from a minimum of 8 on, fewer
// with smaller ones. 1 - (1 - confidence) (1 - 1.4 / minimum) makes that 94.2 to 95.9 %, for normal
// populations of any spread (results/coverage). With a single look (minimum = maximum) Student's interval is
// exact.
double adjusted_confidence(double confidence, int minimum, int maximum);

// Numbers of seeds at which a point is looked at: minimum, then ceil(1.25 n) each, the last one is maximum.
std::vector<int> look_schedule(int minimum, int maximum);

class StopRule {
 public:
  StopRule(const Target& target, int minimum, int maximum);

  // Below, estimates are those of Target::observables(), in that order, of a closed cohort of `seeds`: of
  // each observable those seeds count that have a value of it.
  using Estimates = std::span<const Estimate>;

  // What is said of one observable.
  struct Finding {
    std::optional<Verdict> verdict;  // none where it only measures others
    double half_width = 0;           // NaN for fewer than two values
    double share = 0;                // of the half-width that is good enough; NaN without a tolerance
  };
  struct Judgement {
    Verdict verdict = Verdict::more;
    std::vector<Finding> findings;  // of each observable
  };
  Judgement judge(int seeds, Estimates estimates);
  // Whether the verdict would not be `more`.
  bool stops(int seeds, Estimates estimates);

  // Student's half-width at the adjusted level; NaN for fewer than two values.
  double half_width(const Estimate& estimate);
  // Whether for each criterion some half-width is good enough: not so a share of 0, and of what is unknown.
  bool has_measure(Estimates estimates) const;

  const std::vector<int>& schedule() const { return schedule_; }

 private:
  enum class Strictness { before_last, last };
  struct Measured;
  // One criterion, and where its observable and the one that it is relative to stand among the estimates.
  struct Part {
    Tolerance tolerance;
    std::size_t place = 0, measure = 0;
  };
  Measured measure(const Part& part, Estimates estimates);
  // Upper limit of the seeds that the tolerance takes.
  double needed(int seeds, const Measured& measured, Strictness strictness);
  bool converges(int seeds, const Measured& measured);
  // All but the share.
  Finding judge(int seeds, const Measured& measured);
  double widened(const Measured& measured) const;

  int rule_;
  std::vector<Part> parts_;
  std::size_t observables_;
  int minimum_, maximum_;
  double confidence_;
  std::vector<int> schedule_;
  std::map<int, double> student_;                            // by number of values, each computed once
  std::map<std::pair<int, Strictness>, double> may_exceed_;  // f of the same
};

}  // namespace peclet::runner
