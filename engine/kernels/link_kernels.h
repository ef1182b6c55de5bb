// The linear system of an implicit step: what the compiled functions that build and solve it take and leave.
//
//   A = D + sum over links of couplings,
// symmetric and positive definite, with a row of eight single-precision numbers for each particle: three of
// its velocity, 0, three of its spin, 0. D holds inertia and drag. A link couples two near particles in the
// form of lubrication (terms/lubrication.h), whatever the coefficients stand for: resistance, or the
// stiffness of springs. Single precision is enough for a correction to a velocity whose residual is known in
// double precision.
//
// Rows are arranged in blocks and levels (link_order.h): no link couples two rows of one level. With L the
// couplings of a row to rows of earlier levels and B the particles' own blocks, A = L + B + L^T. The
// preconditioner is
//   C = (P + L) P^-1 (P + L^T),   P = B - K,
// with pivots P as those of an incomplete factorisation (Meijerink & van der Vorst 1977), of which K keeps
// the squeezing alone: row after row
//   K_i = 0.9 sum over links to earlier rows j of s^2 (n.P_j^-1 n) n n
// with the squeezing coefficient s. P_j holds s n n itself, so that s n.P_j^-1 n < 1 and every P is positive
// definite. Where K = 0 this is symmetric Gauss-Seidel; the factor keeps rounding away from the bound.
//
// Plain data, because this is shared with files that are compiled for one processor only.
#pragma once

#include "engine/kernels/one_body_kernels.h"
#include "engine/kernels/pair_kernels.h"
#include "engine/state/threads.h"

namespace peclet::engine {

#ifndef PECLET_FLOATS  // tests/bench/engine/counted_links.cpp has numbers that count
typedef float Floats __attribute__((vector_size(32)));
#endif

struct alignas(32) MotionRow {
  Floats v;
};

constexpr int links_per_group = 8;
constexpr std::size_t rows_of_block = 2;  // what a link adds to a particle's own block

// Rows of particles; `first` is in a later level than `second`.
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
};

// A change of all motions: rows of velocity and spin, as those of a VectorField.
struct ChangeRows {
  const double *velocity, *spin;
};

// Consecutive rows of a block, and the groups of links whose first particles they are.
struct LinkLevel {
  std::uint32_t rows_begin, rows_end;
  std::uint32_t groups_begin;       // of links within the block; there is room for those of all listed pairs
  std::uint32_t count_of_groups;    // in use
  std::uint32_t crossing_begin;     // groups of links to rows of other blocks
  std::uint32_t count_of_crossing;  // links
  std::uint32_t incoming_begin, incoming_end;  // whose second particles the rows are
};

// The rows of some particles next to each other, which have the same numbers in another order. Levels of the
// interior come first; links to other blocks couple rows of the boundary.
struct LinkBlock {
  std::uint32_t rows_begin, rows_end;
  std::uint32_t levels_begin, boundary_begin, levels_end;
};

// A link between two blocks, among all of them, and its second particle.
struct IncomingLink {
  std::uint32_t row, crossing;
};

// Where the link of a pair between two blocks goes: a number among the links of all groups. `first` and
// `second` are rows.
struct CrossingLink {
  std::uint32_t place, first, second;
};

// Where the links of pairs go. Consecutive links of a level often belong to the same row: they go to
// different groups, so that sums into a row do not wait for each other within a group.
constexpr std::uint32_t groups_side_by_side = 4;
constexpr std::uint32_t links_side_by_side = groups_side_by_side * links_per_group;

struct LinkPlaces {
  const std::uint32_t* row;    // of each particle
  const std::uint32_t* level;  // of each row
  LinkLevel* levels;
  std::uint32_t* next;           // a number for each level, to count with
  const CrossingLink* crossing;  // of each crossing pair of the list
};

// P^-1 = (a b; b^T c) of one particle, with blocks of velocity and spin, and K. Three numbers of each half
// are parts of a motion, the fourth is what would be 0 there:
//   { a_xx a_yy a_zz K_xx   c_xx c_yy c_zz K_xy }
//   { a_xy a_xz a_yz K_yy   c_xy c_xz c_yz K_xz }
//   { b_xx b_yy b_zz K_zz   b_xx b_yy b_zz K_yz }
//   { b_xy b_yz b_zx 0      b_yx b_zy b_xz 0 }
struct Pivot {
  MotionRow rows[4];
};

