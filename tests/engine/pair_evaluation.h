// Evaluates the pair loop once, and compares evaluations.
#pragma once

#include <string>
#include <vector>

#include "engine/kernels/force_field.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/state/system.h"

namespace peclet::engine {

constexpr double timestep = 1e-4;
constexpr std::uint64_t seed = 5;
constexpr double tolerance = 1e-12;  // of the largest component; only the order of sums differs

// Every term that acts between velocities relative to the fluid at rest.
constexpr Terms all_terms = {.lubrication = true,
                             .noise = true,
                             .contact = true,
                             .damping = true,
                             .friction = true,
                             .rolling = true,
                             .conservative = true,
                             .kinetic = true};
// Returns every compiled combination of terms.
std::vector<Terms> every_recipe();

// Returns the names of the terms, each followed by a space.
std::string text(const Terms& terms);

struct Evaluation {
  VectorField force, torque;
  PairSums sums;
  SpringField springs;
};

// Evaluates a copy of `system`, whose springs advance by one step.
Evaluation evaluated(const Physics& physics, System system, int threads = 1,
                     InstructionSet set = chosen_instruction_set());

std::vector<double> components(const VectorField& field);
std::vector<double> components(const PairSums& sums);  // the stress of every term
std::vector<double> components(const SpringField& springs);

// Expects agreement within `bound` of the largest expected component.
void expect_near(const std::vector<double>& expected, const std::vector<double>& found,
                 const std::string& what, double bound = tolerance);

// Expects agreement of all parts of an evaluation within `tolerance`, or bit by bit.
void expect_near(const Evaluation& expected, const Evaluation& found, const std::string& what);
void expect_same_bits(const Evaluation& expected, const Evaluation& found, const std::string& what);

// Expects the bits of one thread on two and three, and the forces of the baseline on another set.
void expect_same_bits_on_threads(const Physics& physics, const System& system);
void expect_single_twin(const Physics& physics, const System& system, InstructionSet set,
                        const std::string& what);
}  // namespace peclet::engine
