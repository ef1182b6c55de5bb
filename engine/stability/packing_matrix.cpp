#include "engine/stability/packing_matrix.h"

#include <algorithm>

#include "engine/kernels/pairs/pair_access.h"
#include "engine/kernels/pairs/pair_coupling.h"
#include "engine/kernels/pairs/terms.h"
#include "engine/state/eigen_vector.h"
#include "engine/terms/drag.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

PairResistance coupling_of(const Physics& physics, const Terms& terms, const PairKind& kind,
                           const PairGeometry& shape, const MatrixWeights& weights) {
  PairResistance coupling{};
  if (physics.lubrication && shape.distance <= kind.lubrication_range) {
    add_scaled(coupling, weights.resistance, pair_resistance(kind.resistance, kind.gap, shape));
  }
  add_stiffness(coupling, terms, physics.contact.value_or(ContactParameters{}), kind, shape,
                {weights.resistance, weights.stiffness, weights.stiffness}, [] {
                  return HeldSprings<double>{1, 1};
                });
  // Spheres that pull turn back with n: V' / r across it.
  const double slope = potential(kind.conservative, shape.distance, shape.sum_of_radii).slope;
  coupling.shear += weights.stiffness * std::max(slope, 0.0) / shape.distance;
  return coupling;
}

}  // namespace

PackingMatrix::PackingMatrix(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                             const MatrixWeights& weights) {
  const ParticleState& particles = system.particles;
  const auto motions = static_cast<Eigen::Index>(2 * particles.count());
  per_root_inertia_.resize(motions);
  drag_rate_.resize(motions);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i], mass = particles.mass[i], inertia = particles.inertia[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    per_root_inertia_.segment<2>(row) << 1 / std::sqrt(mass), 1 / std::sqrt(inertia);
    drag_rate_.segment<2>(row) << weights.resistance * translational_drag(physics.viscosity, radius) / mass,
        weights.resistance * rotational_drag(physics.viscosity, radius) / inertia;
  }
  const Terms terms = required_terms(physics);
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  for (const Pair& pair : system.list.pairs()) {
    const PairKind& kind = kinds[pair.kind];
    const PairGeometry shape = geometry(separation(particles, pair, frames[pair.image]), kind);
    if (shape.distance <= kind.range) {
      links_.push_back({pair.first, pair.second, shape, coupling_of(physics, terms, kind, shape, weights)});
    }
  }
}

Eigen::VectorXd PackingMatrix::operator*(const Eigen::VectorXd& vector) const {
  // A column for each velocity and spin.
  const Eigen::Map<const Eigen::Matrix3Xd> scaled(vector.data(), 3, drag_rate_.size());
  const Eigen::Matrix3Xd motion = scaled * per_root_inertia_.asDiagonal();
  Eigen::Matrix3Xd load = Eigen::Matrix3Xd::Zero(3, motion.cols());
  for (const Link& link : links_) {
    const Eigen::Index i = 2 * Eigen::Index{link.first}, j = 2 * Eigen::Index{link.second};
    const PairMotion of_pair = {from_eigen(motion.col(j) - motion.col(i)), from_eigen(motion.col(i + 1)),
                                from_eigen(motion.col(j + 1))};
    const PairLoad felt = lubrication_load(link.coupling, link.shape, of_pair);
    load.col(i) -= to_eigen(felt.force);
    load.col(j) += to_eigen(felt.force);
    load.col(i + 1) -= to_eigen(felt.torque_first);
    load.col(j + 1) -= to_eigen(felt.torque_second);
  }
  Eigen::VectorXd product(vector.size());
  Eigen::Map<Eigen::Matrix3Xd>(product.data(), 3, load.cols()) =
      scaled * drag_rate_.asDiagonal() + load * per_root_inertia_.asDiagonal();
  return product;
}

}  // namespace peclet::engine
