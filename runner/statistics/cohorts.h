// Replays the stop tests of a point, each over the closed cohort of a fixed number of seeds.
//
// The cohort of n seeds is the seeds 0 .. n-1. It is closed when each of them has ended. The numbers n are
// fixed in advance, and a stop test needs a closed cohort. The decision therefore depends on no timing: any
// number of workers, interrupted or not, gives the same stop tests and the same mean.
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

// The observations of a seed that has ended. The base is that of the target's leading observable; a seed
// without its value is lost (it failed, or was quarantined after crashes).
struct Outcome : Observation {
  std::vector<Observation> further{};  // of Target::observables() from the second on, in that order
  std::uint64_t final_state = 0;       // first 16 digits of its SHA-256; 0 if unknown
  double steps = 0;                    // of the realisation; 0 if unknown

  bool is_lost() const { return !has_value(); }
  // Returns the observation of Target::observables()[place]; it has no value if the seed is lost.
  Observation of(std::size_t place) const;
};

// Returns the outcome of a realisation with these stored numbers; the hash is "" if unknown.
Outcome outcome_of(const NumberLayout& layout, std::span<const double> numbers,
                   const std::string& final_state_sha256);
// Adds value + control of an observation to the estimate, if it has a value.
void add(RunningEstimate& known, const Observation& observation);

// Returns the estimates of value + control for each of `observables` observables, over all ended seeds.
std::vector<Estimate> estimates_so_far(std::span<const std::optional<Outcome>> outcomes,
                                       std::size_t observables);

// The curve through the points of a campaign at one of them (curve_fit.h); NaN as long as too few points of
// the curve are known, or for a mean without a logarithm.
struct CurveBand {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double mean = unknown, low = unknown, high = unknown;  // of the observable
  double share = unknown;  // larger side of the band over the largest allowed one
  // Distance of the point's own mean from the curve through the others, in standard deviations, and the
  // largest allowed one.
  double residual = unknown, allowed = unknown;
  bool refused = false;  // a point contradicts the curve, which decides nothing
  bool goes_on = false;  // the point makes its next stop test in the next round: see curve_stop_tests.h

  bool is_known() const { return !std::isnan(mean); }
  // True if this point contradicts the curve.
  bool contradicts() const { return is_known() && !(std::abs(residual) <= allowed); }
  bool is_met() const { return !refused && share <= 1; }
};

// The result of a stop test for one observable.
struct ObservableStopTest {
  std::string observable;
  Estimate estimate;      // of value + control
  double half_width = 0;  // by the stop rule
  double share = 0;       // half-width over the largest allowed one; NaN without a tolerance
  double skewness = std::numeric_limits<double>::quiet_NaN();
  bool transient = false, untested = false;  // as in StopTest
  std::optional<Verdict> verdict;            // none if tolerances are only relative to this observable
  std::optional<CurveBand> curve{};          // if the criterion has one

  // Half-width over the largest allowed one: of the band if it counts and is narrower than the point's own
  // interval.
  double smaller_share() const {
    return curve && curve->is_known() && !curve->refused && !(share <= curve->share) ? curve->share : share;
  }
  // True if the point has converged although its own interval is too wide.
  bool is_decided_by_curve() const { return curve && verdict && is_reached(*verdict) && !(share <= 1); }
};

// One stop test at a closed cohort. The controlled estimate, of value + control, decides. The coefficient of
// the control variate is fixed before any value is seen, so this estimate is as unbiased as the plain one.
// Without a control variate both are equal.
struct StopTest {
  int seeds = 0;  // n
  int lost = 0;
  Estimate estimate;                 // without control variate
  double half_width = 0;             // of `estimate`, by the stop rule
  Estimate controlled;               // of value + control
  double controlled_half_width = 0;  // of `controlled`, by the stop rule; NaN if there is no interval
  double skewness = std::numeric_limits<double>::quiet_NaN();  // of value + control
  bool transient = false;  // the beginning of the window differs from the whole: see has_transient()
  bool untested = false;   // no test of transients was possible: see lacks_blocks(); computed, never stored
  Verdict verdict = Verdict::more;
  // Computed from the outcomes, never stored: whether the convergence may be luck (is_near_maximum()), and
  // the seeds that repeat earlier ones (repeated_seeds()).
  bool near_maximum = false;
  std::vector<int> repeated{};
  // Each observable of a target of several or with a curve, the leading one first; empty for a single
  // observable. `transient`, `untested` and `verdict` above are then those of all observables together.
  std::vector<ObservableStopTest> each{};
};

