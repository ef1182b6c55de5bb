// The fabric tensor: how the lines between the centres of pairs are oriented.
//
//   <n n> = (1 / number of pairs) sum over pairs of n n,   n = (x_j - x_i) / |x_j - x_i|
//
// xx yy zz xy xz yz, in the axes of the flow; its trace is 1, and it is a third of the unit tensor where all
// directions are alike. `contacts` are the pairs that overlap. `near` are those whose gap xi = 2 (r - a_i -
// a_j) / (a_i + a_j) is below a given one, contacts among them: the near-contacts of fabric evolution models
// (Hand 1962, J. Fluid Mech. 13, 33; Chacko, Mari, Fielding & Cates 2018, J. Fluid Mech. 847, 700). What is
// near is a choice: 0.05 unless given, the range of lubrication in most simulations of suspensions.
#pragma once

#include <string>
#include <vector>

#include "engine/observables/accumulators.h"
#include "engine/state/system.h"

namespace peclet::engine {

struct FabricSums {
  struct Pairs {
    SymmetricTensor sum;  // of n n
    double count = 0;

    Pairs& operator+=(const Pairs& more) { return sum += more.sum, count += more.count, *this; }
  };
  Pairs contacts, near;
};

// Sums over the pairs of a configuration. `gap` is the xi below which pairs are near.
FabricSums fabric_of(const System& system, double gap);

// The quantity of the components of a fabric, over a further axis or none.
Quantity fabric_quantity(const std::string& name, const std::vector<Axis>& further = {});

}  // namespace peclet::engine
