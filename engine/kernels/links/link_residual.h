// What the equations of a step leave, and the motion that it is measured by.
//
// Everything is static: nothing that is compiled for one processor may be linked into a program that runs on
// another.
#pragma once

#include "engine/kernels/bodies/streaming.h"
#include "engine/kernels/links/link_sweeps.h"

namespace peclet::engine {
namespace {

// The loads of eight links on their particles at these motions.
PECLET_ALWAYS_INLINE PairLoadOf<EightFloats> load_of(const LinkGroup& group, const FloatMotions& i,
                                                     const FloatMotions& j) {
  PairGeometryOf<EightFloats> pair{};  // of which the load depends on the normal alone
  pair.normal = normal_of(group);
  const PairMotionOf<EightFloats> motion = {j.velocity - i.velocity, i.spin, j.spin};
  return lubrication_load(coupling_of(group), pair, motion);
}

// Of a particle.
PECLET_ALWAYS_INLINE const Floats& diagonal_of(const LinkSystem& system, std::size_t i) {
  return system.diagonal[system.size_class[i]].v;
}

void multiply(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    product[system.row[i]].v = diagonal_of(system, i) * vector[system.row[i]].v;
  }
  const auto add = [&](const GroupRange& groups) PECLET_INLINE_LAMBDA {
    for (const LinkGroup* group = groups.begin; group < groups.end; ++group) {
      const PairLoadOf<EightFloats> load =
          load_of(*group, gather_motions(vector, group->first), gather_motions(vector, group->second));
      add_motions(product, group->first, {-load.force, -load.torque_first});
      add_motions(product, group->second, {load.force, -load.torque_second});
    }
  };
  for_each_level(system, system.blocks[0].levels_begin, system.blocks[system.count_of_blocks - 1].levels_end,
                 add);
}

// Calls body(i) for the particles of a block, in their order in memory: their fields are larger than a row.
template <class Body>
PECLET_ALWAYS_INLINE void for_each_particle(const LinkBlock& block, Body&& body) {
  for_each_row(block, body);  // the same numbers, in another order
}

// The row of a particle in a field of vectors.
PECLET_ALWAYS_INLINE const Row& vector_row(const double* rows, std::size_t i) {
  return reinterpret_cast<const Row*>(rows)[i];
}

#ifndef PECLET_FLOATS
typedef float FourFloats __attribute__((vector_size(16)));
#endif

PECLET_ALWAYS_INLINE void set_motion(MotionRow& to, const Row& velocity, const Row& spin) {
  reinterpret_cast<FourFloats*>(&to)[0] = __builtin_convertvector(velocity, FourFloats);
  reinterpret_cast<FourFloats*>(&to)[1] = __builtin_convertvector(spin, FourFloats);
}

void set_residual(const LinkSystem& system, const StepRows& step, MotionRow* residual, Team& team) {
  const auto set = [&](std::size_t i) PECLET_INLINE_LAMBDA {
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    Row force = vector_row(step.force, i), torque = vector_row(step.torque, i);
    if (step.noise_force != nullptr) {
      force += vector_row(step.noise_force, i);
      torque += vector_row(step.noise_torque, i);
    }
    const Row slowed = vector_row(step.velocity_before, i) - vector_row(step.velocity, i);
    const Row unspun = vector_row(step.spin_before, i) - vector_row(step.spin, i);
    set_motion(residual[system.row[i]], inertia.translational * slowed + step.timestep * force,
               inertia.rotational * unspun + step.timestep * torque);
  };
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
    for_each_particle(block, set);
  });
}

// Motions relative to the flow; returns the sums of m u u + I w w.
template <bool is_simple_shear>
Row set_motions(const LinkSystem& system, const StepRows& step, const LinkBlock& block, MotionRow* motion) {
  const Row& spin = streaming_spin(step.flow);
  Row inertial{};
  for_each_particle(block, [&](std::size_t i) PECLET_INLINE_LAMBDA {
    Row streaming;
    set_streaming<is_simple_shear>(step.flow, vector_row(step.position, i), streaming);
    Row u = vector_row(step.velocity, i) - streaming, w = vector_row(step.spin, i) - spin;
    if (step.varying_velocity != nullptr) {
      u -= vector_row(step.varying_velocity, i);
      w -= vector_row(step.varying_spin, i);
    }
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    inertial += inertia.translational * u * u + inertia.rotational * w * w;
    set_motion(motion[system.row[i]], u, w);
  });
  return inertial;
}

// What links and D dissipate.
SquaredMotion squared_motion(const LinkSystem& system, const StepRows& step, MotionRow* motion, Team& team) {
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
    const Row sums = step.flow.is_simple_shear ? set_motions<true>(system, step, block, motion)
                                               : set_motions<false>(system, step, block, motion);
    system.sums[b].inertial = sums[0] + sums[1] + sums[2];
    system.sums[b].whole =
        summed(block.rows_begin, block.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
          const Floats& v = motion[system.row[i]].v;
          sum += diagonal_of(system, i) * v * v;
        });
  });
  team.meet();
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
    const auto add = [&](const GroupRange& groups) PECLET_INLINE_LAMBDA {
      const auto count = static_cast<std::size_t>(groups.end - groups.begin);
      system.sums[b].whole += summed(0, count, [&](std::size_t g, Floats& sum) PECLET_INLINE_LAMBDA {
        const LinkGroup& group = groups.begin[g];
        fetch(&group + groups_ahead);
        const FloatMotions i = gather_motions(motion, group.first), j = gather_motions(motion, group.second);
        const PairLoadOf<EightFloats> load = load_of(group, i, j);
        sum += (dot(load.force, j.velocity - i.velocity) - dot(load.torque_first, i.spin) -
                dot(load.torque_second, j.spin))
                   .v;
      });
    };
    for_each_level(system, block.levels_begin, block.levels_end, add);
  });
  return {total(system, team, &LinkSums::whole), total(system, team, &LinkSums::inertial)};
}

void add_motion(const LinkSystem& system, const MotionRow* motion, double* velocity, double* spin,
                Team& team) {
  const auto add = [&](std::size_t i) PECLET_INLINE_LAMBDA {
    const FourFloats* const halves = reinterpret_cast<const FourFloats*>(motion + system.row[i]);
    reinterpret_cast<Row*>(velocity)[i] += __builtin_convertvector(halves[0], Row);
    reinterpret_cast<Row*>(spin)[i] += __builtin_convertvector(halves[1], Row);
  };
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
    for_each_particle(block, add);
  });
}

}  // namespace
}  // namespace peclet::engine
