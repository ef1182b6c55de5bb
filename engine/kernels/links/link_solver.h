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

// Calls body(i, sum) for each particle, and returns the sum of all lanes.
template <class Body>
PECLET_ALWAYS_INLINE double summed(std::size_t count, Body&& body) {
  double total = 0;
  for (std::size_t begin = 0; begin < count; begin += rows_per_sum) {
    const std::size_t end = begin + rows_per_sum < count ? begin + rows_per_sum : count;
    Floats sum{};
    for (std::size_t i = begin; i < end; ++i) {
      body(i, sum);
    }
    total += sum_of(sum);
  }
  return total;
}

// The opposite of the load of each link.
void add_links(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (const LinkGroup* group = system.groups; group < system.groups + system.count_of_groups; ++group) {
    const FloatMotions i = gather_motions(vector, group->first), j = gather_motions(vector, group->second);
    const PairResistanceOf<EightFloats> coupling = {
        .squeeze = group->squeeze,
        .shear = group->shear,
        .pump_first = group->pump_first,
        .pump_second = group->pump_second,
        .twist_first = group->twist_first,
        .twist_cross = group->twist_cross,
        .twist_second = group->twist_second,
    };
    PairGeometryOf<EightFloats> pair{};  // of which the load depends on the normal alone
    pair.normal = {group->normal[0], group->normal[1], group->normal[2]};
    const PairMotionOf<EightFloats> motion = {j.velocity - i.velocity, i.spin, j.spin};
    const PairLoadOf<EightFloats> load = lubrication_load(coupling, pair, motion);
    add_motions(product, group->first, {-load.force, -load.torque_first});
    add_motions(product, group->second, {load.force, -load.torque_second});
  }
}

void multiply(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    product[i].v = system.diagonal[system.size_class[i]].v * vector[i].v;
  }
  add_links(system, vector, product);
}

// C r of one particle.
PECLET_ALWAYS_INLINE Floats preconditioned(const MotionRow* columns, const Floats& residual) {
  Floats sum = columns[0].v * residual[0];
  for (int c = 1; c < 6; ++c) {
    sum += columns[c].v * residual[place_of[c]];
  }
  return sum;
}

double squared_norm(const LinkSystem& system, const MotionRow* residual) {
  return summed(system.particles, [&](std::size_t i, Floats& sum) {
    sum += residual[i].v * preconditioned(system.inverse_blocks + 6 * i, residual[i].v);
  });
}

// The row of a particle in a field of vectors.
PECLET_ALWAYS_INLINE const Row& vector_row(const double* rows, std::size_t i) {
  return reinterpret_cast<const Row*>(rows)[i];
}

typedef float FourFloats __attribute__((vector_size(16)));

PECLET_ALWAYS_INLINE void set_motion(MotionRow& to, const Row& velocity, const Row& spin) {
  reinterpret_cast<FourFloats*>(&to)[0] = __builtin_convertvector(velocity, FourFloats);
  reinterpret_cast<FourFloats*>(&to)[1] = __builtin_convertvector(spin, FourFloats);
}

void set_residual(const LinkSystem& system, const StepRows& step, MotionRow* residual) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    Row force = vector_row(step.force, i), torque = vector_row(step.torque, i);
    if (step.noise_force != nullptr) {
      force += vector_row(step.noise_force, i);
      torque += vector_row(step.noise_torque, i);
    }
    const Row slowed = vector_row(step.velocity_before, i) - vector_row(step.velocity, i);
    const Row unspun = vector_row(step.spin_before, i) - vector_row(step.spin, i);
    set_motion(residual[i], inertia.translational * slowed + step.timestep * force,
               inertia.rotational * unspun + step.timestep * torque);
  }
}

// Motions relative to the flow; returns the sums of m u u + I w w.
template <bool is_simple_shear>
Row set_motions(const LinkSystem& system, const StepRows& step, MotionRow* motion) {
  const Row& spin = streaming_spin(step.flow);
  Row inertial{};
  for (std::size_t i = 0; i < system.particles; ++i) {
    Row streaming;
    set_streaming<is_simple_shear>(step.flow, vector_row(step.position, i), streaming);
    Row u = vector_row(step.velocity, i) - streaming, w = vector_row(step.spin, i) - spin;
    if (step.varying_velocity != nullptr) {
      u -= vector_row(step.varying_velocity, i);
      w -= vector_row(step.varying_spin, i);
    }
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    inertial += inertia.translational * u * u + inertia.rotational * w * w;
    set_motion(motion[i], u, w);
  }
  return inertial;
}

SquaredMotion squared_motion(const LinkSystem& system, const StepRows& step, MotionRow* motion,
                             MotionRow* product) {
  const Row inertial = step.flow.is_simple_shear ? set_motions<true>(system, step, motion)
                                                 : set_motions<false>(system, step, motion);
  multiply(system, motion, product);
  const double whole =
      summed(system.particles, [&](std::size_t i, Floats& sum) { sum += motion[i].v * product[i].v; });
  return {whole, inertial[0] + inertial[1] + inertial[2]};
}

void add_motion(std::size_t particles, const MotionRow* motion, double* velocity, double* spin) {
  for (std::size_t i = 0; i < particles; ++i) {
    const FourFloats* const halves = reinterpret_cast<const FourFloats*>(motion + i);
    reinterpret_cast<Row*>(velocity)[i] += __builtin_convertvector(halves[0], Row);
    reinterpret_cast<Row*>(spin)[i] += __builtin_convertvector(halves[1], Row);
  }
}

SolverReport solve(const LinkSystem& system, const SolverRows& rows, double target, int most_iterations) {
  const std::size_t count = system.particles;
  MotionRow *const x = rows.solution, *const r = rows.residual, *const p = rows.direction,
                   *const q = rows.product;
  SolverReport report;
  report.squared_residual = summed(count, [&](std::size_t i, Floats& sum) {
    p[i].v = preconditioned(system.inverse_blocks + 6 * i, r[i].v);
    x[i].v = Floats{};
    sum += r[i].v * p[i].v;
  });
  while (report.squared_residual > target && report.iterations < most_iterations) {
    multiply(system, p, q);
    const double curvature = summed(count, [&](std::size_t i, Floats& sum) { sum += p[i].v * q[i].v; });
    const auto alpha = static_cast<float>(report.squared_residual / curvature);
    // The product's rows take the preconditioned residual.
    const double squared = summed(count, [&](std::size_t i, Floats& sum) {
      x[i].v += alpha * p[i].v;
      const Floats rest = r[i].v - alpha * q[i].v;
      r[i].v = rest;
      const Floats z = preconditioned(system.inverse_blocks + 6 * i, rest);
      q[i].v = z;
      sum += rest * z;
    });
    const auto beta = static_cast<float>(squared / report.squared_residual);
    report.squared_residual = squared;
    ++report.iterations;
    for (std::size_t i = 0; i < count; ++i) {
      p[i].v = q[i].v + beta * p[i].v;
    }
  }
  return report;
}

}  // namespace
}  // namespace peclet::engine
