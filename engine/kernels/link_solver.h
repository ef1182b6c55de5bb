// Computes the residual of a step and solves a factorised system of links by conjugate gradients.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/kernels/link_sweeps.h"
#include "engine/kernels/streaming.h"

namespace peclet::engine {
namespace {

// Returns the loads of eight links on their particles at these motions.
PECLET_ALWAYS_INLINE PairLoadOf<EightFloats> load_of(const LinkGroup& group, const FloatMotions& i,
                                                     const FloatMotions& j) {
  PairGeometryOf<EightFloats> pair{};  // the load depends on its normal alone
  pair.normal = normal_of(group);
  const PairMotionOf<EightFloats> motion = {j.velocity - i.velocity, i.spin, j.spin};
  return lubrication_load(coupling_of(group), pair, motion);
}

// Returns D of a particle.
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

// Calls body(i) for the particles of a block in the order of their fields, which are larger than rows.
template <class Body>
PECLET_ALWAYS_INLINE void for_each_particle(const LinkBlock& block, Body&& body) {
  for_each_row(block, body);  // rows and particles of a block have the same numbers
}

// Returns the row of a particle in a field of vectors.
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

// Sets motions relative to the flow; returns the sums of m u u + I w w by component.
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

// Adds up v.D v and v.load of the links.
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

// Returns the numbers with the first three of both halves in this order.
template <int a, int b, int c>
PECLET_ALWAYS_INLINE Floats arranged(const Floats& v) {
#ifdef __AVX2__
  return __builtin_shufflevector(v, v, a, b, c, 3, 4 + a, 4 + b, 4 + c, 7);
#else
  Floats result;
  for (int half = 0; half < 2; ++half) {
    const FourFloats& from = reinterpret_cast<const FourFloats*>(&v)[half];
    reinterpret_cast<FourFloats*>(&result)[half] = __builtin_shufflevector(from, from, a, b, c, 3);
  }
  return result;
#endif
}

PECLET_ALWAYS_INLINE Floats with_halves_changed(const Floats& v) {
#ifdef __AVX2__
  return __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
#else
  Floats result;
  for (int half = 0; half < 2; ++half) {
    reinterpret_cast<FourFloats*>(&result)[half] = reinterpret_cast<const FourFloats*>(&v)[1 - half];
  }
  return result;
#endif
}

// Returns P^-1 r of one row (see Pivot): with r = (f, g) its halves are a f + b g and b^T f + c g.
PECLET_ALWAYS_INLINE Floats over_pivot(const Pivot& pivot, const Floats& r) {
  const Floats &beside = pivot.rows[1].v, &across = pivot.rows[3].v;
  const Floats other = with_halves_changed(r);
  const Floats even = pivot.rows[0].v * r + arranged<0, 0, 1>(beside) * arranged<1, 0, 0>(r) +
                      arranged<1, 2, 2>(beside) * arranged<2, 2, 1>(r);
  const Floats odd = pivot.rows[2].v * other + across * arranged<1, 2, 0>(other) +
                     arranged<2, 0, 1>(with_halves_changed(across)) * arranged<2, 0, 1>(other);
  return even + odd;
}

// Returns K t of one row, which has a velocity alone.
PECLET_ALWAYS_INLINE Floats squeezed(const Pivot& pivot, const Floats& t) {
  const Floats fourth = __builtin_shufflevector(pivot.rows[0].v, pivot.rows[1].v, 2, 10, 3, 11, 6, 14, 7, 15);
  const Floats k = __builtin_shufflevector(fourth, pivot.rows[2].v, 2, 3, 11, 11, 6, 7, 15, 15);
  const FourFloats diagonal = __builtin_shufflevector(k, k, 0, 1, 2, 3),
                   beside = __builtin_shufflevector(k, k, 4, 5, 6, 7),
                   v = __builtin_shufflevector(t, t, 0, 1, 2, 3);
  const FourFloats sum =
      diagonal * v +
      __builtin_shufflevector(beside, beside, 0, 0, 1, 3) * __builtin_shufflevector(v, v, 1, 0, 0, 3) +
      __builtin_shufflevector(beside, beside, 1, 2, 2, 3) * __builtin_shufflevector(v, v, 2, 2, 1, 3);
  return __builtin_shufflevector(sum, FourFloats{}, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Sets residual = (P + L)^-1 b and weighted = P residual.
double begin(const LinkSystem& system, const SolverRows& rows, Team& team) {
  MotionRow *const r = rows.residual, *const z = rows.weighted;
  climb(
      system, team,
      [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
        system.sums[b].begun = 0;
        for_each_row(block, [&](std::size_t i) PECLET_INLINE_LAMBDA { z[i].v = rows.solution[i].v; });
      },
      [&](const LinkLevel& level) PECLET_INLINE_LAMBDA {
        // Links that fill up a group read these rows.
        for_each_row(level, [&](std::size_t i) PECLET_INLINE_LAMBDA { r[i].v = Floats{}; });
      },
      [&](const GroupRange& groups) PECLET_INLINE_LAMBDA { pull(groups, r, z); },
      [&](const LinkLevel& level, std::size_t b) PECLET_INLINE_LAMBDA {
        system.sums[b].begun +=
            summed(level.rows_begin, level.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
              fetch(system.pivots + i + rows_ahead);
              r[i].v = over_pivot(system.pivots[i], z[i].v);
              sum += r[i].v * z[i].v;
            });
      });
  return total(system, team, &LinkSums::begun);
}

// Runs conjugate gradients for
//   A^ = (P + L)^-1 A (P + L^T)^-1
// with the preconditioner P^-1, which is equivalent to A with C. With t = (P + L^T)^-1 p and
//   A^ p = t + y,   (P + L) y = p + (K - P) t = K t + L^T t
// an iteration costs no more than a product with A (Eisenstat 1981, SIAM J. Sci. Stat. Comput. 2, 1). Rows:
// residual r of A^, z = P r, p, t, y; `loads` is -L^T t, later P (t + y) = p + K t - L y.
//
// The boundary comes first on the way down the levels and last on the way up: between the two, a block's
// interior stays in the cache.
SolverReport solve(const LinkSystem& system, const SolverRows& rows, double squared_residual, double target,
                   int most_iterations, Team& team) {
  MotionRow *const x = rows.solution, *const r = rows.residual, *const z = rows.weighted,
                   *const p = rows.direction, *const t = rows.ahead, *const y = rows.moved,
                   *const s = rows.loads;
  SolverReport report{0, squared_residual};
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
    for_each_row(block, [&](std::size_t i) PECLET_INLINE_LAMBDA { x[i].v = p[i].v = s[i].v = Floats{}; });
  });
  float beta = 0;
  const auto descend = [&](const LinkLevel& level) PECLET_INLINE_LAMBDA {
    for_each_row(level, [&](std::size_t i) PECLET_INLINE_LAMBDA {
      fetch(system.pivots + i + rows_ahead);
      p[i].v = z[i].v + beta * p[i].v;
      t[i].v = over_pivot(system.pivots[i], p[i].v + s[i].v);
    });
  };
  while (report.squared_residual > target && report.iterations < most_iterations) {
    for (std::uint32_t l = system.boundary_levels; l-- > 0;) {
      team.wait();
      for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
        const LinkLevel& level = system.levels[block.boundary_begin + l];
        for_each_incoming(system, level, [&](std::uint32_t row, std::uint32_t crossing) PECLET_INLINE_LAMBDA {
          s[row].v += system.aside[crossing].v;
        });
        descend(level);
        push_aside(system, level, t);
      });
      team.arrive();
      for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
        push(system, system.levels[block.boundary_begin + l], t, s);
      });
    }
    climb(
        system, team,
        [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
          system.sums[b].curvature = 0;
          for (std::uint32_t l = block.boundary_begin; l-- > block.levels_begin;) {
            descend(system.levels[l]);
            push(system, system.levels[l], t, s);
          }
        },
        [&](const LinkLevel& level) PECLET_INLINE_LAMBDA {
          for_each_row(level, [&](std::size_t i) PECLET_INLINE_LAMBDA { y[i].v = Floats{}; });
        },
        [&](const GroupRange& groups) PECLET_INLINE_LAMBDA { pull(groups, y, y); },
        [&](const LinkLevel& level, std::size_t b) PECLET_INLINE_LAMBDA {
          system.sums[b].curvature +=
              summed(level.rows_begin, level.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
                fetch(system.pivots + i + rows_ahead);
                const Pivot& pivot = system.pivots[i];
                const Floats load = squeezed(pivot, t[i].v) + y[i].v;
                y[i].v = over_pivot(pivot, load - s[i].v);
                s[i].v = p[i].v + load;
                sum += p[i].v * (t[i].v + y[i].v);
              });
        });
    const double along = total(system, team, &LinkSums::curvature);
    const auto alpha = static_cast<float>(report.squared_residual / along);
    for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
      system.sums[b].left =
          summed(block.rows_begin, block.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
            x[i].v += alpha * t[i].v;
            r[i].v -= alpha * (t[i].v + y[i].v);
            z[i].v -= alpha * s[i].v;
            s[i].v = Floats{};
            sum += r[i].v * z[i].v;
          });
    });
    const double left = total(system, team, &LinkSums::left);
    beta = static_cast<float>(left / report.squared_residual);
    report.squared_residual = left;
    ++report.iterations;
  }
  return report;
}

}  // namespace
}  // namespace peclet::engine
