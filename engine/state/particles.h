// Particles: what each of them carries, and their order in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/state/periodic_cell.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

// Spheres in the laboratory frame. Positions may lie outside the cell; position and velocity then belong to
// the image at that place (its velocity follows the streaming flow there). `image` counts the lattice vectors
// that wrapping has removed, in the current basis: position + image A is the unwrapped place.
struct ParticleState {
  std::vector<double> radius, mass, inertia;  // inertia 2/5 m a^2
  std::vector<std::uint16_t> size_class;      // index into the table of distinct radii
  std::vector<std::uint32_t> id;              // a number for life; particles may change places in memory
  VectorField position, velocity, angular_velocity;
  std::vector<LatticeShift> image;

  std::size_t count() const { return radius.size(); }
};

// `count` spheres at rest at the origin; the distinct radii in ascending order are the size classes.
// mass = 4/3 pi density a^3.
ParticleState make_particles(const std::vector<double>& radius, double density);
// Each with a density of its own. Spheres of one radius must have the same.
ParticleState make_particles(const std::vector<double>& radius, const std::vector<double>& density);

// The distinct values of `radius` in ascending order.
std::vector<double> distinct_radii(const std::vector<double>& radius);

// Moves every particle into the cell by lattice vectors and its velocity along with it: u -= L H k for k
// removed vectors.
void wrap_into_cell(ParticleState& particles, const PeriodicCell& box);

// Returns the total volume of spheres of these radii.
double solid_volume(const std::vector<double>& radius);
inline double solid_volume(const ParticleState& particles) { return solid_volume(particles.radius); }

// Rearranges the particles along a Morton curve through the cell, so that those of one block stand close
// together. Positions must lie in the cell. Systems of one block stay as they are. The order is a function of
// the positions and of the order before. Rows move to new memory, which each thread fills for its own blocks.
void arrange_along_curve(ParticleState& particles, const PeriodicCell& box, int threads = 1);

// Rearranges particles that stand in order of their ids (as they are made) so that particles.id becomes `id`.
// Throws ArchiveError when `id` is no permutation.
void arrange_by_id(ParticleState& particles, const std::vector<std::uint32_t>& id);

}  // namespace peclet::engine
