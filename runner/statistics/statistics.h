// What a finite number of realisations says about a mean, and how sure it is.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace peclet::runner {

// Sample mean and its standard error s / sqrt(n), s the sample standard deviation with n - 1.
struct Estimate {
  int count = 0;
  double mean = 0;
  double standard_error = 0;  // NaN for fewer than two values
  // What the values are, which decides what interval they have: see half_width().
  enum class Values {
    spread,   // different numbers
    share,    // each is 0 or 1
    equal,    // one and the same number, but for rounding
    repeated  // of seeds that are not independent: see repeated_seeds()
  };
  Values values = Values::spread;
};

// `is_share`: each value is 0 or 1 by its nature. Without it, values are a share if both have been seen and
// nothing else.
Estimate estimate(std::span<const double> values, bool is_share = false);

// The same of values that come one by one (Welford's update); NaN for a mean without any.
class RunningEstimate {
 public:
  // Of a share are all values or none.
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

// Third central moment over the 3/2 power of the second, both with n; NaN for fewer than three values or
// equal ones.
double skewness(std::span<const double> values);

// Quantile of Student's t for a two-sided interval: t(degrees, (1 + confidence) / 2).
double student_quantile(int degrees, double confidence);

// By what the variance of a normal population may exceed that of a sample, but for this probability:
// f / chi^2_p(f), f the sample's degrees of freedom and chi^2_p the quantile of p.
double variance_excess(double degrees, double probability);

// Half-width t(n - 1, (1 + confidence) / 2) * standard error of Student's interval; NaN for fewer than two
// values.
double student_half_width(const Estimate& estimate, double confidence);

struct Interval {
  double low = 0, high = 0;
};

// Clopper and Pearson's interval of a share, of k = count * mean values that are 1 (Biometrika 26 (1934)
// 404): the shares p for which k or more, and k or fewer, of `count` have a probability of (1 - confidence) /
// 2 or more. It holds the true share at least as often as it says. Requires count > 0.
Interval share_interval(int count, double mean, double confidence);

// What lies below the true share with this probability, after k = count * mean of `count` values are 1 and by
// Jeffreys' prior: the quantile of Beta(k + 1/2, count - k + 1/2).
double share_quantile(int count, double mean, double probability);

// Half-width of the interval at this confidence: Student's of values with a spread; the larger side of
// share_interval() of a share. NaN for fewer than two values, and for equal or repeated ones, which have no
// spread to judge by.
double half_width(const Estimate& estimate, double confidence);

// Bootstrap-t: an interval that follows the skewness of the values.
//
// The two-sided interval m - t*(1 - a/2) s .. m - t*(a/2) s, a = 1 - confidence, of the mean m with standard
// error s, t* being quantiles of (m* - m) / s* over 4000 resamples of the values with replacement (B. Efron
// and R. Tibshirani, An Introduction to the Bootstrap, 1993, 12.5). Resamples without spread are drawn again.
// The random numbers are always the same, so the same values give the same interval. Nothing for fewer than
// five values, values without spread, and where next to no resample has a finite one.
std::optional<Interval> bootstrap_t(std::span<const double> values, double confidence);

}  // namespace peclet::runner
