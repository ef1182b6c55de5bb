#include "engine/state/neighbour_list.h"

#include <Eigen/SVD>
#include <algorithm>
#include <bit>

#include "engine/state/eigen_vector.h"
#include "engine/state/list_builder.h"

namespace peclet::engine {
namespace {

// Smallest singular value of 1 + D. That of [[1, g], [0, 1]] is sqrt(1 + g^2/4) - |g|/2.
double smallest_stretch(const Matrix3& displacement_gradient) {
  const double strain = displacement_gradient.column[1].x;
  if (displacement_gradient == simple_shear(strain)) {
    return std::sqrt(1 + 0.25 * strain * strain) - 0.5 * std::abs(strain);
  }
  return Eigen::JacobiSVD<Eigen::Matrix3d>(to_eigen(identity() + displacement_gradient)).singularValues()[2];
}

}  // namespace

std::size_t count_of_particle_blocks(std::size_t particles) {
  return std::bit_ceil((particles + most_particles_per_block - 1) / most_particles_per_block);
}

void NeighbourList::build(const ParticleState& particles, const PeriodicCell& box, int threads) {
  rebuild_from(particles.position, particles, box, threads);
  ++builds_;
}

void NeighbourList::rebuild_from(VectorField reference, const ParticleState& particles,
                                 const PeriodicCell& box, int threads) {
  reference_ = std::move(reference);
  gradient_at_build_ = box.displacement_gradient();
  ListBuilder(*this, particles, box, threads).run();
}

double NeighbourList::reach(double range) const {
  constexpr double share_of_strain = 0.1;
  const double smallest = ranges_.smallest();
  return range + skin_ * (smallest + share_of_strain * (range - smallest));
}

double NeighbourList::allowed_displacement(const PeriodicCell& box) const {
  const double stretch = smallest_stretch(since_build(box));
  // Linear in the range: the smallest or the largest one decides.
  const auto left = [&](double range) { return 0.5 * (stretch * reach(range) - range); };
  return std::min(left(ranges_.smallest()), left(ranges_.largest()));
}

double NeighbourList::largest_displacement(const ParticleState& particles, const PeriodicCell& box) const {
  const Matrix3 gradient = since_build(box);
  double largest = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 from = reference_[i];
    const Vector3 way = particles.position[i] - from - gradient * from;
    largest = std::max(largest, dot(way, way));
  }
  return std::sqrt(largest);
}

bool NeighbourList::holds(const ParticleState& particles, const PeriodicCell& box) const {
  return largest_displacement(particles, box) < allowed_displacement(box);
}

}  // namespace peclet::engine
