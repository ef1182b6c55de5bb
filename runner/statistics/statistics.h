// Estimates means, standard errors and confidence intervals from a finite number of values.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace peclet::runner {

// The sample mean and its standard error s / sqrt(n), with the sample standard deviation s (divisor n - 1).
struct Estimate {
  int count = 0;
  double mean = 0;
  double standard_error = 0;  // NaN for fewer than two values
  // The kind of values, which decides the kind of interval: see half_width().
  enum class Values {
    spread,   // different numbers
    share,    // each is 0 or 1
    equal,    // all equal within rounding
    repeated  // from seeds that are not independent: see repeated_seeds()
  };
  Values values = Values::spread;
};

// Returns the estimate of the values. `is_share`: each value is 0 or 1 by definition. Without it, values are
// a share if both 0 and 1 occur and no other number.
Estimate estimate(std::span<const double> values, bool is_share = false);

// The estimate of values that come one by one (Welford's update); NaN without values.
class RunningEstimate {
 public:
  // Adds a value. The values are a share only if each is added as one.
  void add(double value, bool is_share = false);
  Estimate estimate() const;

 private:
  bool is_share_ = true;
  int count_ = 0;
  double mean_ = 0, squares_ = 0;  // squares: the sum of the squared deviations from the mean
  double low_ = 0, high_ = 0;
  bool are_binary_ = true;
};

std::vector<Estimate> estimates_of(std::span<const RunningEstimate> running);

// Returns the third central moment over the 3/2 power of the second, both with divisor n; NaN for fewer than
// three values or equal ones.
double skewness(std::span<const double> values);

// Returns Student's quantile for a two-sided interval: t(degrees, (1 + confidence) / 2).
double student_quantile(int degrees, double confidence);

// Returns the ratio of population to sample variance that is exceeded with probability p, for normal values:
//   f / chi^2_p(f),
// with the sample's degrees of freedom f and the quantile chi^2_p of p.
double variance_excess(double degrees, double probability);

// Returns the half-width t(n - 1, (1 + confidence) / 2) * standard error of Student's interval; NaN for fewer
// than two values.
double student_half_width(const Estimate& estimate, double confidence);

struct Interval {
  double low = 0, high = 0;
};

// Returns Clopper and Pearson's interval of a share (Biometrika 26 (1934) 404), of which k = count * mean
// values are 1. It has the shares p for which k or more, and k or fewer, of `count` values have a probability
// of (1 - confidence) / 2 or more. It holds the true share at least as often as it says. Requires count > 0.
Interval share_interval(int count, double mean, double confidence);

// Returns the quantile of the true share, if k = count * mean of `count` values are 1, with Jeffreys' prior:
// that of Beta(k + 1/2, count - k + 1/2).
double share_quantile(int count, double mean, double probability);

// Returns the half-width of the interval at this confidence: Student's for values with a spread, the larger
// side of share_interval() for a share. NaN for fewer than two values, and for equal or repeated ones.
double half_width(const Estimate& estimate, double confidence);

// Returns the bootstrap-t interval of the mean m, which follows the skewness of the values:
//   m - t*(1 - a/2) s .. m - t*(a/2) s,    a = 1 - confidence,
// with the standard error s and the quantiles t* of (m* - m) / s* over 4000 resamples of the values with
// replacement (B. Efron and R. Tibshirani, An Introduction to the Bootstrap, 1993, 12.5). Resamples without
// spread are drawn again. The random numbers are fixed: the same values give the same interval. Returns
// nothing for fewer than five values, for values without spread, and if too few resamples are finite.
std::optional<Interval> bootstrap_t(std::span<const double> values, double confidence);

}  // namespace peclet::runner