// True if the point has converged although some interval of its own is too wide: curves decide.
bool is_decided_by_curve(const StopTest& stop_test);

// True if the point is open, and makes no stop test before other points of its curve have made theirs.
bool waits_for_curve(const StopTest& stop_test);

// Returns StopTest::each, or one element for a target of one observable.
std::vector<ObservableStopTest> each_of(const StopTest& stop_test, const Target& target);

// Returns the largest half-width over the allowed one of all criteria: met at 1 or less, NaN if unknown. For
// a curve it is that of the band, if that is less.
double largest_share(const StopTest& stop_test, const Target& target);

// Returns the controlled estimates of Target::observables(), in that order.
std::vector<Estimate> estimates_of(const StopTest& stop_test, const Target& target);

// Returns true if the values are so skewed that Student's interval holds the mean less often than it says.
// Their skewness g is then beyond 2.5 standard deviations of that of normal samples, and the loss of coverage
//   2 phi(z) z (z^4 + 2 z^2 - 3) g^2 / (18 n)    (P. Hall, The Bootstrap and Edgeworth Expansion, 1992, 2.6)
// is more than 0.01, with the normal density phi, the two-sided normal quantile z of the confidence, and the
// count n. Returns false for a share, which has an interval of its own.
bool is_skewed(const StopTest& stop_test, double confidence);

// Returns true if the stop test has converged, and one of its criteria perhaps by luck: see stop_rule.h.
bool is_near_maximum(const StopTest& stop_test, const Target& target, int maximum);

// Returns the observables with a criterion that have values but no interval, because all values are equal or
// seeds are repeated.
std::vector<std::string> without_interval(const StopTest& stop_test, const Target& target);

// Returns the seeds that ended in the same final state as an earlier one. Their values are not independent,
// so a stop test with such seeds has no interval.
std::vector<int> repeated_seeds(std::span<const std::optional<Outcome>> cohort);

// Returns half-width over |mean| of the controlled estimate; NaN if there is no interval.
double relative_width(const StopTest& stop_test);

// Returns true if a control variate has changed the mean; not all engines have one.
bool has_control(const StopTest& stop_test);

// Returns the stop test over the first `seeds` seeds; nothing if one of them has not ended. The rule must be
// that of the target. It judges the point's own intervals: curves are judged by CurveStopTests.
std::optional<StopTest> stop_test_over(int seeds, const std::vector<std::optional<Outcome>>& outcomes,
                                       const Target& target, StopRule& rule);

// Returns all stop tests that the outcomes allow, in order, up to the first that decides (any verdict but
// `more`). outcomes[s] belongs to seed s. A pure function, by which stored stop tests are checked. The target
// must have no curve.
std::vector<StopTest> replay_stop_tests(const std::vector<std::optional<Outcome>>& outcomes,
                                        const Target& target, int minimum, int maximum);

// Estimates and stop tests as JSON, in one form for all verbs.
//
// Returns null for a number that is not finite.
Json number_json(double value);

Json estimate_json(const Estimate& estimate);

// Returns the controlled estimate with its half-width, and under "plain" the one without control variate.
Json stop_test_json(const StopTest& stop_test);

// Returns the kind of values of a stored estimate with this half-width. A share with the mean m of n values
// has the standard error
//   sqrt(m (1 - m) / (n - 1))
// and a whole number n m of ones; other values hardly ever have both. Repeated values count as equal ones.
Estimate::Values stored_values(const Estimate& estimate, double half_width);

Json curve_json(const CurveBand& curve);

// Converts StopTest::each to JSON and back. Throws a std::exception for JSON of another form.
Json observables_json(const StopTest& stop_test);
std::vector<ObservableStopTest> observables_of(const Json& json);

}  // namespace peclet::runner
