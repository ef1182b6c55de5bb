#include "engine/state/neighbour_list.h"

#include <Eigen/SVD>
#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "engine/state/eigen_vector.h"
#include "engine/state/list_builder.h"
#include "engine/threads/for_each_range.h"

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

// Displacement gradient of the cell since then: D' - D seen from the cell as it was.
Matrix3 change_since(const ListMoment& then, const PeriodicCell& box) {
  return (box.displacement_gradient() - then.displacement_gradient) *
         inverse(identity() + then.displacement_gradient);
}

double largest_displacement(const ListMoment& then, const ParticleState& particles, const PeriodicCell& box,
                            int threads) {
  const Matrix3 gradient = change_since(then, box);
  std::atomic<double> largest = 0;
  for_each_range(particles.count(), threads, [&](std::size_t begin, std::size_t end) {
    double own = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3 from = then.position[i];
      const Vector3 way = particles.position[i] - from - gradient * from;
      own = std::max(own, dot(way, way));
    }
    for (double seen = largest; own > seen && !largest.compare_exchange_weak(seen, own);) {
    }
  });
  return std::sqrt(largest);
}

}  // namespace

std::size_t count_of_particle_blocks(std::size_t particles) {
  return std::bit_ceil((particles + most_particles_per_block - 1) / most_particles_per_block);
}

void NeighbourList::build(const ParticleState& particles, const PeriodicCell& box, int threads) {
  const ListMoment now = {particles.position, box.displacement_gradient()};
  rebuild_from(now, now, particles, box, threads);
  ++builds_;
}

void NeighbourList::rebuild_from(ListMoment candidates, ListMoment listed, const ParticleState& particles,
                                 PeriodicCell box, int threads) {
  found_ = std::move(candidates);
  box.deform(found_.displacement_gradient);
  ListBuilder builder(*this, particles, box, threads);
  if (keeps_candidates()) {
    candidates_ = builder.find(found_.position, skin_of_candidates_);
    listed_ = std::move(listed);
    box.deform(listed_.displacement_gradient);
    list_candidates(particles, box, threads);
  } else {
    listed_ = std::exchange(found_, {});
    builder.arrange(builder.find(listed_.position, skin_));
  }
}

bool NeighbourList::can_narrow(const ParticleState& particles, const PeriodicCell& box, int threads) const {
  return keeps_candidates() && !candidates_.empty() &&
         engine::largest_displacement(found_, particles, box, threads) <
             allowed_displacement(found_, skin_of_candidates_, skin_, box);
}

void NeighbourList::narrow(const ParticleState& particles, const PeriodicCell& box, int threads) {
  listed_ = {particles.position, box.displacement_gradient()};
  list_candidates(particles, box, threads);
  ++builds_;
}

void NeighbourList::list_candidates(const ParticleState& particles, const PeriodicCell& box, int threads) {
  ListBuilder builder(*this, particles, box, threads);
  builder.arrange(builder.near_ones(candidates_));
}

double NeighbourList::reach(double range, double skin) const {
  constexpr double share_of_strain = 0.1;
  const double smallest = ranges_.smallest();
  return range + skin * (smallest + share_of_strain * (range - smallest));
}

double NeighbourList::allowed_displacement(const ListMoment& then, double skin, double inner_skin,
                                           const PeriodicCell& box) const {
  const double stretch = smallest_stretch(change_since(then, box));
  // Linear in the range: the smallest or the largest one decides.
  const auto left = [&](double range) {
    return 0.5 * (stretch * reach(range, skin) - reach(range, inner_skin));
  };
  return std::min(left(ranges_.smallest()), left(ranges_.largest()));
}

double NeighbourList::allowed_displacement(const PeriodicCell& box) const {
  constexpr double none = 0;
  return allowed_displacement(listed_, skin_, none, box);
}

double NeighbourList::largest_displacement(const ParticleState& particles, const PeriodicCell& box,
                                           int threads) const {
  return engine::largest_displacement(listed_, particles, box, threads);
}

bool NeighbourList::holds(const ParticleState& particles, const PeriodicCell& box) const {
  return largest_displacement(particles, box) < allowed_displacement(box);
}

}  // namespace peclet::engine
