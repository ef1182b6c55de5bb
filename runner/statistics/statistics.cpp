#include "runner/statistics/statistics.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace peclet::runner {
namespace {

// Returns a power of two by which the values can be multiplied so that no sum, square or cube of them
// overflows or vanishes. It changes no digit of usual values.
double unit_of(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  constexpr int most = std::numeric_limits<double>::max_exponent - 2;
  return largest > 0 && std::isfinite(largest) ? std::ldexp(1, std::clamp(-std::ilogb(largest), -most, most))
                                               : 1;
}

bool is_binary(double value) { return value == 0 || value == 1; }

Estimate::Values values_between(int count, double low, double high, bool are_binary, bool is_share) {
  // Equal numbers that were summed in different order differ by less.
  constexpr double rounding = 1e-13;
  const bool are_equal = high - low <= rounding * std::max(std::abs(low), std::abs(high));
  if (count > 0 && are_binary && (is_share || !are_equal)) return Estimate::Values::share;
  return count > 1 && are_equal ? Estimate::Values::equal : Estimate::Values::spread;
}

constexpr int resamples = 4000;
// Enough for finite numbers: if four of five values are equal, two resamples in three have a spread.
constexpr int most_draws = 4 * resamples;
constexpr std::size_t fewest_values = 5;

// Returns the quantile, interpolated linearly between the order statistics.
double quantile(const std::vector<double>& sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - std::floor(place)) * (sorted[above] - sorted[below]);
}

}  // namespace

Estimate estimate(std::span<const double> values, bool is_share) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Estimate result{static_cast<int>(values.size()), none, none};
  if (values.empty()) return result;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  result.values = values_between(result.count, *low, *high,
                                 std::all_of(values.begin(), values.end(), is_binary), is_share);
  const auto count = static_cast<double>(values.size());
  const double unit = unit_of(values);

  double sum = 0;
  for (const double value : values) sum += unit * value;
  const double first_mean = sum / count;
  // The sum of the deviations corrects the rounding of the first mean, so equal values have exactly their
  // mean and no spread.
  double correction = 0;
  for (const double value : values) correction += unit * value - first_mean;
  const double mean = first_mean + correction / count;
  result.mean = mean / unit;
  if (values.size() < 2) return result;

  double squares = 0;
  for (const double value : values) squares += (unit * value - mean) * (unit * value - mean);
  result.standard_error = std::sqrt(squares / (count - 1) / count) / unit;
  return result;
}

void RunningEstimate::add(double value, bool is_share) {
  is_share_ = is_share_ && is_share;
  low_ = count_ == 0 ? value : std::min(low_, value);
  high_ = count_ == 0 ? value : std::max(high_, value);
  are_binary_ = are_binary_ && is_binary(value);
  const double before = mean_;
  mean_ += (value - before) / ++count_;
  squares_ += (value - before) * (value - mean_);
}

Estimate RunningEstimate::estimate() const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (count_ == 0) return {0, none, none};
  return {count_, mean_, count_ < 2 ? none : std::sqrt(squares_ / (count_ - 1) / count_),
          values_between(count_, low_, high_, are_binary_, is_share_)};
}

std::vector<Estimate> estimates_of(std::span<const RunningEstimate> running) {
  std::vector<Estimate> estimates;
  estimates.reserve(running.size());
  for (const RunningEstimate& one : running) estimates.push_back(one.estimate());
  return estimates;
}

double skewness(std::span<const double> values) {
  const double unit = unit_of(values), mean = unit * estimate(values).mean;
  double squares = 0, cubes = 0;
  for (const double value : values) {
    const double deviation = unit * value - mean;
    squares += deviation * deviation;
    cubes += deviation * deviation * deviation;
  }
  if (values.size() < 3 || squares == 0) return std::numeric_limits<double>::quiet_NaN();
  return cubes * std::sqrt(static_cast<double>(values.size())) / (squares * std::sqrt(squares));
}

double student_quantile(int degrees, double confidence) {
  const boost::math::students_t distribution(degrees);
  return boost::math::quantile(boost::math::complement(distribution, (1 - confidence) / 2));
}

double variance_excess(double degrees, double probability) {
  const boost::math::chi_squared distribution(degrees);
  return degrees / boost::math::quantile(distribution, probability);
}

double student_half_width(const Estimate& estimate, double confidence) {
  if (estimate.count < 2) return std::numeric_limits<double>::quiet_NaN();
  return student_quantile(estimate.count - 1, confidence) * estimate.standard_error;
}

Interval share_interval(int count, double mean, double confidence) {
  using Beta = boost::math::beta_distribution<>;
  const double ones = std::clamp(count * mean, 0.0, static_cast<double>(count)), zeros = count - ones;
  const double outside = (1 - confidence) / 2;
  return {ones > 0 ? boost::math::quantile(Beta(ones, zeros + 1), outside) : 0,
          zeros > 0 ? boost::math::quantile(boost::math::complement(Beta(ones + 1, zeros), outside)) : 1};
}

double share_quantile(int count, double mean, double probability) {
  const boost::math::beta_distribution<> open(count * mean + 0.5, count * (1 - mean) + 0.5);
  return boost::math::quantile(open, probability);
}

double half_width(const Estimate& estimate, double confidence) {
  switch (estimate.values) {
    case Estimate::Values::spread:
      return student_half_width(estimate, confidence);
    case Estimate::Values::share: {
      if (estimate.count < 2) break;
      const auto [low, high] = share_interval(estimate.count, estimate.mean, confidence);
      return std::max(estimate.mean - low, high - estimate.mean);
    }
    case Estimate::Values::equal:
    case Estimate::Values::repeated:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<Interval> bootstrap_t(std::span<const double> values, double confidence) {
  const Estimate whole = estimate(values);
  if (values.size() < fewest_values || !(whole.standard_error > 0)) return std::nullopt;
  std::mt19937_64 random(0);
  std::vector<double> sample(values.size()), scores;
  for (int draw = 0; draw < most_draws && scores.size() < resamples; ++draw) {
    // Modulo has a bias below 1e-13; std distributions differ between libraries.
    for (double& value : sample) value = values[random() % values.size()];
    const Estimate again = estimate(sample);
    const double score = (again.mean - whole.mean) / again.standard_error;
    if (again.standard_error > 0 && std::isfinite(score)) scores.push_back(score);
  }
  if (scores.size() < resamples) return std::nullopt;
  std::sort(scores.begin(), scores.end());
  const double tail = (1 - confidence) / 2;
  return Interval{whole.mean - quantile(scores, 1 - tail) * whole.standard_error,
                  whole.mean - quantile(scores, tail) * whole.standard_error};
}

}  // namespace peclet::runner
