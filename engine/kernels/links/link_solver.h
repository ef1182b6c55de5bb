// The bodies of the loops that apply and solve a system of links. Eight links side by side, or the eight
// numbers of one particle.
//
// Everything is static: nothing that is compiled for one processor may be linked into a program that runs on
// another.
#pragma once

#include "engine/kernels/bodies/streaming.h"
#include "engine/kernels/links/link_motions.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

PECLET_ALWAYS_INLINE double sum_of(const Floats& v) {
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    sum += static_cast<double>(v[k]);
  }
  return sum;
}

// Sums of many single-precision numbers: those of some rows are added up before they count as doubles.
constexpr std::size_t rows_per_sum = 128;

// Calls body(i, sum) for each i of [begin, end), and returns the sum of all lanes. Four sums side by side, so
// that none waits for the one before.
template <class Body>
PECLET_ALWAYS_INLINE double summed(std::size_t begin, std::size_t end, Body&& body) {
  double total = 0;
  for (std::size_t part = begin; part < end; part += rows_per_sum) {
    const std::size_t part_end = part + rows_per_sum < end ? part + rows_per_sum : end;
    Floats sum[4]{};
    std::size_t i = part;
    for (; i + 4 <= part_end; i += 4) {
      for (std::size_t k = 0; k < 4; ++k) {
        body(i + k, sum[k]);
      }
    }
    for (; i < part_end; ++i) {
      body(i, sum[0]);
    }
    total += sum_of((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }
  return total;
}

PECLET_ALWAYS_INLINE PairResistanceOf<EightFloats> coupling_of(const LinkGroup& group) {
  return {
      .squeeze = group.squeeze,
      .shear = group.shear,
      .pump_first = group.pump_first,
      .pump_second = group.pump_second,
      .twist_first = group.twist_first,
      .twist_cross = group.twist_cross,
      .twist_second = group.twist_second,
  };
}

PECLET_ALWAYS_INLINE Vector3Of<EightFloats> normal_of(const LinkGroup& group) {
  return {group.normal[0], group.normal[1], group.normal[2]};
}

// Calls body(group) for the groups of a level.
template <class Body>
PECLET_ALWAYS_INLINE void for_each_group(const LinkSystem& system, const LinkLevel& level, Body&& body) {
  const LinkGroup* const begin = system.groups + level.groups_begin;
  for (const LinkGroup* group = begin; group < begin + level.count_of_groups; ++group) {
    body(*group);
  }
}

// The loads of eight links on their particles at these motions.
PECLET_ALWAYS_INLINE PairLoadOf<EightFloats> load_of(const LinkGroup& group, const FloatMotions& i,
                                                     const FloatMotions& j) {
  PairGeometryOf<EightFloats> pair{};  // of which the load depends on the normal alone
  pair.normal = normal_of(group);
  const PairMotionOf<EightFloats> motion = {j.velocity - i.velocity, i.spin, j.spin};
  return lubrication_load(coupling_of(group), pair, motion);
}

PECLET_ALWAYS_INLINE const Floats& diagonal_of(const LinkSystem& system, std::size_t row) {
  return system.diagonal[system.size_class[system.particle[row]]].v;
}

void multiply(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    product[i].v = diagonal_of(system, i) * vector[i].v;
  }
  for (std::size_t l = 0; l < system.count_of_levels; ++l) {
    for_each_group(system, system.levels[l], [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
      const PairLoadOf<EightFloats> load =
          load_of(group, gather_motions(vector, group.first), gather_motions(vector, group.second));
      add_motions(product, group.first, {-load.force, -load.torque_first});
      add_motions(product, group.second, {load.force, -load.torque_second});
    });
  }
}

// The row of a particle in a field of vectors.
PECLET_ALWAYS_INLINE const Row& vector_row(const double* rows, std::size_t i) {
  return reinterpret_cast<const Row*>(rows)[i];
}

typedef float FourFloats __attribute__((vector_size(16)));
typedef int FourIntegers __attribute__((vector_size(16)));

PECLET_ALWAYS_INLINE void set_motion(MotionRow& to, const Row& velocity, const Row& spin) {
  reinterpret_cast<FourFloats*>(&to)[0] = __builtin_convertvector(velocity, FourFloats);
  reinterpret_cast<FourFloats*>(&to)[1] = __builtin_convertvector(spin, FourFloats);
}

void set_residual(const LinkSystem& system, const StepRows& step, MotionRow* residual) {
  for (std::size_t row = 0; row < system.particles; ++row) {
    const std::size_t i = system.particle[row];
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    Row force = vector_row(step.force, i), torque = vector_row(step.torque, i);
    if (step.noise_force != nullptr) {
      force += vector_row(step.noise_force, i);
      torque += vector_row(step.noise_torque, i);
    }
    const Row slowed = vector_row(step.velocity_before, i) - vector_row(step.velocity, i);
    const Row unspun = vector_row(step.spin_before, i) - vector_row(step.spin, i);
    set_motion(residual[row], inertia.translational * slowed + step.timestep * force,
               inertia.rotational * unspun + step.timestep * torque);
  }
}

// Motions relative to the flow; returns the sums of m u u + I w w.
template <bool is_simple_shear>
Row set_motions(const LinkSystem& system, const StepRows& step, MotionRow* motion) {
  const Row& spin = streaming_spin(step.flow);
  Row inertial{};
  for (std::size_t row = 0; row < system.particles; ++row) {
    const std::size_t i = system.particle[row];
    Row streaming;
    set_streaming<is_simple_shear>(step.flow, vector_row(step.position, i), streaming);
    Row u = vector_row(step.velocity, i) - streaming, w = vector_row(step.spin, i) - spin;
    if (step.varying_velocity != nullptr) {
      u -= vector_row(step.varying_velocity, i);
      w -= vector_row(step.varying_spin, i);
    }
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    inertial += inertia.translational * u * u + inertia.rotational * w * w;
    set_motion(motion[row], u, w);
  }
  return inertial;
}

// What links and D dissipate.
SquaredMotion squared_motion(const LinkSystem& system, const StepRows& step, MotionRow* motion) {
  const Row inertial = step.flow.is_simple_shear ? set_motions<true>(system, step, motion)
                                                 : set_motions<false>(system, step, motion);
  double whole = summed(0, system.particles, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
    sum += diagonal_of(system, i) * motion[i].v * motion[i].v;
  });
  for (std::size_t l = 0; l < system.count_of_levels; ++l) {
    const LinkLevel& level = system.levels[l];
    const LinkGroup* const groups = system.groups + level.groups_begin;
    whole += summed(0, level.count_of_groups, [&](std::size_t g, Floats& sum) PECLET_INLINE_LAMBDA {
      const FloatMotions i = gather_motions(motion, groups[g].first),
                         j = gather_motions(motion, groups[g].second);
      const PairLoadOf<EightFloats> load = load_of(groups[g], i, j);
      sum += (dot(load.force, j.velocity - i.velocity) - dot(load.torque_first, i.spin) -
              dot(load.torque_second, j.spin))
                 .v;
    });
  }
  return {whole, inertial[0] + inertial[1] + inertial[2]};
}

