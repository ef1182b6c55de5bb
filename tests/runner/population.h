// Populations of mean 1 that the studies of the stop rule draw from.
#pragma once

#include <cmath>

namespace peclet::runner {

// The deviation of which a 95 % interval of so many values is as wide as the tolerance: z = 1.959964.
inline double spread_that_needs(double values, double tolerance) {
  return tolerance * std::sqrt(values) / 1.959964;
}

// Of a standard normal z: lognormal, of mean 1 and this deviation.
inline double lognormal_of(double z, double spread) {
  const double logarithmic = std::sqrt(std::log1p(spread * spread));
  return std::exp(logarithmic * z - logarithmic * logarithmic / 2);
}

}  // namespace peclet::runner
