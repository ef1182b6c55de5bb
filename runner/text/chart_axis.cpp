#include "runner/text/chart_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace peclet::runner {
namespace {

constexpr double margin = 0.05;  // of the length, on either side
// Below, a logarithmic axis has too few round numbers.
constexpr double least_ratio_of_logarithmic = 5;
constexpr std::size_t fewest_ticks = 3;

// "0.01", "2000", "5·10⁶".
std::string number_text(double value) {
  const double size = std::abs(value);
  if (value == 0 || (size >= 1e-3 && size < 1e5)) return fmt::format("{:g}", value);
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const double leading = value / std::pow(10.0, power);
  std::string text = std::abs(leading - 1) < 1e-9 ? "10" : fmt::format("{:.4g}·10", leading);
  for (const char c : std::to_string(power)) text += c == '-' ? "⁻" : digits[c - '0'];
  return text;
}

// The part of the whole that the widest gap between neighbours takes. Requires numbers in order, not all
// equal.
double widest_gap(const std::vector<double>& numbers) {
  double widest = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) widest = std::max(widest, numbers[i] - numbers[i - 1]);
  return widest / (numbers.back() - numbers.front());
}

}  // namespace

ChartAxis::Scale fitting_scale(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  if (numbers.empty() || numbers.front() <= 0 ||
      numbers.back() < least_ratio_of_logarithmic * numbers.front()) {
    return ChartAxis::Scale::linear;
  }
  std::vector<double> logarithms;
  logarithms.reserve(numbers.size());
  for (const double number : numbers) logarithms.push_back(std::log(number));
  return widest_gap(logarithms) < widest_gap(numbers) ? ChartAxis::Scale::logarithmic
                                                      : ChartAxis::Scale::linear;
}

ChartAxis::ChartAxis(Scale scale, double low, double high, double begin, double end, std::size_t most_ticks)
    : logarithmic_(scale == Scale::logarithmic),
      most_ticks_(most_ticks),
      low_(logarithmic_ ? std::log10(low) : low),
      high_(logarithmic_ ? std::log10(high) : high),
      begin_(begin),
      end_(end) {
  // A single number lies in the middle of an axis that it gives the scale of.
  const double size = std::max(std::abs(low_), std::abs(high_));
  double width = high_ - low_;
  if (width <= 1e-9 * size) width = size > 0 ? size : 1;
  low_ -= margin * width;
  high_ += margin * width;
}

double ChartAxis::place(double value) const {
  const double number = logarithmic_ ? std::log10(value) : value;
  return begin_ + (number - low_) / (high_ - low_) * (end_ - begin_);
}

std::vector<ChartAxis::Tick> ChartAxis::ticks() const {
  return logarithmic_ ? logarithmic_ticks() : linear_ticks();
}

std::vector<ChartAxis::Tick> ChartAxis::linear_ticks() const {
  const double unit = std::pow(10.0, std::floor(std::log10(high_ - low_)) - 1);
  for (double scale = unit;; scale *= 10) {
    for (const int multiple : {1, 2, 5}) {
      const double step = multiple * scale;
      const auto first = static_cast<long long>(std::ceil(low_ / step));
      const auto last = static_cast<long long>(std::floor(high_ / step));
      if (last - first >= static_cast<long long>(most_ticks_)) continue;
      std::vector<Tick> ticks;
      for (long long i = first; i <= last; ++i) {
        const double value = static_cast<double>(i) * step;
        ticks.push_back({value, number_text(value)});
      }
      return ticks;
    }
  }
}

std::vector<ChartAxis::Tick> ChartAxis::powers(int stride, const std::vector<int>& multiples) const {
  std::vector<Tick> ticks;
  for (int power = static_cast<int>(std::floor(low_)); power <= static_cast<int>(high_) + 1; ++power) {
    if (power % stride != 0) continue;
    for (const int multiple : multiples) {
      const double value = multiple * std::pow(10.0, power);
      const double place = std::log10(value);
      if (place >= low_ && place <= high_) ticks.push_back({value, number_text(value)});
    }
  }
  return ticks;
}

std::vector<ChartAxis::Tick> ChartAxis::logarithmic_ticks() const {
  for (const std::vector<int>& multiples :
       {std::vector<int>{1, 2, 5}, {1}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}}) {
    std::vector<Tick> ticks = powers(1, multiples);
    if (ticks.size() >= fewest_ticks && ticks.size() <= most_ticks_) return ticks;
  }
  for (int stride = 1;; ++stride) {
    std::vector<Tick> ticks = powers(stride, {1});
    if (ticks.size() <= most_ticks_) return ticks;
  }
}

}  // namespace peclet::runner
