// Everything that is the same for all pairs of two radii, worked out once.
#pragma once

#include <vector>

#include "engine/kernels/terms.h"
#include "engine/state/neighbour_list.h"
#include "engine/terms/pair_resistance.h"

namespace peclet::engine {

// Thickness of the shell, in radii, in which neighbours count for the structural Brownian stress.
constexpr double structural_shell = 0.05;

struct PairKind {
  double radius_first, radius_second, sum_of_radii;
  double range;              // centre distance beyond which every term is zero
  double listed_range;       // up to which observables want to see the pair too
  double lubrication_range;  // outer gap as a centre distance; 0 without lubrication
  double repulsion_range, repulsion_length;
  double smaller_radius;
  double reduced_diameter;  // 2 a_i a_j / (a_i + a_j)
  ResistanceConstants resistance;
};

// Indexed like Pair::kind: class of the first times the number of classes plus class of the second.
std::vector<PairKind> make_pair_kinds(const Physics& physics, const std::vector<double>& distinct_radii);

RangeTable range_table(const std::vector<PairKind>& kinds, std::size_t classes);

}  // namespace peclet::engine
