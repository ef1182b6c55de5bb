#include "engine/scene/size_distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "contract/decimal.h"

namespace peclet::engine {
namespace {

constexpr int grid_cells = 1 << 14;

// The standard deviation of a Gaussian that is cut off at three standard deviations, in units of the uncut
// one: sqrt(1 - 6 exp(-9/2) / sqrt(2 pi) / erf(3 / sqrt(2))).
constexpr double width_of_cut_gaussian = 0.98657845;

// A density over radii, up to a factor, and the range in which it is not 0.
struct Density {
  double lowest, highest;
  std::function<double(double)> at;
};

// The range has all but 1e-9 of the number and of the volume: six standard deviations s of ln a about both
// means, which differ by 3 s^2.
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

// Number and volume (in units of 4 pi / 3) of spheres.
struct Amount {
  double number = 0, volume = 0;

  void add(const Amount& other, double part) {
    number += part * other.number;
    volume += part * other.volume;
  }
};

// Returns the amounts in cells of equal width in ln a, by the midpoint rule.
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

constexpr std::size_t usual_classes = 16;

bool by_number(const SpeciesList& list) { return list.shares == Particles::Shares::number; }

SizeDistribution::Form form_of(const std::string& name) {
  if (name == "lognormal") return SizeDistribution::Form::lognormal;
  return name == "uniform" ? SizeDistribution::Form::uniform : SizeDistribution::Form::gaussian;
}

// DistributionReading reads the sizes of one distribution or histogram.
class DistributionReading {
 public:
  DistributionReading(const SceneDocument& scene, std::string pointer)
      : scene_(scene), pointer_(std::move(pointer)), form_(scene.at(pointer_ + "/form").get<std::string>()) {}

  std::vector<SizeClass> classes() const {
    if (form_ == "histogram") return bins();
    SizeDistribution distribution;
    distribution.form = form_of(form_);
    distribution.mean_radius = scene_.number(pointer_ + "/mean_radius");
    distribution.relative_width = scene_.number(pointer_ + "/relative_width");
    distribution.by_volume = by_volume();
    distribution.classes = usual_classes;
    if (scene_.has(pointer_ + "/classes")) {
      distribution.classes = scene_.at(pointer_ + "/classes").get<std::size_t>();
    }
    if (const double most = largest_relative_width(distribution.form); distribution.relative_width > most) {
      scene_.refuse(pointer_ + "/relative_width", "must be at most {} with the form {}", most, form_);
    }
    return size_classes(distribution);
  }

 private:
  bool by_volume() const { return scene_.at(pointer_ + "/by") == "volume"; }

  std::vector<SizeClass> bins() const {
    const Json &radii = scene_.at(pointer_ + "/radii"), &shares = scene_.at(pointer_ + "/shares");
    if (shares.size() != radii.size()) {
      scene_.refuse(pointer_ + "/shares", "must have a share for each of the {} radii", radii.size());
    }
    std::vector<SizeClass> classes;
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const double a = radii[i].get<double>(), share = shares[i].get<double>();
      if (share > 0) classes.push_back({a, by_volume() ? share / (a * a * a) : share});
    }
    if (classes.empty()) scene_.refuse(pointer_ + "/shares", "must have a share > 0");
    return classes;
  }

