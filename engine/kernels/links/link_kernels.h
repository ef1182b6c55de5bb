// The linear system of an implicit step: what the compiled functions that build and solve it take and leave.
//
//   A = D + sum over links of couplings,
// symmetric and positive definite, with a row of eight single-precision numbers for each particle: three of
// its velocity, 0, three of its spin, 0. D holds inertia and drag. A link couples two near particles in the
// form of lubrication (terms/lubrication.h), whatever the coefficients stand for: resistance, or the
// stiffness of springs. Single precision is enough for a correction to a velocity whose residual is known in
// double precision.
//
// Plain data, because this is shared with files that are compiled for one processor only.
#pragma once

#include "engine/kernels/bodies/one_body_kernels.h"
#include "engine/kernels/pairs/pair_kernels.h"

namespace peclet::engine {

typedef float Floats __attribute__((vector_size(32)));

struct alignas(32) MotionRow {
  Floats v;
};

constexpr int links_per_group = 8;

struct alignas(32) LinkGroup {
  std::uint32_t first[links_per_group], second[links_per_group];
  Floats normal[3];
  Floats squeeze, shear, pump_first, pump_second, twist_first, twist_cross, twist_second;
};

// The couplings of a pair are timestep (R + normal_time K_n + felt_share timestep K_t) with the resistance R,
// the stiffness K_n along n and the one K_t of tangential and rolling springs, which push after felt_share of
// their advance (PairParameters). A spring that slides has the secant stiffness that leaves it at Coulomb's
// limit.
struct LinkWeights {
  double timestep, normal_time;
  // The approach changes the squeezing resistance during this time; 0: the resistance stays.
  double resistance_time;
};

struct LinkSystem {
  std::size_t particles;
  const std::uint16_t* size_class;
  const MotionRow* diagonal;  // of D, for each size class
  const LinkGroup* groups;
  std::size_t count_of_groups;
  const MotionRow* inverse_blocks;  // six columns for each particle, see invert_blocks
};

// Rows of each particle that solve() works on.
struct SolverRows {
  MotionRow *solution, *residual, *direction, *product;
};

struct SolverReport {
  int iterations = 0;
  double squared_residual = 0;  // r.C r with the inverse blocks C
};

// What the residual of the equations of motion is made of; rows are those of a VectorField.
struct StepRows {
  const double *velocity_before, *spin_before;
  const double *position, *velocity, *spin;
  const double *force, *torque;
  const double *noise_force, *noise_torque;  // added to the forces, or null
  const OneBodyFactors* inertia;             // of each size class
  double timestep;
  UniformFlow flow;
  const double *varying_velocity, *varying_spin;  // added to the flow, or null
};

// (V - U).A (V - U) with the streaming flow U, and the part of it that is inertia.
struct SquaredMotion {
  double whole, inertial;
};

// Of invert_blocks(): the lower triangle of each particle's block, 21 numbers.
constexpr std::size_t rows_of_scratch(std::size_t particles) { return 3 * particles; }

struct LinkKernels {
  // The links of all pairs within their range, at the motion that `input` holds; the last group is filled up
  // with links that couple nothing. Returns the number of groups; there must be room for one link of each
  // pair.
  std::size_t (*assemble)(const PairKernelInput& input, const PairRun* runs, std::size_t count,
                          const Terms& terms, const LinkWeights& weights, LinkGroup* groups);

  // The inverse of each particle's own 6 x 6 block of A, six columns for each.
  void (*invert_blocks)(const LinkSystem& system, MotionRow* scratch, MotionRow* inverse_blocks);

  // product = A vector.
  void (*multiply)(const LinkSystem& system, const MotionRow* vector, MotionRow* product);

  // residual = M (velocity before - velocity) + timestep force, and likewise for spins.
  void (*set_residual)(const LinkSystem& system, const StepRows& step, MotionRow* residual);

  // Of the velocities relative to the streaming flow. Overwrites both rows.
  SquaredMotion (*squared_motion)(const LinkSystem& system, const StepRows& step, MotionRow* motion,
                                  MotionRow* product);

  // Adds rows to velocities and spins.
  void (*add_motion)(std::size_t particles, const MotionRow* motion, double* velocity, double* spin);

  // Returns r.C r.
  double (*squared_norm)(const LinkSystem& system, const MotionRow* residual);

  // Conjugate gradients with the inverse blocks as preconditioner, from zero, until r.C r <= target or after
  // `most_iterations`. The residual enters as the right-hand side and leaves as what remains of it.
  SolverReport (*solve)(const LinkSystem& system, const SolverRows& rows, double target, int most_iterations);
};

extern const LinkKernels baseline_link_kernels;  // gathers one number at a time: the twin of the others
extern const LinkKernels avx2_link_kernels;
extern const LinkKernels avx512_link_kernels;

}  // namespace peclet::engine
