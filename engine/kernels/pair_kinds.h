// Computes what is the same for all pairs of two radii.
#pragma once

#include <vector>

#include "engine/kernels/pair_terms.h"
#include "engine/scene/scene.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// The thickness [radii] of the shell in which neighbours count for the structural Brownian stress.
constexpr double structural_shell = 0.05;

PairKind make_pair_kind(const Physics& physics, double radius_first, double radius_second);

// Returns kinds indexed like Pair::kind: class of the first times number of classes plus class of the second.
std::vector<PairKind> make_pair_kinds(const Physics& physics, const std::vector<double>& distinct_radii);

// Returns the listed ranges of the kinds.
RangeTable range_table(const std::vector<PairKind>& kinds, std::size_t classes);

}  // namespace peclet::engine
