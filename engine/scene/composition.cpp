#include "engine/scene/composition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "engine/scene/size_distribution.h"

namespace peclet::engine {
namespace {

// Returns weights in proportion to the number of spheres of each species.
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

std::vector<double> over_their_sum(std::vector<double> values) {
  const double total = sum_of(values);
  for (double& value : values) value /= total;
  return values;
}

// Returns whole numbers in proportion to the weights, `count` in all. The largest remainders are rounded up.
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
  for (std::size_t k = 0; given < count; ++k, ++given) ++number[remainder[k % remainder.size()].second];
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
  double volume = 0;  // volume of grains that rounding has left over, in units of 4 pi / 3
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

// Spheres of one size fill at most 0.74 of space. Small spheres fill at most 0.74 of the holes between large
// ones: 1 - 0.26^2.
constexpr double densest_of_one_size = 0.74, densest_of_two_groups = 0.93;

constexpr const char* colloids_at = "/particles/mixture/colloids";
constexpr const char* grains_at = "/particles/mixture/grains";
constexpr const char* alpha_at = "/particles/mixture/alpha";

// Throws InputError unless volume, mass and moment of inertia and their inverses are normal numbers.
void check_sizes(const SceneDocument& scene, const Particles& particles,
                 const std::vector<std::string>& pointers) {
  const auto is_usable = [](double value) { return std::isnormal(value) && std::isnormal(1 / value); };
  for (std::size_t i = 0; i < particles.species.size(); ++i) {
    const Species& species = particles.species[i];
    const double a = species.radius, volume = a * a * a, mass = density_of(particles, species) * volume;
    const double all = static_cast<double>(particles.count) * volume;
    if (!is_usable(volume) || !is_usable(mass) || !is_usable(mass * a * a) || !is_usable(all)) {
      const std::string own = pointers[i] + "/radius";
      scene.refuse(
          scene.has(own) ? own : pointers[i],
          "must give a mass and a moment of inertia that are neither too large nor too small to compute "
          "with, at the density {}; choose other units",
          density_of(particles, species));
    }
    if (!is_usable(species.share)) {
      scene.refuse(pointers[i], "must have a share that is not negligible in the sum of all shares");
    }
  }
}

// Throws InputError if one radius has two densities: kernels find the mass by the radius.
void check_densities(const SceneDocument& scene, const Particles& particles,
                     const std::vector<std::string>& pointers) {
  std::map<double, double> density_at;
  for (std::size_t i = 0; i < particles.species.size(); ++i) {
    const Species& species = particles.species[i];
    const double density = density_of(particles, species);
    const auto [known, is_new] = density_at.emplace(species.radius, density);
    if (is_new || known->second == density) continue;
    const std::string own = pointers[i] + "/density";
    scene.refuse(scene.has(own) ? own : pointers[i],
                 "must be {}, the density of the other spheres of radius {}", known->second, species.radius);
  }
}

// Adds a group that has the share `of_volume` of all volume, with shares of its species by volume.
void add_group(const SpeciesList& group, double of_volume, SpeciesList& all) {
  const auto weight = [&](const Species& one) { return volume_weight(group.shares, one.share, one.radius); };
  double sum = 0;
  for (const Species& one : group.species) sum += weight(one);
  for (std::size_t i = 0; i < group.species.size(); ++i) {
    const Species& one = group.species[i];
    all.species.push_back({one.radius, of_volume * weight(one) / sum, one.density});
    all.pointers.push_back(group.pointers[i]);
  }
  all.distributed = all.distributed || group.distributed;
}

SpeciesList read_mixture(const SceneDocument& scene, Mixture& mixture) {
  const SpeciesList colloids = read_species(scene, colloids_at), grains = read_species(scene, grains_at);
  mixture.alpha = scene.number(alpha_at);
  mixture.colloid_radius = colloids.species.front().radius;
  mixture.grain_radius = grains.species.front().radius;
  SpeciesList all;
  if (mixture.alpha < 1) add_group(colloids, 1 - mixture.alpha, all);
  mixture.colloid_species = all.species.size();
  if (mixture.alpha > 0) add_group(grains, mixture.alpha, all);
  if (all.species.size() > most_species) {
    scene.refuse(grains_at, "must leave at most {} sizes of colloids and grains, not {}", most_species,
                 all.species.size());
  }
  return all;
}

// Returns the radius of reference: the given one, that of a mixture, or the first radius.
double radius_of_reference(const SceneDocument& scene, const Particles& particles) {
  constexpr const char *given = "/particles/reference_radius", *named = "/particles/mixture/reference";
  if (!particles.mixture) return scene.number_or(given, particles.species.front().radius);
  const Mixture& mixture = *particles.mixture;
  if (!scene.has(named)) return scene.number_or(given, mixture.colloid_radius);
  if (scene.has(given))
    scene.refuse(given, "must be left out, because /particles/mixture/reference is given");
  const Json& name = scene.at(named);
  if (name == "colloids") return mixture.colloid_radius;
  return name == "grains" ? mixture.grain_radius : mixture.mean_radius();
}

// Sets rho_i = rho (a / a_i)^2, so that tau_I = rho_i a_i^2 / eta is the same for all sizes.
void set_equal_inertia(const SceneDocument& scene, Particles& particles,
                       const std::vector<std::string>& pointers) {
  for (std::size_t i = 0; i < particles.species.size(); ++i) {
    Species& species = particles.species[i];
    if (species.density) {
      scene.refuse(pointers[i] + "/density",
                   "must be left out with /particles/density_rule \"equal-inertia\"");
    }
    species.density = particles.density * std::pow(particles.reference_radius / species.radius, 2);
  }
}

// {species}: rows of one size; {most}: number of sizes; {one_size} and {two_groups}: the densest packings.
constexpr const char* particle_rows = R"(
/particles | object | The spheres.
/particles/count | integer >= 1 and <= {particles}; named number of particles, N | Number of particles.
/particles/density | number > 0; in mass / length^3; named density of the particles, ρ | Mass density of the
    particles.
/particles/density_rule? | one of equal-inertia | equal-inertia: spheres of radius a_i have the density times
    (a / a_i)^2, a the radius of reference, so that tau_I is the same for all; absent: all have the density,
    unless their species has its own.
/particles/species | array of 1 to {most} | The sizes; all have volume_share or all have number_share. A
    single species needs neither.
{species}
/particles/mixture | object; instead of species | Two groups of sizes, small colloids and large grains, and
    how much of the volume is grains.
/particles/mixture/colloids | array of 1 to {most} | Sizes of the colloids, as in species; shares are within
    the group.
/particles/mixture/colloids/* | object; as /particles/species/* | Each is one size, or one distribution of
    sizes.
/particles/mixture/grains | array of 1 to {most} | Sizes of the grains, as in species; shares are within the
    group.
/particles/mixture/grains/* | object; as /particles/species/* | Each is one size, or one distribution of
    sizes.
/particles/mixture/alpha | number >= 0 and <= 1; named share of grains in the solid volume, α | Volume of the
    grains over that of all spheres: 0 leaves colloids only, 1 grains only.
/particles/mixture/reference? | one of colloids, grains, mean | Radius of reference, in place of
    reference_radius: the first radius a_c of the colloids (unless given), the first radius a_g of the grains,
    or the mean (1 - alpha) a_c + alpha a_g.
/particles/reference_radius? | number > 0; in length | Radius of reference: the a of Pe, St, Brownian times
    and derived groups; the radius of the first species, or of the first colloids, unless given.
/volume_fraction | number > 0 and < {two_groups}; named volume fraction, φ | Volume of the particles over that
    of the box; below 0.74 without a mixture.
/addition | object; instead of volume_fraction | Addition of one group of a mixture while the volumes of the
    liquid and of the other group stay the same; the volume fraction follows from alpha.
/addition/added | one of colloids, grains | Which group is added.
/addition/base_volume_fraction | number > 0 and < {one_size}; named volume fraction before the addition, φ_0 |
    Volume fraction of the other group alone, before the addition.
/box? | object | The periodic box; absent: a cube.
/box/height | number > 0; in length | Edge along y, the direction of the velocity gradient. The other two are
    equal; the volume follows from spheres and volume fraction.
)";

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
  return over_their_sum(std::move(volumes));
}

std::vector<double> wanted_volume_shares(const Particles& particles) {
  std::vector<double> volumes;
  for (const Species& species : particles.species) {
    volumes.push_back(volume_weight(particles.shares, species.share, species.radius));
  }
  return over_their_sum(std::move(volumes));
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
  // Grains of a mixture are rounded one after the other, and may need a few more spheres.
  for (double count = std::ceil(1 / least - 1e-9); count <= most_particles;
       count += 1 + std::floor(count / 50)) {
    particles.count = static_cast<std::size_t>(count);
    if (has_every_size(particles)) return particles.count;
  }
  return 0;
}

std::string particle_keys() {
  using fmt::arg;
  return fmt::format(particle_rows, arg("particles", most_particles), arg("species", species_keys()),
                     arg("most", most_species), arg("one_size", densest_of_one_size),
                     arg("two_groups", densest_of_two_groups));
}

Particles read_particles(const SceneDocument& scene) {
  Particles particles;
  particles.count = scene.at("/particles/count").get<std::size_t>();
  particles.density = scene.number("/particles/density");
  if (scene.has("/particles/mixture")) particles.mixture.emplace();
  const SpeciesList list =
      particles.mixture ? read_mixture(scene, *particles.mixture) : read_species(scene, "/particles/species");
  particles.shares = list.shares;
  particles.species = list.species;
  particles.distributed = list.distributed;
  particles.reference_radius = radius_of_reference(scene, particles);
  if (scene.has("/particles/density_rule")) set_equal_inertia(scene, particles, list.pointers);
  check_sizes(scene, particles, list.pointers);
  check_densities(scene, particles, list.pointers);
  return particles;
}

double read_volume_fraction(const SceneDocument& scene, const Particles& particles) {
  if (scene.has("/addition") && !particles.mixture) {
    scene.refuse("/addition", "must be left out without /particles/mixture");
  }
  if (!scene.has("/addition")) {
    const double fraction = scene.number("/volume_fraction");
    if (!particles.mixture && fraction >= densest_of_one_size) {
      scene.refuse("/volume_fraction", "must be a number > 0 and < {}, with /particles/mixture < {}",
                   densest_of_one_size, densest_of_two_groups);
    }
    return fraction;
  }
  const double base = scene.number("/addition/base_volume_fraction"), alpha = particles.mixture->alpha;
  const double kept = scene.at("/addition/added") == "grains" ? 1 - alpha : alpha;
  const double fraction = base / (base + (1 - base) * kept);
  if (fraction >= densest_of_two_groups) {
    scene.refuse(alpha_at, "must leave a volume fraction < {}; with {} added to {} it is {:.4g}",
                 densest_of_two_groups, scene.at("/addition/added").get<std::string>(), base, fraction);
  }
  return fraction;
}

}  // namespace peclet::engine