// What the rows of a block contribute. One is taken anew while others may still be read.
struct alignas(64) LinkSums {
  double begun;            // of begin()
  double curvature, left;  // of solve()
  double whole, inertial;  // of squared_motion()
};

// Blocks are shared out among the members of a team. Sums are those of blocks, added up in their order: they
// have the same bits for any number of members. What a block's rows do to those of another is put aside, for
// whoever works on that one.
struct LinkSystem {
  std::size_t particles;
  const std::uint32_t* row;  // of each particle
  const std::uint16_t* size_class;
  const MotionRow* diagonal;  // of D, for each size class
  const LinkBlock* blocks;
  std::size_t count_of_blocks;
  const LinkLevel* levels;
  std::uint32_t boundary_levels;  // of every block
  const LinkGroup* groups;
  const IncomingLink* incoming;
  const Pivot* pivots;           // of each row
  MotionRow* aside;              // rows_of_block of each crossing link
  std::uint32_t crossing_begin;  // the first group of crossing links
  LinkSums* sums;                // of each block
};

// Of each row, what solve() works on. `solution` holds the right-hand side until then.
struct SolverRows {
  MotionRow *solution, *residual, *weighted, *direction, *ahead, *moved, *loads;
};

struct SolverReport {
  int iterations = 0;
  double squared_residual = 0;  // r.C^-1 r
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

// All members of a team call these, each for its part of the blocks, with the same arguments. What one
// returns is the same for all of them.
struct LinkKernels {
  // The links of pairs of one block of the list within their range, at the motion that `input` holds. The
  // last groups of its levels are filled up with links that couple nothing. Those of crossing pairs are
  // complete when all blocks are.
  //
  // Unless `loads` is null, the pairs leave theirs there as in a PairKernel, with one sum of all: those of
  // lubrication, conservative laws and undamped contacts without friction, which terms must not have beyond.
  void (*assemble)(const PairKernelInput& input, const PairRun* runs, std::size_t count, const Terms& terms,
                   const LinkWeights& weights, const LinkPlaces& places, const LinkBlock& block,
                   LinkGroup* groups, const PairKernelOutput* loads);

  // What a change of the motion that `input` holds adds to the loads of the pairs of one block, as their
  // links have it, with one sum of all. Springs stay as they are.
  void (*leave_change)(const PairKernelInput& input, const PairRun* runs, std::size_t count,
                       const Terms& terms, const LinkWeights& weights, const ChangeRows& change,
                       const PairKernelOutput& loads);

  // The pivots of a system, which may be those that it points at.
  void (*factorise)(const LinkSystem& system, Pivot* pivots, Team& team);

  // product = A vector, both in the order of rows. Of a team of one.
  void (*multiply)(const LinkSystem& system, const MotionRow* vector, MotionRow* product);

  // residual = M (velocity before - velocity) + timestep force, and likewise for spins.
  void (*set_residual)(const LinkSystem& system, const StepRows& step, MotionRow* residual, Team& team);

  // Of the velocities relative to the streaming flow. Overwrites the rows.
  SquaredMotion (*squared_motion)(const LinkSystem& system, const StepRows& step, MotionRow* motion,
                                  Team& team);

  // Adds rows to velocities and spins of their particles.
  void (*add_motion)(const LinkSystem& system, const MotionRow* motion, double* velocity, double* spin,
                     Team& team);

  // Begins to solve A x = right for rows.solution = right: sets rows.weighted and rows.residual. Returns
  // right.C^-1 right.
  double (*begin)(const LinkSystem& system, const SolverRows& rows, Team& team);

  // After begin(), which returned `squared_residual`: conjugate gradients from zero, until r.C^-1 r <= target
  // or after `most_iterations`.
  SolverReport (*solve)(const LinkSystem& system, const SolverRows& rows, double squared_residual,
                        double target, int most_iterations, Team& team);
};

extern const LinkKernels baseline_link_kernels;  // gathers one number at a time: the twin of the others
extern const LinkKernels avx2_link_kernels;
extern const LinkKernels avx512_link_kernels;

}  // namespace peclet::engine
