// The linear system of an implicit step, and the compiled functions that build and solve it.
//
//   A = D + sum over links of couplings
// is symmetric and positive definite. Each particle has a row of eight single-precision numbers: three of its
// velocity, 0, three of its spin, 0. D holds inertia and drag. A link couples two near particles in the form
// of lubrication (terms/lubrication.h); its coefficients are those of resistance and of stiffness of springs.
// Single precision is enough for a correction to velocities whose residual is known in double precision.
//
// Rows are arranged in blocks and levels (link_order.h): no link couples two rows of one level. With the
// couplings L of a row to rows of earlier levels and the particles' own blocks B, A = L + B + L^T. The
// preconditioner is
//   C = (P + L) P^-1 (P + L^T),   P = B - K
// with pivots P of an incomplete factorisation (Meijerink & van der Vorst 1977), of which K keeps the
// squeezing alone. Row after row
//   K_i = 0.9 sum over links to earlier rows j of s^2 (n.P_j^-1 n) n n
// with the squeezing coefficient s. P_j contains s n n itself, so that s n.P_j^-1 n < 1 and every P is
// positive definite; the factor 0.9 keeps rounding off this bound. K = 0 gives symmetric Gauss-Seidel.
//
// Plain data, because files that are compiled for one processor only include this header.
#pragma once

#include "engine/kernels/one_body_kernels.h"
#include "engine/kernels/pair_kernels.h"
#include "engine/state/threads.h"

namespace peclet::engine {

#ifndef PECLET_FLOATS  // tests/bench/engine/counted_links.cpp has numbers that count operations
typedef float Floats __attribute__((vector_size(32)));
#endif

struct alignas(32) MotionRow {
  Floats v;
};

constexpr int links_per_group = 8;
constexpr std::size_t rows_of_block = 2;  // rows of numbers that a link adds to a particle's own block

// Eight links side by side. Particles are given by their rows; `first` is in a later level than `second`.
struct alignas(32) LinkGroup {
  std::uint32_t first[links_per_group], second[links_per_group];
  Floats normal[3];
  Floats squeeze, shear, pump_first, pump_second, twist_first, twist_cross, twist_second;
};

// The weights in the coupling of a pair,
//   timestep (R + normal_time K_n + felt_share timestep K_t)
// with the resistance R, the stiffness K_n along n and the stiffness K_t of tangential and rolling springs,
// which push after felt_share of their advance (PairParameters). A spring that slides has the secant
// stiffness that leaves it at Coulomb's limit.
struct LinkWeights {
  double timestep, normal_time;
};

// A change of the motion of all particles, in rows of VectorFields.
struct ChangeRows {
  const double *velocity, *spin;
};

// Consecutive rows of a block, and the groups of links that have these rows as first particles.
struct LinkLevel {
  std::uint32_t rows_begin, rows_end;
  std::uint32_t groups_begin;       // links within the block; there is room for those of all listed pairs
  std::uint32_t count_of_groups;    // in use
  std::uint32_t crossing_begin;     // groups of links to rows of other blocks
  std::uint32_t count_of_crossing;  // links to rows of other blocks
  std::uint32_t incoming_begin, incoming_end;  // crossing links to these rows
};

// The rows of a block of particles: the numbers of its particles, in another order. Levels of the interior
// come first, those of the boundary, which has the links to other blocks, last.
struct LinkBlock {
  std::uint32_t rows_begin, rows_end;
  std::uint32_t levels_begin, boundary_begin, levels_end;
};

// A crossing link, numbered among all of them, and the row of its second particle.
struct IncomingLink {
  std::uint32_t row, crossing;
};

// The place of a crossing link, numbered among the links of all groups, and the rows of its particles.
struct CrossingLink {
  std::uint32_t place, first, second;
};

// Consecutive links of a level often belong to one row. They go to different groups: sums into a row must not
// wait for each other within a group.
constexpr std::uint32_t groups_side_by_side = 4;
constexpr std::uint32_t links_side_by_side = groups_side_by_side * links_per_group;

// The places where the links of pairs are written.
struct LinkPlaces {
  const std::uint32_t* row;    // for each particle
  const std::uint32_t* level;  // for each row
  LinkLevel* levels;
  std::uint32_t* next;           // number of the next link of each level
  const CrossingLink* crossing;  // for each crossing pair of the list
};

// P^-1 = (a b; b^T c) of one particle, with blocks of velocity and spin, and K where a motion has a 0:
//   { a_xx a_yy a_zz K_xx   c_xx c_yy c_zz K_xy }
//   { a_xy a_xz a_yz K_yy   c_xy c_xz c_yz K_xz }
//   { b_xx b_yy b_zz K_zz   b_xx b_yy b_zz K_yz }
//   { b_xy b_yz b_zx 0      b_yx b_zy b_xz 0 }
struct Pivot {
  MotionRow rows[4];
};

// Sums over the rows of a block, each apart: one is computed while others may still be read.
struct alignas(64) LinkSums {
  double begun;            // for begin()
  double curvature, left;  // for solve()
  double whole, inertial;  // for squared_motion()
};

// The matrix A, its pivots and storage for a team that works on it. Blocks are shared out among the members.
// Sums over blocks are added in their order and have the same bits for any number of members. Loads on rows
// of other blocks are put aside for the members that work on these.
struct LinkSystem {
  std::size_t particles;
  const std::uint32_t* row;  // for each particle
  const std::uint16_t* size_class;
  const MotionRow* diagonal;  // D for each size class
  const LinkBlock* blocks;
  std::size_t count_of_blocks;
  const LinkLevel* levels;
  std::uint32_t boundary_levels;  // in every block
  const LinkGroup* groups;
  const IncomingLink* incoming;
  const Pivot* pivots;           // for each row
  MotionRow* aside;              // rows_of_block rows for each crossing link
  std::uint32_t crossing_begin;  // the first group of crossing links
  LinkSums* sums;                // for each block
};

// The vectors that solve() works on. `solution` holds the right-hand side before.
struct SolverRows {
  MotionRow *solution, *residual, *weighted, *direction, *ahead, *moved, *loads;
};

struct SolverReport {
  int iterations = 0;
  double squared_residual = 0;  // r.C^-1 r
};

// The terms of the residual of the equations of motion, in rows of VectorFields.
struct StepRows {
  const double *velocity_before, *spin_before;
  const double *position, *velocity, *spin;
  const double *force, *torque;
  const double *noise_force, *noise_torque;  // added to the forces, or null
  const OneBodyFactors* inertia;             // for each size class
  double timestep;
  UniformFlow flow;
  const double *varying_velocity, *varying_spin;  // added to the flow, or null
};

// The sum (V - U).A (V - U) with the streaming flow U, and the part of inertia in it.
struct SquaredMotion {
  double whole, inertial;
};

// The compiled functions. Those with a team are called by all its members with the same arguments; each
// member works on its part of the blocks, and all get the same result.
struct LinkKernels {
  // Assembles the links of the pairs of one block within their range, at the motion of `input`. Links that
  // couple nothing fill up the last groups of its levels. Crossing links are complete when all blocks are.
  //
  // Unless `loads` is null, also sets the loads of the pairs as a PairKernel does, with one sum of all. The
  // terms must then be lubrication, conservative laws and contacts without damping and friction only.
  void (*assemble)(const PairKernelInput& input, const PairRun* runs, std::size_t count, const Terms& terms,
                   const LinkWeights& weights, const LinkPlaces& places, const LinkBlock& block,
                   LinkGroup* groups, const PairKernelOutput* loads);

