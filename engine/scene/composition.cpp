#include "engine/scene/composition.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace peclet::engine {
namespace {

// In proportion to the number of spheres.
std::vector<double> number_weights(const Particles& particles) {
  std::vector<double> weights;
  for (const Species& species : particles.species) {
    const double a = species.radius;
    const bool by_number = particles.shares == Particles::Shares::number;
    weights.push_back(by_number ? species.share : species.share / (a * a * a));
  }
  return weights;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Whole numbers in proportion to the weights, `count` together; those with the largest remainders are rounded
// up.
std::vector<std::size_t> by_largest_remainders(const std::vector<double>& weights, std::size_t count) {
  const double total = sum_of(weights);
  std::vector<std::size_t> number;
  std::vector<std::pair<double, std::size_t>> remainder;
  std::size_t given = 0;
  for (std::size_t s = 0; s < weights.size(); ++s) {
    const double exact = static_cast<double>(count) * weights[s] / total;
    number.push_back(static_cast<std::size_t>(exact));
    given += number.back();
    remainder.emplace_back(-(exact - std::floor(exact)), s);
  }
  std::sort(remainder.begin(), remainder.end());
  for (std::size_t k = 0; given < count; ++k, ++given) {
    ++number[remainder[k % remainder.size()].second];
  }
  return number;
}

std::vector<std::size_t> numbers_of_mixture(const Particles& particles) {
  const std::vector<Species>& species = particles.species;
  const std::vector<double> weights = number_weights(particles), exact = exact_numbers(particles);
  const std::size_t colloids = particles.mixture->colloid_species;
  std::vector<std::size_t> grains(species.size() - colloids);
  std::iota(grains.begin(), grains.end(), colloids);
  std::stable_sort(grains.begin(), grains.end(),
                   [&](std::size_t a, std::size_t b) { return species[a].radius > species[b].radius; });
  std::vector<std::size_t> number(species.size());
  std::size_t left = particles.count;
  double volume = 0;  // that is still owed, over 4 pi / 3
  for (const std::size_t s : grains) {
    const double cube = std::pow(species[s].radius, 3);
    volume += exact[s] * cube;
    number[s] = std::min(left, static_cast<std::size_t>(std::max(0.0, std::round(volume / cube))));
    volume -= static_cast<double>(number[s]) * cube;
    left -= number[s];
  }
  const auto end = weights.begin() + static_cast<std::ptrdiff_t>(colloids);
  const std::vector<std::size_t> others = by_largest_remainders({weights.begin(), end}, left);
  std::copy(others.begin(), others.end(), number.begin());
  return number;
}

}  // namespace

double mass_of(const Particles& particles, const Species& species) {
  const double a = species.radius;
  return 4.0 / 3.0 * std::numbers::pi * density_of(particles, species) * a * a * a;
}

std::vector<double> exact_numbers(const Particles& particles) {
  std::vector<double> numbers = number_weights(particles);
  const double per_weight = static_cast<double>(particles.count) / sum_of(numbers);
  for (double& number : numbers) number *= per_weight;
  return numbers;
}

std::vector<std::size_t> species_numbers(const Particles& particles) {
  const std::optional<Mixture>& mixture = particles.mixture;
  const bool has_both =
      mixture && mixture->colloid_species > 0 && mixture->colloid_species < particles.species.size();
  return has_both ? numbers_of_mixture(particles)
                  : by_largest_remainders(number_weights(particles), particles.count);
}

std::vector<double> volume_shares(const Particles& particles, const std::vector<std::size_t>& number) {
  std::vector<double> volumes;
  for (std::size_t s = 0; s < number.size(); ++s) {
    volumes.push_back(static_cast<double>(number[s]) * std::pow(particles.species[s].radius, 3));
  }
  const double total = sum_of(volumes);
  for (double& volume : volumes) volume /= total;
  return volumes;
}

std::vector<double> wanted_volume_shares(const Particles& particles) {
  std::vector<double> volumes;
  for (const Species& species : particles.species) {
    volumes.push_back(volume_weight(particles.shares, species.share, species.radius));
  }
  const double total = sum_of(volumes);
  for (double& volume : volumes) volume /= total;
  return volumes;
}

bool has_every_size(const Particles& particles) {
  const std::vector<std::size_t> number = species_numbers(particles);
  std::set<double> present;
  for (std::size_t s = 0; s < number.size(); ++s) {
    if (number[s] > 0) present.insert(particles.species[s].radius);
  }
  return std::ranges::all_of(particles.species, [&](const Species& s) { return present.contains(s.radius); });
}

std::size_t smallest_count(Particles particles) {
  particles.count = 1;
  const std::vector<double> exact = exact_numbers(particles);
  std::map<double, double> share;
  for (std::size_t s = 0; s < exact.size(); ++s) share[particles.species[s].radius] += exact[s];
  double least = 1;
  for (const auto& [radius, part] : share) least = std::min(least, part);
  // Grains of a mixture are rounded one after the other, and may want a few more.
  for (double count = std::ceil(1 / least - 1e-9); count <= most_particles;
       count += 1 + std::floor(count / 50)) {
    particles.count = static_cast<std::size_t>(count);
    if (has_every_size(particles)) return particles.count;
  }
  return 0;
}

}  // namespace peclet::engine
