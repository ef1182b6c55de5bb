#include "runner/jamming/law.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <numeric>

namespace peclet::runner {
namespace {

constexpr double densest = 1;          // phi_m is below: spheres do not fill space
constexpr double smallest_gap = 1e-7;  // between phi_m and the largest fraction that flows
constexpr int gaps = 400;

class Fit {
 public:
  Fit(const std::vector<LawPoint>& points, const LawForm& form, double flowing)
      : points_(points), form_(form), flowing_(flowing), weights_(weights(points)) {
    for (const LawPoint& point : points) logarithms_.push_back(std::log(point.value));
    const double first = std::log(smallest_gap), last = std::log(densest - flowing);
    for (int i = 0; i < gaps; ++i) {
      gaps_.push_back(first + (last - first) * i / (gaps - 1));
      chi_squared_.push_back(chi_squared(gaps_.back()));
    }
  }

  LawAnswer answer() const {
    const auto least = std::min_element(chi_squared_.begin(), chi_squared_.end()) - chi_squared_.begin();
    if (least == 0) {
      return refused(fmt::format(
          "the points rise more steeply than any power law that diverges above {:.6g}, which flows",
          flowing_));
    }
    if (least == gaps - 1) return refused(unbounded);
    const auto at = static_cast<std::size_t>(least);
    constexpr int bits = 40;
    const auto [best, chi] = boost::math::tools::brent_find_minima(
        [this](double gap) { return chi_squared(gap); }, gaps_[at - 1], gaps_[at + 1], bits);
    return law_at(best, chi, at);
  }

 private:
  static constexpr const char* unbounded =
      "the points do not bound it from above: points nearer to jamming, or smaller errors, would";

  static LawAnswer refused(const std::string& why) { return {std::nullopt, why}; }

  double fraction(double gap) const { return flowing_ + std::exp(gap); }

  Line line_at(double jamming) const {
    const std::vector<double> x = depths(points_, jamming);
    std::vector<double> y = logarithms_;
    if (form_.exponent) {
      for (std::size_t i = 0; i < y.size(); ++i) y[i] -= *form_.exponent * x[i];
    }
    Line line = weighted_line(x, y, weights_, {!form_.unit_prefactor, !form_.exponent});
    if (form_.exponent) line.slope = *form_.exponent;
    return line;
  }
  double chi_squared(double gap) const { return line_at(fraction(gap)).chi_squared; }

  // Where chi^2 first exceeds the bound on the way from the best gap; none where it does not.
  std::optional<double> crossing(double best, std::size_t from, int direction, double bound) const {
    double inside = best;
    for (auto at = static_cast<int>(from); at >= 0 && at < gaps; at += direction) {
      const auto place = static_cast<std::size_t>(at);
      if ((gaps_[place] - best) * direction <= 0) continue;
      if (chi_squared_[place] <= bound) {
        inside = gaps_[place];
        continue;
      }
      double outside = gaps_[place];
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (inside + outside);
        (chi_squared(middle) <= bound ? inside : outside) = middle;
      }
      return fraction(inside);
    }
    return std::nullopt;
  }

  LawAnswer law_at(double best, double chi, std::size_t from) const {
    const double jamming = fraction(best);
    const int degrees = static_cast<int>(points_.size()) - form_.parameters();
    const double scale = std::max(1.0, chi / degrees);
    const Line line = line_at(jamming);
    if (!(line.slope > 0)) return refused("the viscosity does not rise with the fraction");
    const std::optional<double> high = crossing(best, from, 1, chi + z_95 * z_95 * scale);
    const std::optional<double> above = crossing(best, from, 1, chi + scale);
    if (!high || !above) return refused(unbounded);
    const double low = crossing(best, from, -1, chi + z_95 * z_95 * scale).value_or(flowing_);
    const double below = crossing(best, from, -1, chi + scale).value_or(flowing_);
    const double error = 0.5 * (*above - below);
    // How the line turns with phi_m: var = var given phi_m + (d / d phi_m)^2 var of phi_m.
    const double step = 1e-3 * (jamming - flowing_);
    const Line nearer = line_at(jamming - step), farther = line_at(jamming + step);
    const auto whole = [&](double own, double change) {
      return std::sqrt(own * scale + std::pow(change / (2 * step) * error, 2));
    };
    const double factor = std::exp(line.constant);
    Law law{{jamming, error}, low, *high, {}, {}, chi, degrees};
    law.exponent = {line.slope, whole(line.slope_variance, farther.slope - nearer.slope)};
    law.prefactor = {factor, factor * whole(line.constant_variance, farther.constant - nearer.constant)};
    return {law, ""};
  }

  const std::vector<LawPoint>& points_;
  const LawForm& form_;
  double flowing_;
  std::vector<double> weights_, logarithms_, gaps_, chi_squared_;
};

}  // namespace

Line weighted_line(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& weights, const LineForm& form) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto mean = [&](const std::vector<double>& values) {
    return std::inner_product(weights.begin(), weights.end(), values.begin(), 0.0) / total;
  };
  Line line;
  const double x_mean = form.with_constant ? mean(x) : 0, y_mean = form.with_constant ? mean(y) : 0;
  if (form.with_slope) {
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += weights[i] * (x[i] - x_mean) * (x[i] - x_mean);
      xy += weights[i] * (x[i] - x_mean) * (y[i] - y_mean);
    }
    line.slope = xy / xx;
    line.slope_variance = 1 / xx;
  }
  if (form.with_constant) {
    line.constant = y_mean - line.slope * x_mean;
    line.constant_variance = 1 / total + x_mean * x_mean * line.slope_variance;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double left = (y[i] - y_mean) - line.slope * (x[i] - x_mean);
    line.chi_squared += weights[i] * left * left;
  }
  return line;
}

std::vector<double> depths(const std::vector<LawPoint>& points, double jamming) {
  std::vector<double> x;
  x.reserve(points.size());
  for (const LawPoint& point : points) x.push_back(-std::log1p(-point.fraction / jamming));
  return x;
}

std::vector<double> weights(const std::vector<LawPoint>& points) {
  std::vector<double> found;
  found.reserve(points.size());
  for (const LawPoint& point : points) {
    const double relative = point.standard_error / point.value;
    found.push_back((point.count - 3.0) / (point.count - 1.0) / (relative * relative));
  }
  return found;
}

LawAnswer fit_law(const std::vector<LawPoint>& points, const LawForm& form, double flowing) {
  if (points.size() < fewest_points) {
    return {std::nullopt, fmt::format("{} of the {} points that a fit needs", points.size(), fewest_points)};
  }
  return Fit(points, form, flowing).answer();
}

}  // namespace peclet::runner
