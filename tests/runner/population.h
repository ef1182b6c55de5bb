// Populations of mean 1 that the studies of the stop rule draw from.
#pragma once

#include <cmath>
#include <random>

namespace peclet::runner {

// The deviation of which a 95 % interval of so many values is as wide as the tolerance: z = 1.959964.
inline double spread_that_needs(double values, double tolerance) {
  return tolerance * std::sqrt(values) / 1.959964;
}

// The other way round.
inline double values_that_need(double spread, double tolerance) {
  return std::pow(1.959964 * spread / tolerance, 2);
}

// Of mean 1 and this deviation: a mean of squares. Its skewness is twice the deviation.
inline std::gamma_distribution<double> gamma_of(double spread) {
  return std::gamma_distribution<double>(1 / (spread * spread), spread * spread);
}

// Of a standard normal z: lognormal, of mean 1 and this deviation.
inline double lognormal_of(double z, double spread) {
  const double logarithmic = std::sqrt(std::log1p(spread * spread));
  return std::exp(logarithmic * z - logarithmic * logarithmic / 2);
}

}  // namespace peclet::runner
