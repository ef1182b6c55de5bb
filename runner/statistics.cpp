#include "runner/statistics.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace peclet::runner {

Estimate estimate(std::span<const double> values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Estimate result{static_cast<int>(values.size()), none, none};
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());

  double sum = 0;
  for (const double value : values) sum += value;
  const double first_mean = sum / count;
  // The deviations' own sum takes back what rounding did to the first mean, so equal values have exactly
  // their mean and no spread.
  double correction = 0;
  for (const double value : values) correction += value - first_mean;
  result.mean = first_mean + correction / count;
  if (values.size() < 2) return result;

  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.standard_error = std::sqrt(squares / (count - 1) / count);
  return result;
}

double skewness(std::span<const double> values) {
  const double mean = estimate(values).mean;
  double squares = 0, cubes = 0;
  for (const double value : values) {
    squares += (value - mean) * (value - mean);
    cubes += (value - mean) * (value - mean) * (value - mean);
  }
  if (values.size() < 3 || squares == 0) return std::numeric_limits<double>::quiet_NaN();
  return cubes * std::sqrt(static_cast<double>(values.size())) / (squares * std::sqrt(squares));
}

double student_quantile(int degrees, double confidence) {
  const boost::math::students_t distribution(degrees);
  return boost::math::quantile(boost::math::complement(distribution, (1 - confidence) / 2));
}

double student_half_width(const Estimate& estimate, double confidence) {
  if (estimate.count < 2) return std::numeric_limits<double>::quiet_NaN();
  return student_quantile(estimate.count - 1, confidence) * estimate.standard_error;
}

}  // namespace peclet::runner
