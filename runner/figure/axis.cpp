#include "runner/figure/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace peclet::runner {
namespace {

// The part of the whole that the widest gap between neighbours takes. Requires numbers in order, not all
// equal.
double widest_gap(const std::vector<double>& numbers) {
  double widest = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) widest = std::max(widest, numbers[i] - numbers[i - 1]);
  return widest / (numbers.back() - numbers.front());
}

// The double that is nearest to so many significant digits.
double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}e}", value, digits - 1)); }

}  // namespace

bool is_logarithmic(std::vector<double> values) {
  constexpr double least_ratio = 5;  // below, there are too few round numbers
  std::sort(values.begin(), values.end());
  if (values.empty() || values.front() <= 0 || values.back() < least_ratio * values.front()) return false;
  std::vector<double> logarithms;
  logarithms.reserve(values.size());
  for (const double value : values) logarithms.push_back(std::log(value));
  return widest_gap(logarithms) < widest_gap(values);
}

Axis::Axis(const AxisRange& range, double begin, double end, std::size_t most_ticks)
    : log_(range.log),
      low_(range.log ? std::log10(range.low) : range.low),
      high_(range.log ? std::log10(range.high) : range.high),
      begin_(begin),
      end_(end),
      most_ticks_(most_ticks) {
  constexpr double margin = 0.05;
  const double size = std::max(std::abs(low_), std::abs(high_));
  double width = high_ - low_;
  if (width <= 1e-9 * size || width == 0) width = size > 0 ? size : 1;
  low_ -= margin * width;
  high_ += margin * width;
}

Axis::Axis(std::size_t words, double begin, double end)
    : low_(-0.5),
      high_(static_cast<double>(words) - 0.5),
      begin_(begin),
      end_(end),
      most_ticks_(words),
      words_(words) {}

double Axis::place(double value) const {
  const double number = log_ ? std::log10(value) : value;
  return begin_ + (number - low_) / (high_ - low_) * (end_ - begin_);
}

double Axis::clamped(double value) const {
  if (log_ && !(value > 0)) return begin_;
  return std::clamp(place(value), std::min(begin_, end_), std::max(begin_, end_));
}

double Axis::low() const { return log_ ? std::pow(10, low_) : low_; }
double Axis::high() const { return log_ ? std::pow(10, high_) : high_; }

std::vector<double> Axis::ticks() const {
  if (words_ > 0) {
    std::vector<double> places;
    for (std::size_t i = 0; i < words_; ++i) places.push_back(static_cast<double>(i));
    return places;
  }
  return log_ ? logarithmic_ticks() : linear_ticks(low_, high_);
}

// 1, 2 or 5 times a power of ten apart.
std::vector<double> Axis::linear_ticks(double low, double high) const {
  for (int power = static_cast<int>(std::floor(std::log10(high - low))) - 1;; ++power) {
    for (const int multiple : {1, 2, 5}) {
      const double step = multiple * std::pow(10, power);
      const double first = std::ceil(low / step), last = std::floor(high / step);
      if (last - first >= static_cast<double>(most_ticks_)) continue;
      std::vector<double> ticks;
      for (double i = first; i <= last; ++i) ticks.push_back(rounded(i * step, 12) + 0.0);  // no -0
      return ticks;
    }
  }
}

// Powers of ten, every `stride`-th, times each of `multiples`.
std::vector<double> Axis::powers(int stride, const std::vector<int>& multiples) const {
  std::vector<double> ticks;
  for (int power = static_cast<int>(std::floor(low_)); power <= high_ + 1; ++power) {
    if (power % stride != 0) continue;
    for (const int multiple : multiples) {
      const double value = std::stod(fmt::format("{}e{}", multiple, power)), place = std::log10(value);
      if (place >= low_ && place <= high_) ticks.push_back(value);
    }
  }
  return ticks;
}

std::vector<double> Axis::logarithmic_ticks() const {
  using Multiples = std::vector<int>;
  for (const Multiples& multiples :
       {Multiples{1, 2, 5}, Multiples{1}, Multiples{1, 2, 3, 4, 5, 6, 7, 8, 9}, Multiples{1, 2, 3, 5, 7}}) {
    std::vector<double> ticks = powers(1, multiples);
    if (ticks.size() >= 3 && ticks.size() <= most_ticks_) return ticks;
  }
  if (high_ - low_ < 1) {  // less than a factor of ten: as on a linear axis
    std::vector<double> ticks = linear_ticks(low(), high());
    std::erase_if(ticks, [](double value) { return value <= 0; });
    return ticks;
  }
  for (int stride = 1;; ++stride) {
    std::vector<double> ticks = powers(stride, {1});
    if (ticks.size() <= most_ticks_) return ticks;
  }
}

std::vector<double> Axis::minor_ticks() const {
  if (!log_ || high_ - low_ > 10) return {};
  std::vector<double> minor = powers(1, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  const std::vector<double> major = ticks();
  std::erase_if(minor,
                [&](double value) { return std::find(major.begin(), major.end(), value) != major.end(); });
  return minor;
}

}  // namespace peclet::runner