void add_motion(const LinkSystem& system, const MotionRow* motion, double* velocity, double* spin) {
  for (std::size_t row = 0; row < system.particles; ++row) {
    const std::size_t i = system.particle[row];
    const FourFloats* const halves = reinterpret_cast<const FourFloats*>(motion + row);
    reinterpret_cast<Row*>(velocity)[i] += __builtin_convertvector(halves[0], Row);
    reinterpret_cast<Row*>(spin)[i] += __builtin_convertvector(halves[1], Row);
  }
}

typedef int EightIntegers __attribute__((vector_size(32)));

// P^-1 r of one row, see Pivot: with r = (f, g) the halves a f + b g and b^T f + c g.
PECLET_ALWAYS_INLINE Floats over_pivot(const Pivot& pivot, const Floats& r) {
  constexpr EightIntegers halves_changed = {4, 5, 6, 7, 0, 1, 2, 3};
  // Of both halves alike.
  const auto xxy = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{0, 0, 1, 3, 4, 4, 5, 7});
  };
  const auto yxx = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{1, 0, 0, 3, 5, 4, 4, 7});
  };
  const auto yzz = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{1, 2, 2, 3, 5, 6, 6, 7});
  };
  const auto zzy = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{2, 2, 1, 3, 6, 6, 5, 7});
  };
  const auto yzx = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{1, 2, 0, 3, 5, 6, 4, 7});
  };
  const auto zxy = [](const Floats& v) {
    return __builtin_shuffle(v, EightIntegers{2, 0, 1, 3, 6, 4, 5, 7});
  };
  const Floats &beside = pivot.rows[1].v, &across = pivot.rows[3].v;
  const Floats other = __builtin_shuffle(r, halves_changed);
  const Floats even = pivot.rows[0].v * r + xxy(beside) * yxx(r) + yzz(beside) * zzy(r);
  const Floats odd = pivot.rows[2].v * other + across * yzx(other) +
                     zxy(__builtin_shuffle(across, halves_changed)) * zxy(other);
  return even + odd;
}

