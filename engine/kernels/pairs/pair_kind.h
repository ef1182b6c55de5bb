// Everything that is the same for all pairs of two radii.
#pragma once

#include "engine/terms/conservative.h"
#include "engine/terms/strained_lubrication.h"

namespace peclet::engine {

struct PairKind {
  double radius_first, radius_second, sum_of_radii;
  double range;              // centre distance beyond which every term is zero
  double listed_range;       // up to which observables want to see the pair too
  double lubrication_range;  // of the centres; 0 without lubrication
  double smaller_radius;
  double reduced_diameter;  // 2 a_i a_j / (a_i + a_j)
  LubricatedGap gap;        // where there is lubrication
  ResistanceConstants resistance;
  RootConstants roots;
  StrainLengths strain;
  ConservativeLaws conservative;
};

}  // namespace peclet::engine
