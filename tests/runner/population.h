// Populations of mean 1 that the studies of the stop rule draw from.
#pragma once

#include <cmath>
#include <random>

namespace peclet::runner {

// Returns the standard deviation s of values x_1 ... x_n whose 95 % interval has the half-width `tolerance`:
//   tolerance = z s / sqrt(n), z = 1.959964
inline double spread_that_needs(double values, double tolerance) {
  return tolerance * std::sqrt(values) / 1.959964;
}

// Returns the number of values n of deviation `spread` that a 95 % interval of this half-width needs.
inline double values_that_need(double spread, double tolerance) {
  return std::pow(1.959964 * spread / tolerance, 2);
}

// Gamma distribution of mean 1 and this deviation, like a mean of squares; its skewness is 2 `spread`.
inline std::gamma_distribution<double> gamma_of(double spread) {
  return std::gamma_distribution<double>(1 / (spread * spread), spread * spread);
}

// Returns a lognormal value of mean 1 and this deviation from a standard normal z.
inline double lognormal_of(double z, double spread) {
  const double logarithmic = std::sqrt(std::log1p(spread * spread));
  return std::exp(logarithmic * z - logarithmic * logarithmic / 2);
}

}  // namespace peclet::runner
