#include "engine/state/neighbour_list.h"

#include <algorithm>
#include <bit>

#include "engine/state/list_builder.h"

namespace peclet::engine {
namespace {

// Smallest singular value of [[1, g], [0, 1]]: sqrt(1 + g^2/4) - |g|/2.
double smallest_stretch(double strain) {
  return std::sqrt(1 + 0.25 * strain * strain) - 0.5 * std::abs(strain);
}

}  // namespace

std::size_t count_of_particle_blocks(std::size_t particles) {
  return std::bit_ceil((particles + most_particles_per_block - 1) / most_particles_per_block);
}

void NeighbourList::build(const ParticleState& particles, const ShearedBox& box, int threads) {
  rebuild_from(particles.position, particles, box, threads);
  ++builds_;
}

void NeighbourList::rebuild_from(VectorField reference, const ParticleState& particles, const ShearedBox& box,
                                 int threads) {
  reference_ = std::move(reference);
  strain_at_build_ = box.strain();
  ListBuilder(*this, particles, box, threads).run();
}

double NeighbourList::reach(double range) const {
  constexpr double share_of_strain = 0.1;
  const double smallest = ranges_.smallest();
  return range + skin_ * (smallest + share_of_strain * (range - smallest));
}

double NeighbourList::allowed_displacement(const ShearedBox& box) const {
  const double stretch = smallest_stretch(box.strain() - strain_at_build_);
  // Linear in the range: the smallest or the largest one decides.
  const auto left = [&](double range) { return 0.5 * (stretch * reach(range) - range); };
  return std::min(left(ranges_.smallest()), left(ranges_.largest()));
}

double NeighbourList::largest_displacement(const ParticleState& particles, const ShearedBox& box) const {
  const double strain = box.strain() - strain_at_build_;
  double largest = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 from = reference_[i];
    const Vector3 way = particles.position[i] - from - Vector3{strain * from.y, 0, 0};
    largest = std::max(largest, dot(way, way));
  }
  return std::sqrt(largest);
}

bool NeighbourList::holds(const ParticleState& particles, const ShearedBox& box) const {
  return largest_displacement(particles, box) < allowed_displacement(box);
}

}  // namespace peclet::engine
