// Which spheres there are: sizes, shares, densities, and whole numbers of each.
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
  double share = 0;  // of the volume or of the number, see Particles; the shares add up to 1
  std::optional<double> density = {};  // the particles' one where there is none
};

// Two groups of species, colloids before grains. alpha is the volume of the grains over that of all spheres;
// a group without volume has no species.
struct Mixture {
  double alpha = 0;
  std::size_t colloid_species = 0;              // the first ones; the others are grains
  double colloid_radius = 0, grain_radius = 0;  // of the first species of each group, there or not

  // a_cg = (1 - alpha) a_c + alpha a_g.
  double mean_radius() const { return (1 - alpha) * colloid_radius + alpha * grain_radius; }
};

struct Particles {
  enum class Shares { volume, number };
  std::size_t count = 0;
  double density = 0;
  double reference_radius = 0;  // the a of Pe, St and the time scales
  Shares shares = Shares::volume;
  std::vector<Species> species;  // of one radius all have the same density
  std::optional<Mixture> mixture = {};
  bool distributed = false;  // some species stand for a distribution
};

inline double density_of(const Particles& particles, const Species& species) {
  return species.density.value_or(particles.density);
}

// In proportion to the volume of a species with such a share.
inline double volume_weight(Particles::Shares shares, double share, double radius) {
  return shares == Particles::Shares::number ? share * radius * radius * radius : share;
}

// 4 pi / 3 rho a^3.
double mass_of(const Particles& particles, const Species& species);

// How many of `count` spheres the shares give to each species, before rounding.
std::vector<double> exact_numbers(const Particles& particles);

// How many spheres each species has: its number share, or its volume share over a^3, of `count`, rounded by
// largest remainders. In a mixture the grains are rounded first, from the largest on, each time with the
// volume that rounding has left over, so that alpha is met to half of the smallest grain; the colloids share
// what is left of `count`.
std::vector<std::size_t> species_numbers(const Particles& particles);

// Volume of each species over that of all, of these numbers.
std::vector<double> volume_shares(const Particles& particles, const std::vector<std::size_t>& number);

// The volume shares that the scene asks for.
std::vector<double> wanted_volume_shares(const Particles& particles);

// Returns whether each radius has a sphere among the `count` of these particles.
bool has_every_size(const Particles& particles);

// Returns the number of spheres from which on the shares give each radius a whole one; 0 if it is larger than
// `most_particles`. Rounding may give all of them one at fewer, but not at every larger count.
std::size_t smallest_count(Particles particles);

// Rows of the blocks /particles, /volume_fraction and /addition.
std::string particle_keys();

// Reads the sizes with their shares, densities and the radius of reference. Throws InputError where they do
// not go together.
Particles read_particles(const SceneDocument& scene);

// As given, or with /addition that of the mixture in which the liquid and the other group stay what they were
// at the base volume fraction phi_0: phi_0 / (phi_0 + (1 - phi_0) s), s the share of that other group among
// the spheres. Throws InputError where it is too large.
double read_volume_fraction(const SceneDocument& scene, const Particles& particles);

}  // namespace peclet::engine
