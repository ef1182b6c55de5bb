// A suspension whose links are assembled and factorised, for the tests of the kernels that do so.
#pragma once

#include <numbers>

#include "engine/kernels/force_field.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/linear_algebra.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {

// Single precision, sums of some ten numbers.
constexpr double single_precision = 2e-6;

constexpr double step = 0.02;
constexpr LinkWeights weights = {.timestep = step, .normal_time = 0.5 * step, .resistance_time = 0};

// Kernels need not start from every particle: rows of all of them, and what belongs to them.
class Links {
 public:
  Links(const Physics& physics, System system, InstructionSet set, const LinkWeights& of_links = weights)
      : kernels_(link_kernels(set)),
        system_(std::move(system)),
        field_(physics, system_.particles, step, seed, 1, set, of_links.normal_time) {
    const ParticleState& particles = system_.particles;
    diagonal_.resize(distinct_radii(particles.radius).size());
    for (std::size_t i = 0; i < particles.count(); ++i) {
      for (int c = 0; c < 3; ++c) {
        Floats& row = diagonal_[particles.size_class[i]].v;
        row[c] = static_cast<float>(particles.mass[i]);
        row[4 + c] = static_cast<float>(particles.inertia[i]);
      }
    }
    order_.arrange(system_.list, particles.count());
    field_.assemble_links(system_, of_links, order_, groups_);
    pivots_.resize(particles.count());
    kernels_.factorise(view(), pivots_.data());
  }

  LinkSystem view() const {
    return {.particles = system_.particles.count(),
            .particle = order_.particle().data(),
            .size_class = system_.particles.size_class.data(),
            .diagonal = diagonal_.data(),
            .levels = order_.levels().data(),
            .count_of_levels = order_.levels().size(),
            .groups = groups_.data(),
            .pivots = pivots_.data()};
  }
  const LinkOrder& order() const { return order_; }
  const LinkKernels& kernels() const { return kernels_; }
  const System& system() const { return system_; }

  // Both in the order of particles.
  std::vector<MotionRow> times(const std::vector<MotionRow>& vector) const {
    std::vector<MotionRow> rows(vector.size()), product(vector.size()), result(vector.size());
    for (std::size_t row = 0; row < vector.size(); ++row) {
      rows[row] = vector[order_.particle()[row]];
    }
    kernels_.multiply(view(), rows.data(), product.data());
    for (std::size_t row = 0; row < vector.size(); ++row) {
      result[order_.particle()[row]] = product[row];
    }
    return result;
  }

  // Loads at the present velocities plus `change`, drag excepted.
  std::vector<double> loads(const std::vector<MotionRow>& change, double scale) {
    System moved = system_;
    for (std::size_t i = 0; i < change.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        moved.particles.velocity.row(i)[c] += scale * static_cast<double>(change[i].v[c]);
        moved.particles.angular_velocity.row(i)[c] += scale * static_cast<double>(change[i].v[4 + c]);
      }
    }
    VectorField force(change.size()), torque(change.size());
    field_.evaluate(moved, force, torque);
    const Physics& physics = field_.physics();
    std::vector<double> result;
    for (std::size_t i = 0; i < change.size(); ++i) {
      const double a = moved.particles.radius[i], pi = std::numbers::pi;
      const Vector3 streaming = {physics.flow.rate() * moved.particles.position[i].y, 0, 0};
      const Vector3 f = force[i] - 6 * pi * physics.viscosity * a * (streaming - moved.particles.velocity[i]);
      const Vector3 t =
          torque[i] - 8 * pi * physics.viscosity * a * a * a *
                          (Vector3{0, 0, -0.5 * physics.flow.rate()} - moved.particles.angular_velocity[i]);
      result.insert(result.end(), {f.x, f.y, f.z, t.x, t.y, t.z});
    }
    return result;
  }

 private:
  const LinkKernels& kernels_;
  System system_;
  ForceField field_;
  std::vector<MotionRow> diagonal_;
  std::vector<Pivot> pivots_;
  LinkOrder order_;
  std::vector<LinkGroup> groups_;
};

inline std::vector<MotionRow> random_rows(std::size_t count, std::uint64_t from) {
  Draws draws(from);
  std::vector<MotionRow> rows(count);
  for (MotionRow& row : rows) {
    const Vector3 u = draws.vector(), w = draws.vector();
    row.v = Floats{static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z), 0,
                   static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z), 0};
  }
  return rows;
}

// Where a row has numbers: the fourth and the eighth are always zero.
constexpr std::array<int, 6> of_a_motion = {0, 1, 2, 4, 5, 6};

inline Eigen::Vector<double, 8> entries(const MotionRow& row) {
  return Eigen::Map<const Eigen::Vector<float, 8>>(reinterpret_cast<const float*>(&row.v)).cast<double>();
}

inline std::vector<double> numbers(const std::vector<MotionRow>& rows) {
  std::vector<double> result;
  for (const MotionRow& row : rows) {
    for (const int c : of_a_motion) {
      result.push_back(static_cast<double>(row.v[c]));
    }
  }
  return result;
}

inline std::vector<InstructionSet> available_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace peclet::engine
