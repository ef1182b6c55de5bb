// The stop rule: closed cohorts in seed order, looked at after fixed numbers of seeds.
//
// A cohort of n is the seeds 0 .. n-1, each in a terminal state. Because the stop tests are at fixed n and a
// stop test only happens when its cohort is closed, the decision depends on no timing: one worker or
// sixty-four, killed and resumed or not, give the same stop tests, the same deciding stop test and the same
// mean.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/quantities.h"
#include "runner/statistics/stop_rule.h"

namespace peclet::runner {

class NumberLayout;

// How a seed ended; a seed that is queued or runs has no outcome yet. The observation is of the target's
// leading observable: a seed without its value is lost (the engine's verdict, or quarantined after crashes).
struct Outcome : Observation {
  std::vector<Observation> further{};  // of the other ones of Target::observables(), in that order
  std::uint64_t final_state = 0;       // first digits of its hash; 0 where it is not known

  bool is_lost() const { return !has_value(); }
  // The observation at that place of Target::observables(); without a value of a seed that is lost.
  Observation of(std::size_t place) const;
};

// Returns the outcome of a realisation with these numbers, which ended in the state of that hash ("": not
// known).
Outcome outcome_of(const NumberLayout& layout, std::span<const double> numbers,
                   const std::string& final_state_sha256);
// Counts value + control of an observation in the estimate, if it has a value.
void add(RunningEstimate& known, const Observation& observation);

// Returns the estimates of that number of observables over the seeds that have ended, in any order.
std::vector<Estimate> estimates_so_far(std::span<const std::optional<Outcome>> outcomes,
                                       std::size_t observables);

// What a stop test says of one of several observables.
struct ObservableStopTest {
  std::string observable;
  Estimate estimate;      // of value + control
  double half_width = 0;  // the rule's
  double share = 0;       // half-width over the largest that is allowed; NaN without a tolerance
  double skewness = std::numeric_limits<double>::quiet_NaN();
  bool transient = false, untested = false;  // as of a stop test
  std::optional<Verdict> verdict;            // none where it only measures others
};

// One stop test at a closed cohort. The controlled estimate decides: of value + control, the control variate
// with the coefficient -1 that was fixed before any value was seen, so that it is as unbiased as the plain
// one and its interval as honest. Without a control variate both are the same.
struct StopTest {
  int seeds = 0;  // n
  int lost = 0;
  Estimate estimate;                 // of the observable
  double half_width = 0;             // by the same rule as that of `controlled`
  Estimate controlled;               // of value + control
  double controlled_half_width = 0;  // the rule's: see stop_rule.h; NaN where there is no interval
  double skewness = std::numeric_limits<double>::quiet_NaN();  // of value + control
  bool transient = false;  // the beginning of the window differs from its end: see window_advice.h
  bool untested = false;   // for transients: lacks_blocks(), see window_advice.h; made again, never stored
  Verdict verdict = Verdict::more;
  // Made again, never stored: the convergence may be luck (is_near_maximum()), and seeds that are no
  // independent ones (repeated_seeds()).
  bool near_maximum = false;
  std::vector<int> repeated{};
  // Of a target of several observables, each of them, the leading one first; empty otherwise. Transient,
  // untested and verdict above are then of all of them.
  std::vector<ObservableStopTest> each{};
};

// StopTest::each, also of a target of one observable.
std::vector<ObservableStopTest> each_of(const StopTest& stop_test, const Target& target);

// The largest half-width over the one that is allowed, of all criteria: met at 1. NaN for what is not known.
double largest_share(const StopTest& stop_test, const Target& target);

// The estimates that decide, of Target::observables() in that order.
std::vector<Estimate> estimates_of(const StopTest& stop_test, const Target& target);

// Whether the values are so skewed that Student's interval holds the mean visibly less often than it says:
// the skewness is beyond what a normal population of this size shows, and the loss of coverage that belongs
// to it,
//   2 phi(z) z (z^4 + 2 z^2 - 3) g^2 / (18 n)    (P. Hall, The Bootstrap and Edgeworth Expansion, 1992, 2.6),
// is more than 0.01. Not so of a share, which has an interval of its own. z is the two-sided normal quantile
// of the confidence, g the skewness, n the count.
bool is_skewed(const StopTest& stop_test, double confidence);

// Whether the stop test has converged, and one of its criteria perhaps by luck: see stop_rule.h.
bool is_near_maximum(const StopTest& stop_test, const Target& target, int maximum);

// The observables of the stop test that have values and no interval, because all are equal or seeds are
// repeated.
std::vector<std::string> without_interval(const StopTest& stop_test, const Target& target);

// Seeds that ended in the same final state as one before them: their values are one value. Student's interval
// of such seeds is too narrow, so that a stop test at them has none.
std::vector<int> repeated_seeds(std::span<const std::optional<Outcome>> cohort);

// Half-width over |mean| of the estimate that decides; NaN where there is no interval.
double relative_width(const StopTest& stop_test);

// Whether the results have a control variate, as those of other engines may: without one
// the controlled estimate only repeats the other.
bool has_control(const StopTest& stop_test);

// All stop tests that the outcomes allow, in order, ending with the first that decides (any verdict but
// more). outcomes[s] is that of seed s. A pure function: replaying it is how a stored stop test is checked.
std::vector<StopTest> replay_stop_tests(const std::vector<std::optional<Outcome>>& outcomes,
                                        const Target& target, int minimum, int maximum);

// Estimates and looks as JSON, the same wherever they are printed.
//
// Null for a number that does not exist.
Json number_json(double value);

Json estimate_json(const Estimate& estimate);

// The estimate that decides with its half-width, and the one without the control variate; numbers that do not
// exist are null.
Json stop_test_json(const StopTest& stop_test);

// What values an estimate with this half-width is of. Shares m of n have the standard error
// sqrt(m (1 - m) / (n - 1)) and a whole number n m of ones, other values next to never. Repeated ones look
// like equal ones.
Estimate::Values stored_values(const Estimate& estimate, double half_width);

// StopTest::each, and the same read back. Throws a std::exception for what is none.
Json observables_json(const StopTest& stop_test);
std::vector<ObservableStopTest> observables_of(const Json& json);

}  // namespace peclet::runner