  const SceneDocument& scene_;
  std::string pointer_, form_;
};

// Adds an element with a distribution. Its classes together have its share.
void add_classes(const SceneDocument& scene, const std::string& pointer, const Species& whole,
                 SpeciesList& list) {
  const std::vector<SizeClass> classes = DistributionReading(scene, pointer + "/distribution").classes();
  const auto weight = [&](const SizeClass& one) {
    return by_number(list) ? one.number : volume_weight(Particles::Shares::number, one.number, one.radius);
  };
  double sum = 0;
  for (const SizeClass& one : classes) sum += weight(one);
  for (const SizeClass& one : classes) {
    list.species.push_back({one.radius, whole.share * weight(one) / sum, whole.density});
    list.pointers.push_back(pointer);
  }
  list.distributed = true;
}

// {0}: largest number of sizes.
constexpr const char* species_rows = R"(
/particles/species/* | object | Each is one size, or one distribution of sizes.
/particles/species/*/radius | number > 0; in length | Radius.
/particles/species/*/volume_share? | number > 0 | Share of the particles' volume, relative to the other
    species (the shares need not add up to 1).
/particles/species/*/number_share? | number > 0 | Share of the number of particles, relative to the other
    species (need not add up to 1).
/particles/species/*/density? | number > 0; in mass / length^3 | Mass density of these spheres; the density of
    all particles unless given.
/particles/species/*/distribution | object; instead of radius | A distribution of radii, represented by a few
    sizes that are the same for all seeds.
/particles/species/*/distribution/form | one of lognormal, uniform, gaussian, histogram | lognormal, uniform,
    gaussian (cut off at three standard deviations): by mean radius and relative width. histogram: by radii
    and shares.
/particles/species/*/distribution/by | one of number, volume | Weight of mean, width and shares: the number of
    the spheres, or their volume.
/particles/species/*/distribution/mean_radius | number > 0; in length; if form lognormal, uniform, gaussian |
    Mean radius; not of a histogram.
/particles/species/*/distribution/relative_width | number > 0 and <= 1; if form lognormal, uniform, gaussian |
    Standard deviation of the radius over its mean, at most 1 (uniform: 0.55, gaussian: 0.32); not of a
    histogram.
/particles/species/*/distribution/classes? | integer >= 1 and <= {0}; if form lognormal, uniform, gaussian |
    Number of sizes; 16 unless given. Not of a histogram, which has its own.
/particles/species/*/distribution/radii | array of 1 to {0}; if form histogram | Radii of a histogram.
/particles/species/*/distribution/radii/* | number > 0; in length
/particles/species/*/distribution/shares | array of 1 to {0}; if form histogram | Shares of a histogram, of
    each radius, relative to each other.
/particles/species/*/distribution/shares/* | number >= 0 | A radius of share 0 has no sphere.
)";

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
  double below = 0;  // mean share of number and volume below this radius, in units of classes
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
    sizes.push_back({with_digits(std::cbrt(one.volume / one.number), 6), one.number / whole.number});
  }
  return sizes;
}

std::string species_keys() { return fmt::format(species_rows, most_species); }

SpeciesList read_species(const SceneDocument& scene, const std::string& pointer) {
  const Json& given = scene.at(pointer);
  const bool of_number = given[0].contains("number_share");
  const std::string wanted = of_number ? "number_share" : "volume_share";
  const std::string other = of_number ? "volume_share" : "number_share";
  SpeciesList list;
  list.shares = of_number ? Particles::Shares::number : Particles::Shares::volume;
  double sum = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string own = fmt::format("{}/{}", pointer, i);
    if (given[i].contains(other)) {
      scene.refuse(own + '/' + other, "must be left out: the first species has {}, all must have the same",
                   wanted);
    }
    if (!given[i].contains(wanted) && given.size() > 1) {
      scene.miss(own + '/' + wanted, "each species must have a {} > 0 (or each a {})", wanted, other);
    }
    Species species = {0, given[i].value(wanted, 1.0)};
    if (given[i].contains("density")) species.density = given[i]["density"].get<double>();
    sum += species.share;
    if (given[i].contains("distribution")) {
      add_classes(scene, own, species, list);
      continue;
    }
    species.radius = given[i]["radius"].get<double>();
    list.species.push_back(species);
    list.pointers.push_back(own);
  }
  if (list.species.size() > most_species) {
    scene.refuse(pointer, "must be at most {} sizes, including those of distributions, not {}", most_species,
                 list.species.size());
  }
  for (Species& one : list.species) one.share /= sum;
  return list;
}

}  // namespace peclet::engine
