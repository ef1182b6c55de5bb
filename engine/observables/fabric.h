// Computes the fabric tensor, the mean orientation of the lines between the centres of pairs.
//
//   <n n> = (1 / number of pairs) sum over pairs of n n,   n = (x_j - x_i) / |x_j - x_i|
//
// with components xx yy zz xy xz yz in the axes of the flow. Its trace is 1; if all directions are alike it
// is a third of the unit tensor. `contacts` are the pairs that overlap. `near` are the pairs, contacts
// included, with a gap
//   xi = 2 (r - a_i - a_j) / (a_i + a_j)
// below a given one: the near-contacts of fabric evolution models (Hand 1962, J. Fluid Mech. 13, 33; Chacko,
// Mari, Fielding & Cates 2018, J. Fluid Mech. 847, 700). The default 0.05 is the range of lubrication in most
// simulations of suspensions.
#pragma once

#include <string>
#include <vector>

#include "engine/observables/accumulators.h"
#include "engine/state/system.h"

namespace peclet::engine {

struct FabricSums {
  struct Pairs {
    SymmetricTensor sum;  // sum of n n
    double count = 0;

    Pairs& operator+=(const Pairs& more) { return sum += more.sum, count += more.count, *this; }
  };
  Pairs contacts, near;
};

// Returns the sums over the pairs of a configuration. `gap` is the xi below which pairs are near.
FabricSums fabric_of(const System& system, double gap);

// Returns the quantity of a fabric tensor, with `further` axes after that of components.
Quantity fabric_quantity(const std::string& name, const std::vector<Axis>& further = {});

}  // namespace peclet::engine
