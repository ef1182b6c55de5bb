#include "engine/scene/particles_block.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "engine/scene/size_distribution.h"

namespace peclet::engine {

namespace {

// Spheres of one size fill 0.74 of space at most; small ones in the holes of large ones the same of the rest:
// 1 - 0.26^2.
constexpr double densest_of_one_size = 0.74, densest_of_two_groups = 0.93;

constexpr const char* colloids_at = "/particles/mixture/colloids";
constexpr const char* grains_at = "/particles/mixture/grains";
constexpr const char* alpha_at = "/particles/mixture/alpha";

// Volume, mass and moment of inertia must be numbers, and one can divide by them.
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
          fmt::format("must leave mass and moment of inertia that can be computed with, at the density {}; "
                      "choose other units",
                      density_of(particles, species)));
    }
    if (!is_usable(species.share)) {
      scene.refuse(pointers[i], "must have a share that is a part of the sum of all shares");
    }
  }
}

// Kernels know a sphere's mass by its size.
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
                 fmt::format("must be {}, the density of the other spheres of radius {}", known->second,
                             species.radius));
  }
}

// Turns the shares of a group into its parts of all volume, and adds them.
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
    scene.refuse(grains_at, fmt::format("must leave at most {} sizes of colloids and grains, not {}",
                                        most_species, all.species.size()));
  }
  return all;
}

// The a of Pe: as given, that of a mixture, or the first radius.
double radius_of_reference(const SceneDocument& scene, const Particles& particles) {
  constexpr const char *given = "/particles/reference_radius", *named = "/particles/mixture/reference";
  if (!particles.mixture) return scene.number_or(given, particles.species.front().radius);
  const Mixture& mixture = *particles.mixture;
  if (!scene.has(named)) return scene.number_or(given, mixture.colloid_radius);
  if (scene.has(given)) scene.refuse(given, "must be left out together with /particles/mixture/reference");
  const Json& name = scene.at(named);
  if (name == "colloids") return mixture.colloid_radius;
  return name == "grains" ? mixture.grain_radius : mixture.mean_radius();
}

// rho_i = rho (a / a_i)^2, of which tau_I = rho_i a_i^2 / eta is the same for all.
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

// {species}: rows of one size; {most}: of sizes; {one_size} and {two_groups}: the densest packings.
constexpr const char* particle_rows = R"(
/particles | object | The spheres.
/particles/count | integer >= 1 and <= {particles}; named number of particles, N | Number of particles.
/particles/density | number > 0; in mass / length^3; named density of the particles, ρ | Mass density of the
    particles.
/particles/density_rule? | one of equal-inertia | equal-inertia: spheres of radius a_i have the density times
    (a / a_i)^2, a the radius of reference, so that tau_I is the same for all; absent: density is that of all
    that have none of their own.
/particles/species | array of 1 to {most} | The sizes; all have volume_share or all have number_share. A
    single species needs neither.
{species}
/particles/mixture | object; instead of species | Two groups of sizes, small colloids and large grains, and
    how much of the volume is grains.
/particles/mixture/colloids | array of 1 to {most} | Sizes of the colloids, as in species; shares are within
    the group.
/particles/mixture/colloids/* | object; as /particles/species/* | One size, or one distribution of sizes.
/particles/mixture/grains | array of 1 to {most} | Sizes of the grains, likewise.
/particles/mixture/grains/* | object; as /particles/species/* | One size, or one distribution of sizes.
/particles/mixture/alpha | number >= 0 and <= 1; named share of grains in the solid volume, α | Volume of the
    grains over that of all spheres: 0 leaves colloids only, 1 grains only.
/particles/mixture/reference? | one of colloids, grains, mean | The a of Pe in place of reference_radius, by
    the first radius a_c of the colloids and a_g of the grains: a_c, a_g, or mean: (1 - alpha) a_c + alpha
    a_g. colloids unless given.
/particles/reference_radius? | number > 0; in length | The a of Pe, St, Brownian times and derived groups; the
    radius of the first species, or of the first colloids, unless given.
/volume_fraction | number > 0 and < {two_groups}; named volume fraction, φ | Volume of the particles over that
    of the box; below 0.74 without a mixture.
/addition | object; instead of volume_fraction | The volume fraction of a mixture to which one group was
    added, while the volumes of the liquid and of the other group stayed: it follows from alpha.
/addition/added | one of colloids, grains | Which group is added.
/addition/base_volume_fraction | number > 0 and < {one_size}; named volume fraction before the addition, φ_0 |
    Volume fraction before, of the other group alone.
/box? | object | The periodic box; absent: a cube.
/box/height | number > 0; in length | Edge along y, the direction of the velocity gradient. The other two are
    equal; the volume follows from spheres and volume fraction.
)";

}  // namespace

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
      scene.refuse("/volume_fraction",
                   fmt::format("must be a number > 0 and < {}, with /particles/mixture < {}",
                               densest_of_one_size, densest_of_two_groups));
    }
    return fraction;
  }
  const double base = scene.number("/addition/base_volume_fraction"), alpha = particles.mixture->alpha;
  const double kept = scene.at("/addition/added") == "grains" ? 1 - alpha : alpha;
  const double fraction = base / (base + (1 - base) * kept);
  if (fraction >= densest_of_two_groups) {
    scene.refuse(alpha_at, fmt::format("must leave a volume fraction < {}; with {} added to {} it is {:.4g}",
                                       densest_of_two_groups, scene.at("/addition/added").get<std::string>(),
                                       base, fraction));
  }
  return fraction;
}

}  // namespace peclet::engine
