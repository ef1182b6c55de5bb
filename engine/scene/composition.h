// Particles holds the sizes of the spheres, their shares and densities; functions give whole numbers of each.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/flow/scene_document.h"

namespace peclet::engine {

// The largest number of particles that a scene may have.
constexpr std::size_t most_particles = 10'000'000;

struct Species {
  double radius = 0;
  double share = 0;                    // share of volume or number (Particles::shares); all add up to 1
  std::optional<double> density = {};  // empty: the density of Particles
};

// Mixture has two groups of species, colloids before grains. A group without volume has no species.
struct Mixture {
  double alpha = 0;                             // volume of the grains over that of all spheres
  std::size_t colloid_species = 0;              // number of colloid species; the others are grains
  double colloid_radius = 0, grain_radius = 0;  // first radius of each group, even if it has no volume

  // Returns a_cg = (1 - alpha) a_c + alpha a_g.
  double mean_radius() const { return (1 - alpha) * colloid_radius + alpha * grain_radius; }
};

struct Particles {
  enum class Shares { volume, number };
  std::size_t count = 0;
  double density = 0;
  double reference_radius = 0;  // the a of Pe, St and the time scales
  Shares shares = Shares::volume;
  std::vector<Species> species;  // species of one radius have the same density
  std::optional<Mixture> mixture = {};
  bool distributed = false;  // true if some species represent a distribution
};

inline double density_of(const Particles& particles, const Species& species) {
  return species.density.value_or(particles.density);
}

// Returns a weight in proportion to the volume of a species with this share.
inline double volume_weight(Particles::Shares shares, double share, double radius) {
  return shares == Particles::Shares::number ? share * radius * radius * radius : share;
}

// Returns 4 pi / 3 rho a^3.
double mass_of(const Particles& particles, const Species& species);

// Returns the numbers of spheres that the shares give each species, before rounding.
std::vector<double> exact_numbers(const Particles& particles);

// Returns the number of spheres of each species, rounded by largest remainders to add up to `count`. In a
// mixture grains are rounded first, from the largest on, each with the volume that rounding has left over. So
// alpha is met to half of the smallest grain. Colloids share the rest.
std::vector<std::size_t> species_numbers(const Particles& particles);

// Returns the volume of each species over that of all, for these numbers of spheres.
std::vector<double> volume_shares(const Particles& particles, const std::vector<std::size_t>& number);

// Returns the volume shares that the scene asks for.
std::vector<double> wanted_volume_shares(const Particles& particles);

// Returns true if each radius has at least one of the `count` spheres.
bool has_every_size(const Particles& particles);

// Returns the number of spheres from which on the shares give each radius a whole sphere; 0 if it is above
// `most_particles`. Rounding may achieve this with fewer spheres, but not for every larger number.
std::size_t smallest_count(Particles particles);

// Returns the rows of the blocks /particles, /volume_fraction, /addition and /box.
std::string particle_keys();

// Reads sizes, shares, densities and the radius of reference. Throws InputError if they disagree.
Particles read_particles(const SceneDocument& scene);

// Returns the volume fraction of the scene, or with /addition
//   phi = phi_0 / (phi_0 + (1 - phi_0) s),
// phi_0 the base volume fraction and s the share of the other group in the volume of the spheres: the volumes
// of the liquid and of that group are those at phi_0. Throws InputError if it is too large.
double read_volume_fraction(const SceneDocument& scene, const Particles& particles);

}  // namespace peclet::engine
