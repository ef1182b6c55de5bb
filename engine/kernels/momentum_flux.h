// What carries momentum through the cell in one step, times the volume: the stress of linear response.
//
// A step moves particles from x_n to x_n+1 = x_n + dt V at velocities that change from V_n to V. Pairs that
// exchange the momentum dt F at x change sum m x V by dt sum x F, whatever F is made of, so that
//   dt J = -[sum m x V] of the step + dt sum x F_body = dt [sum over pairs of sym(r F_i) - sum m sym(V V')]
// with x = x_n + dt V / 2 and V' = (V_n + V) / 2 in implicit steps; in velocity Verlet x is that of the
// forces and V = V' the velocity in between. F is the force that acted: of the velocities that the step has
// found, with its noise.
#pragma once

#include <initializer_list>

#include "engine/kernels/pairs/pair_sums.h"

namespace peclet::engine {

struct MomentumFlux {
  SymmetricTensor acted;         // J; friction belongs to it alone, too
  SymmetricTensor conservative;  // contact, repulsion, attraction and the motion: even in the velocities
  SymmetricTensor dissipative;   // lubrication: odd
};

// Of the stress by term that a step reports, with the flux by motion. The noise belongs to `acted` alone.
inline MomentumFlux flux_of(const PairSums& sums, const SymmetricTensor& motion) {
  MomentumFlux flux;
  flux.dissipative = sums.of(StressTerm::lubrication) + sums.of(StressTerm::contact_damping);
  flux.conservative = motion;
  for (const StressTerm term : {StressTerm::contact_normal, StressTerm::repulsion, StressTerm::attraction}) {
    flux.conservative += sums.of(term);
  }
  flux.acted = flux.conservative + flux.dissipative + sums.of(StressTerm::brownian_lubrication) +
               sums.of(StressTerm::friction);
  return flux;
}

}  // namespace peclet::engine
