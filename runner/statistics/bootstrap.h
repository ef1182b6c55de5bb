// Bootstrap-t: an interval that follows the skewness of the values.
#pragma once

#include <optional>
#include <span>

#include "runner/statistics/statistics.h"

namespace peclet::runner {

// The two-sided interval m - t*(1 - a/2) s .. m - t*(a/2) s, a = 1 - confidence, of the mean m with standard
// error s, t* being quantiles of (m* - m) / s* over 4000 resamples of the values with replacement (B. Efron
// and R. Tibshirani, An Introduction to the Bootstrap, 1993, 12.5). Resamples without spread are drawn again.
// The random numbers are always the same, so the same values give the same interval. Nothing for fewer than
// five values, values without spread, and where next to no resample has a finite one.
std::optional<Interval> bootstrap_t(std::span<const double> values, double confidence);

}  // namespace peclet::runner
