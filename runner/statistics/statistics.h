// What a finite number of realisations says about a mean, and how sure it is.
#pragma once

#include <span>

namespace peclet::runner {

// Sample mean and its standard error s / sqrt(n), s the sample standard deviation with n - 1.
struct Estimate {
  int count = 0;
  double mean = 0;
  double standard_error = 0;  // NaN for fewer than two values
};

Estimate estimate(std::span<const double> values);

// The same of values that come one by one (Welford's update); NaN for a mean without any.
class RunningEstimate {
 public:
  void add(double value);
  Estimate estimate() const;

 private:
  int count_ = 0;
  double mean_ = 0, squares_ = 0;  // squares: the sum of the squared deviations from the mean
};

// Third central moment over the 3/2 power of the second, both with n; NaN for fewer than three values or
// equal ones.
double skewness(std::span<const double> values);

// Quantile of Student's t for a two-sided interval: t(degrees, (1 + confidence) / 2).
double student_quantile(int degrees, double confidence);

// By what the variance of a normal population may exceed that of a sample, but for this probability:
// f / chi^2_p(f), f the sample's degrees of freedom and chi^2_p the quantile of p.
double variance_excess(int degrees, double probability);

// Half-width t(n - 1, (1 + confidence) / 2) * standard error of Student's interval; NaN for fewer than two
// values.
double student_half_width(const Estimate& estimate, double confidence);

}  // namespace peclet::runner
