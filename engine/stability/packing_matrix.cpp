#include "engine/stability/packing_matrix.h"

#include "engine/kernels/pairs/pair_access.h"
#include "engine/terms/drag.h"
#include "engine/terms/friction.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

// As if every contact stuck.
PairResistance contact_stiffness(const ContactParameters& contact, const PairKind& kind,
                                 const PairGeometry& shape) {
  PairResistance stiffness{};
  if (contact.friction > 0) {
    stiffness = tangential_coupling(
        contact_levers(kind.radius_first, kind.radius_second, shape), contact.tangential_stiffness,
        contact.rolling_stiffness * kind.reduced_diameter * kind.reduced_diameter);
  }
  stiffness.squeeze = contact.normal_stiffness;
  return stiffness;
}

// d^2/dh^2 of the potential strength exp(-h / length).
double repulsion_curvature(double strength, double length, const PairGeometry& shape) {
  return strength / (length * length) * std::exp(-shape.surface_distance() / length);
}

PairResistance coupling_of(const Physics& physics, const PairKind& kind, const PairGeometry& shape,
                           const MatrixWeights& weights) {
  PairResistance coupling{};
  if (physics.lubrication && shape.distance <= kind.lubrication_range) {
    add_scaled(coupling, weights.resistance,
               pair_resistance(kind.resistance, physics.lubrication->inner_gap, shape));
  }
  if (physics.repulsion && shape.distance < kind.repulsion_range) {
    coupling.squeeze +=
        weights.stiffness * repulsion_curvature(physics.repulsion->strength, kind.repulsion_length, shape);
  }
  if (physics.contact && shape.overlap() > 0) {
    coupling.squeeze += weights.resistance * physics.contact->normal_damping;
    add_scaled(coupling, weights.stiffness, contact_stiffness(*physics.contact, kind, shape));
  }
  return coupling;
}

Vector3 vector_at(const std::vector<double>& rows, std::size_t row) {
  return {rows[row], rows[row + 1], rows[row + 2]};
}

void add_at(std::vector<double>& rows, std::size_t row, const Vector3& v) {
  rows[row] += v.x;
  rows[row + 1] += v.y;
  rows[row + 2] += v.z;
}

}  // namespace

PackingMatrix::PackingMatrix(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                             const MatrixWeights& weights) {
  const ParticleState& particles = system.particles;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i], mass = particles.mass[i], inertia = particles.inertia[i];
    spheres_.push_back({1 / std::sqrt(mass), 1 / std::sqrt(inertia),
                        weights.resistance * translational_drag(physics.viscosity, radius) / mass,
                        weights.resistance * rotational_drag(physics.viscosity, radius) / inertia});
  }
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  for (const Pair& pair : system.list.pairs()) {
    const PairKind& kind = kinds[pair.kind];
    const PairGeometry shape = geometry(separation(particles, pair, frames[pair.image]), kind);
    if (shape.distance <= kind.range) {
      links_.push_back({pair.first, pair.second, shape, coupling_of(physics, kind, shape, weights)});
    }
  }
}

void PackingMatrix::multiply(const std::vector<double>& vector, std::vector<double>& product) const {
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    for (std::size_t row = 6 * i; row < 6 * i + 3; ++row) {
      product[row] = spheres_[i].drag_rate * vector[row];
      product[row + 3] = spheres_[i].rotational_drag_rate * vector[row + 3];
    }
  }
  for (const Link& link : links_) {
    const std::size_t i = 6 * std::size_t{link.first}, j = 6 * std::size_t{link.second};
    const Sphere &first = spheres_[link.first], &second = spheres_[link.second];
    const PairMotion motion = {
        second.per_root_mass * vector_at(vector, j) - first.per_root_mass * vector_at(vector, i),
        first.per_root_inertia * vector_at(vector, i + 3),
        second.per_root_inertia * vector_at(vector, j + 3)};
    const PairLoad load = lubrication_load(link.coupling, link.shape, motion);
    add_at(product, i, -first.per_root_mass * load.force);
    add_at(product, j, second.per_root_mass * load.force);
    add_at(product, i + 3, -first.per_root_inertia * load.torque_first);
    add_at(product, j + 3, -second.per_root_inertia * load.torque_second);
  }
}

}  // namespace peclet::engine