  // Sets the loads that a change of the motion of `input` adds to the pairs of one block by their links, with
  // one sum of all. Springs stay as they are.
  void (*leave_change)(const PairKernelInput& input, const PairRun* runs, std::size_t count,
                       const Terms& terms, const LinkWeights& weights, const ChangeRows& change,
                       const PairKernelOutput& loads);

  // Computes the pivots of a system, which may be those that it points at.
  void (*factorise)(const LinkSystem& system, Pivot* pivots, Team& team);

  // Sets product = A vector, both in the order of rows, without a team.
  void (*multiply)(const LinkSystem& system, const MotionRow* vector, MotionRow* product);

  // Sets residual = M (velocity before - velocity) + timestep force, and likewise for spins.
  void (*set_residual)(const LinkSystem& system, const StepRows& step, MotionRow* residual, Team& team);

  // Returns the squared motion relative to the streaming flow. Overwrites `motion`.
  SquaredMotion (*squared_motion)(const LinkSystem& system, const StepRows& step, MotionRow* motion,
                                  Team& team);

  // Adds `motion` to velocities and spins.
  void (*add_motion)(const LinkSystem& system, const MotionRow* motion, double* velocity, double* spin,
                     Team& team);

  // Begins to solve A x = b with b in rows.solution: sets rows.weighted and rows.residual. Returns b.C^-1 b.
  double (*begin)(const LinkSystem& system, const SolverRows& rows, Team& team);

  // Solves by conjugate gradients from x = 0, after begin(), which returned `squared_residual`. Ends when
  // r.C^-1 r <= target or after `most_iterations`.
  SolverReport (*solve)(const LinkSystem& system, const SolverRows& rows, double squared_residual,
                        double target, int most_iterations, Team& team);
};

extern const LinkKernels baseline_link_kernels;  // gathers one number at a time; the reference for the others
extern const LinkKernels avx2_link_kernels;
extern const LinkKernels avx512_link_kernels;

}  // namespace peclet::engine
