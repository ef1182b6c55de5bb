#include "engine/scene/size_distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace peclet::engine {

namespace {

constexpr int grid_cells = 1 << 14;

// Of a Gaussian that is cut off at three standard deviations, in units of these:
// sqrt(1 - 6 exp(-9/2) / sqrt(2 pi) / erf(3 / sqrt(2))).
constexpr double width_of_cut_gaussian = 0.98657845;

// A density over radii, up to a factor, and where it is not 0.
struct Density {
  double lowest, highest;
  std::function<double(double)> at;
};

// Of number as of volume all but 1e-9 lie within six standard deviations of ln a; they are apart by 3 s^2.
Density lognormal_density(const SizeDistribution& of) {
  const double variance = std::log1p(of.relative_width * of.relative_width), s = std::sqrt(variance);
  const double middle = std::log(of.mean_radius) - variance / 2;
  const double below = of.by_volume ? 3 * variance : 0, above = 3 * variance - below;
  return {std::exp(middle - below - 6 * s), std::exp(middle + above + 6 * s), [=](double a) {
            const double x = (std::log(a) - middle) / s;
            return std::exp(-x * x / 2) / a;
          }};
}

Density uniform_density(const SizeDistribution& of) {
  const double half = std::sqrt(3.0) * of.relative_width;
  return {of.mean_radius * (1 - half), of.mean_radius * (1 + half), [](double) { return 1.0; }};
}

Density gaussian_density(const SizeDistribution& of) {
  const double m = of.mean_radius, s = m * of.relative_width / width_of_cut_gaussian;
  return {m - 3 * s, m + 3 * s, [=](double a) {
            const double x = (a - m) / s;
            return std::exp(-x * x / 2);
          }};
}

Density density_of_radii(const SizeDistribution& of) {
  if (of.form == SizeDistribution::Form::lognormal) return lognormal_density(of);
  return of.form == SizeDistribution::Form::uniform ? uniform_density(of) : gaussian_density(of);
}

// Number and volume (over 4 pi / 3) of spheres.
struct Amount {
  double number = 0, volume = 0;

  void add(const Amount& other, double part) {
    number += part * other.number;
    volume += part * other.volume;
  }
};

// In cells that are equally wide in ln a, by the rule of midpoints.
std::vector<Amount> amounts_of(const SizeDistribution& distribution) {
  const Density density = density_of_radii(distribution);
  const double step = std::log(density.highest / density.lowest) / grid_cells;
  std::vector<Amount> amounts;
  amounts.reserve(grid_cells);
  for (int i = 0; i < grid_cells; ++i) {
    const double a = density.lowest * std::exp((i + 0.5) * step), cube = a * a * a;
    const double share = density.at(a) * a;
    amounts.push_back(distribution.by_volume ? Amount{share / cube, share} : Amount{share, share * cube});
  }
  return amounts;
}

double with_six_digits(double value) { return std::stod(fmt::format("{:.6g}", value)); }

}  // namespace

double largest_relative_width(SizeDistribution::Form form) {
  if (form == SizeDistribution::Form::lognormal) return 1;
  return form == SizeDistribution::Form::uniform ? 0.55 : 0.32;
}

std::vector<SizeClass> size_classes(const SizeDistribution& distribution) {
  const std::vector<Amount> amounts = amounts_of(distribution);
  Amount whole;
  for (const Amount& amount : amounts) whole.add(amount, 1);
  std::vector<Amount> classes(distribution.classes);
  const auto count = static_cast<double>(classes.size());
  double below = 0;  // the mean share of number and volume, in classes
  for (const Amount& amount : amounts) {
    const double width = count * (amount.number / whole.number + amount.volume / whole.volume) / 2;
    double from = below;
    const double to = below + width;
    while (from < to) {
      const std::size_t k = std::min(static_cast<std::size_t>(from), classes.size() - 1);
      const double end = k + 1 < classes.size() ? std::min(to, static_cast<double>(k + 1)) : to;
      classes[k].add(amount, (end - from) / width);
      from = end;
    }
    below = to;
  }
  std::vector<SizeClass> sizes;
  sizes.reserve(classes.size());
  for (const Amount& one : classes) {
    sizes.push_back({with_six_digits(std::cbrt(one.volume / one.number)), one.number / whole.number});
  }
  return sizes;
}

}  // namespace peclet::engine
