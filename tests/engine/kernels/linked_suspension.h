// A suspension with assembled and factorised links, for tests of the kernels.
#pragma once

#include <numbers>
#include <span>

#include "engine/kernels/force_field.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/linear_algebra.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {

// Single precision, for sums of about ten numbers.
constexpr double single_precision = 2e-6;

constexpr double step = 0.02;
constexpr LinkWeights weights = {.timestep = step, .normal_time = 0.5 * step};

// The links of a suspension, with what belongs to them.
class Links {
 public:
  Links(const Physics& physics, System system, InstructionSet set, const LinkWeights& of_links = weights,
        StepResistance::Part part = StepResistance::Part::whole)
      : kernels_(link_kernels(set)),
        system_(std::move(system)),
        field_(physics, system_.particles, step, seed, 1, set, of_links.normal_time, part) {
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
    const ForceField::AssembleLinks assemble = field_.assemble_links(system_, of_links, order_, groups_);
    for (std::size_t block = 0; block < order_.blocks().size(); ++block) assemble(block);
    pivots_.resize(particles.count());
    aside_.resize(std::size_t{rows_of_block} * links_per_group * order_.crossing_groups());
    sums_.resize(order_.blocks().size());
    Team alone;
    kernels_.factorise(view(), pivots_.data(), alone);
  }

  LinkSystem view() const {
    return {.particles = system_.particles.count(),
            .row = order_.row().data(),
            .size_class = system_.particles.size_class.data(),
            .diagonal = diagonal_.data(),
            .blocks = order_.blocks().data(),
            .count_of_blocks = order_.blocks().size(),
            .levels = order_.levels().data(),
            .boundary_levels = order_.boundary_levels(),
            .groups = groups_.data(),
            .incoming = order_.incoming().data(),
            .pivots = pivots_.data(),
            .aside = aside_.data(),
            .crossing_begin = order_.inner_groups(),
            .sums = sums_.data()};
  }
  const LinkOrder& order() const { return order_; }
  const LinkKernels& kernels() const { return kernels_; }
  const System& system() const { return system_; }

  // Returns A times `vector`, both in the order of particles.
  std::vector<MotionRow> times(const std::vector<MotionRow>& vector) const {
    std::vector<MotionRow> rows(vector.size()), product(vector.size()), result(vector.size());
    for (std::size_t i = 0; i < vector.size(); ++i) rows[order_.row()[i]] = vector[i];
    kernels_.multiply(view(), rows.data(), product.data());
    for (std::size_t i = 0; i < vector.size(); ++i) result[i] = product[order_.row()[i]];
    return result;
  }

  // Returns the loads at the current velocities plus `scale` times `change`, without drag.
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
  mutable std::vector<MotionRow> aside_;
  mutable std::vector<LinkSums> sums_;
  LinkOrder order_;
  std::vector<LinkGroup> groups_;
};

inline MotionRow motion_row(const Vector3& u, const Vector3& w) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {Floats{f(u.x), f(u.y), f(u.z), 0, f(w.x), f(w.y), f(w.z), 0}};
}

inline std::vector<MotionRow> random_rows(std::size_t count, std::uint64_t from) {
  Draws draws(from);
  std::vector<MotionRow> rows(count);
  for (MotionRow& row : rows) {
    const Vector3 u = draws.vector(), w = draws.vector();
    row = motion_row(u, w);
  }
  return rows;
}

// The used places of a row: the fourth and the eighth are always zero.
constexpr std::array<int, 6> of_a_motion = {0, 1, 2, 4, 5, 6};

inline Eigen::Vector<double, 8> entries(const MotionRow& row) {
  return Eigen::Map<const Eigen::Vector<float, 8>>(reinterpret_cast<const float*>(&row.v)).cast<double>();
}

inline std::vector<double> numbers(const std::vector<MotionRow>& rows) {
  std::vector<double> result;
  for (const MotionRow& row : rows) {
    for (const int c : of_a_motion) result.push_back(static_cast<double>(row.v[c]));
  }
  return result;
}

// Returns the groups in the order of rows: the interior of every block, then the boundary, by level.
inline std::vector<LinkGroup> groups_in_order(const LinkSystem& system) {
  std::vector<LinkGroup> groups;
  const auto add = [&](std::uint32_t level) {
    const LinkLevel& of = system.levels[level];
    const std::uint32_t crossing = (of.count_of_crossing + links_per_group - 1) / links_per_group;
    groups.insert(groups.end(), system.groups + of.groups_begin,
                  system.groups + of.groups_begin + of.count_of_groups);
    groups.insert(groups.end(), system.groups + of.crossing_begin,
                  system.groups + of.crossing_begin + crossing);
  };
  const std::span blocks(system.blocks, system.count_of_blocks);
  for (const LinkBlock& block : blocks) {
    for (std::uint32_t l = block.levels_begin; l < block.boundary_begin; ++l) add(l);
  }
  for (std::uint32_t l = 0; l < system.boundary_levels; ++l) {
    for (const LinkBlock& block : blocks) add(block.boundary_begin + l);
  }
  return groups;
}

// Returns the inverse of the pivot, see link_kernels.h.
inline Eigen::Matrix<double, 6, 6> inverse_of(const Pivot& pivot) {
  const auto at = [&](int row, int place) { return static_cast<double>(pivot.rows[row].v[place]); };
  Eigen::Matrix<double, 6, 6> inverse;
  for (const Eigen::Index half : {0, 1}) {
    Eigen::Matrix3d own;
    const int k = 4 * static_cast<int>(half);
    own << at(0, k), at(1, k), at(1, k + 1), at(1, k), at(0, k + 1), at(1, k + 2), at(1, k + 1), at(1, k + 2),
        at(0, k + 2);
    inverse.block<3, 3>(3 * half, 3 * half) = own;
  }
  Eigen::Matrix3d across;
  across << at(2, 0), at(3, 0), at(3, 6), at(3, 4), at(2, 1), at(3, 1), at(3, 2), at(3, 5), at(2, 2);
  inverse.topRightCorner<3, 3>() = across;
  inverse.bottomLeftCorner<3, 3>() = across.transpose();
  return inverse;
}

inline Eigen::Vector3d normal_of(const LinkGroup& group, int k) {
  const auto at = [&](int c) { return static_cast<double>(group.normal[c][k]); };
  return {at(0), at(1), at(2)};
}

// Rows filled with NaN: their initial content must have no effect.
struct SolverStorage {
  explicit SolverStorage(std::size_t count)
      : of(7, std::vector<MotionRow>(count, MotionRow{Floats{} / 0.0F})) {}
  SolverRows view() {
    return {of[0].data(), of[1].data(), of[2].data(), of[3].data(), of[4].data(), of[5].data(), of[6].data()};
  }

  std::vector<std::vector<MotionRow>> of;
};

}  // namespace peclet::engine
