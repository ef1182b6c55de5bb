// Holds the properties of all particles and arranges them in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/state/periodic_cell.h"
#include "engine/state/vector_field.h"

namespace peclet::engine {

// Spheres in the laboratory frame. A position may lie outside the cell; position and velocity are then those
// of the image at that place. `image` counts the lattice vectors k that wrapping has removed, in the current
// basis: the unwrapped position is x + H k (periodic_cell.h).
struct ParticleState {
  std::vector<double> radius, mass, inertia;  // moment of inertia 2/5 m a^2
  std::vector<std::uint16_t> size_class;      // index into the table of distinct radii
  std::vector<std::uint32_t> id;              // constant, while the order in memory changes
  VectorField position, velocity, angular_velocity;
  std::vector<LatticeShift> image;

  std::size_t count() const { return radius.size(); }
};

// Returns spheres at rest at the origin, of mass 4/3 pi density a^3. The distinct radii in ascending order
// are the size classes.
ParticleState make_particles(const std::vector<double>& radius, double density);
// Gives each sphere its own density. Spheres of one radius must have one density.
ParticleState make_particles(const std::vector<double>& radius, const std::vector<double>& density);

// Returns the distinct values of `radius` in ascending order.
std::vector<double> distinct_radii(const std::vector<double>& radius);

// Moves every particle into the cell: subtracts H k from its position and L H k from its velocity.
void wrap_into_cell(ParticleState& particles, const PeriodicCell& box);

// Returns the total volume of spheres of these radii.
double solid_volume(const std::vector<double>& radius);
inline double solid_volume(const ParticleState& particles) { return solid_volume(particles.radius); }

// Rearranges the particles along a Morton curve through the cell, so that those of one block lie close
// together. Positions must lie in the cell. Systems of one block stay as they are. The order depends only on
// the positions and the order before. Rows move to new memory, which each thread writes for its own blocks.
void arrange_along_curve(ParticleState& particles, const PeriodicCell& box, int threads = 1);

// Rearranges particles that are in the order of their ids, as they are made, so that particles.id becomes
// `id`. Throws ArchiveError if `id` is not a permutation.
void arrange_by_id(ParticleState& particles, const std::vector<std::uint32_t>& id);

}  // namespace peclet::engine