// K t of one row.
PECLET_ALWAYS_INLINE Floats squeezed(const Pivot& pivot, const Floats& t) {
  const Floats four =
      __builtin_shuffle(pivot.rows[0].v, pivot.rows[1].v, EightIntegers{3, 3, 11, 11, 7, 7, 15, 15});
  const Floats six = __builtin_shuffle(four, pivot.rows[2].v, EightIntegers{0, 2, 11, 11, 4, 6, 15, 15});
  const FourFloats v = __builtin_shufflevector(t, t, 0, 1, 2, 3);
  const FourFloats diagonal = __builtin_shufflevector(six, six, 0, 1, 2, 3);
  const FourFloats beside = __builtin_shufflevector(six, six, 4, 5, 6, 7);
  const FourFloats sum =
      diagonal * v +
      __builtin_shuffle(beside, FourIntegers{0, 0, 1, 3}) * __builtin_shuffle(v, FourIntegers{1, 0, 0, 3}) +
      __builtin_shuffle(beside, FourIntegers{1, 2, 2, 3}) * __builtin_shuffle(v, FourIntegers{2, 2, 1, 3});
  return __builtin_shufflevector(sum, FourFloats{}, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Adds to the rows of a level what the vector of earlier rows does to them: -L vector.
PECLET_ALWAYS_INLINE void pull(const LinkSystem& system, const LinkLevel& level, const MotionRow* vector,
                               MotionRow* loads) {
  for_each_group(system, level, [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
    const FloatMotions j = gather_motions(vector, group.second);
    const auto load = load_on_first(coupling_of(group), normal_of(group), j.velocity, j.spin);
    add_motions(loads, group.first, {load.force, load.torque});
  });
}

// Adds to earlier rows what the vector of a level's rows does to them: -L^T vector.
PECLET_ALWAYS_INLINE void push(const LinkSystem& system, const LinkLevel& level, const MotionRow* vector,
                               MotionRow* loads) {
  for_each_group(system, level, [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
    const FloatMotions i = gather_motions(vector, group.first);
    const auto load = load_on_second(coupling_of(group), normal_of(group), i.velocity, i.spin);
    add_motions(loads, group.second, {load.force, load.torque});
  });
}

// residual = (P + L)^-1 right, weighted = P residual.
double begin(const LinkSystem& system, const SolverRows& rows) {
  MotionRow *const r = rows.residual, *const z = rows.weighted;
  for (std::size_t i = 0; i < system.particles; ++i) {
    z[i].v = rows.solution[i].v;
  }
  double squared = 0;
  for (std::size_t l = 0; l < system.count_of_levels; ++l) {
    const LinkLevel& level = system.levels[l];
    pull(system, level, r, z);
    squared += summed(level.rows_begin, level.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
      r[i].v = over_pivot(system.pivots[i], z[i].v);
      sum += r[i].v * z[i].v;
    });
  }
  return squared;
}

// Conjugate gradients for
//   A^ = (P + L)^-1 A (P + L^T)^-1   with the preconditioner P^-1,
// which are those for A with C. With t = (P + L^T)^-1 p (Eisenstat 1981, SIAM J. Sci. Stat. Comput. 2, 1)
//   A^ p = t + y,   (P + L) y = p + (K - P) t = K t + L^T t,
// a product costs what A itself would, and not C^-1 as well. Rows: r of A^, z = P r, p, t, y; `loads` is
// -L^T t, later P (t + y) = p + K t - L y.
SolverReport solve(const LinkSystem& system, const SolverRows& rows, double squared_residual, double target,
                   int most_iterations) {
  const std::size_t count = system.particles;
  MotionRow *const x = rows.solution, *const r = rows.residual, *const z = rows.weighted,
                   *const p = rows.direction, *const t = rows.ahead, *const y = rows.moved,
                   *const s = rows.loads;
  SolverReport report{0, squared_residual};
  for (std::size_t i = 0; i < count; ++i) {
    x[i].v = p[i].v = s[i].v = Floats{};
  }
  float beta = 0;
  while (report.squared_residual > target && report.iterations < most_iterations) {
    for (std::size_t l = system.count_of_levels; l-- > 0;) {
      const LinkLevel& level = system.levels[l];
      for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) {
        p[i].v = z[i].v + beta * p[i].v;
        t[i].v = over_pivot(system.pivots[i], p[i].v + s[i].v);
      }
      push(system, level, t, s);
    }
    double curvature = 0;
    for (std::size_t l = 0; l < system.count_of_levels; ++l) {
      const LinkLevel& level = system.levels[l];
      for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) {
        y[i].v = Floats{};
      }
      pull(system, level, y, y);
      curvature +=
          summed(level.rows_begin, level.rows_end, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
            const Pivot& pivot = system.pivots[i];
            const Floats load = squeezed(pivot, t[i].v) + y[i].v;
            y[i].v = over_pivot(pivot, load - s[i].v);
            s[i].v = p[i].v + load;
            sum += p[i].v * (t[i].v + y[i].v);
          });
    }
    const auto alpha = static_cast<float>(report.squared_residual / curvature);
    const double squared = summed(0, count, [&](std::size_t i, Floats& sum) PECLET_INLINE_LAMBDA {
      x[i].v += alpha * t[i].v;
      r[i].v -= alpha * (t[i].v + y[i].v);
      z[i].v -= alpha * s[i].v;
      s[i].v = Floats{};
      sum += r[i].v * z[i].v;
    });
    beta = static_cast<float>(squared / report.squared_residual);
    report.squared_residual = squared;
    ++report.iterations;
  }
  return report;
}

}  // namespace
}  // namespace peclet::engine
