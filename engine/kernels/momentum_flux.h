// What carries momentum through the cell in one step, times the volume: the stress that acts.
//
// A step moves particles from x_n to x_n+1 = x_n + dt V at velocities that change from V_n to V. Pairs that
// exchange the momentum dt F at x change sum m x V by dt sum x F, whatever F is made of, so that
//   dt J = -[sum m x V] of the step + dt sum x F_body = dt [sum over pairs of sym(r F_i) - sum m sym(V V')]
// with x = x_n + dt V / 2 and V' = (V_n + V) / 2 in implicit steps; in velocity Verlet x is that of the
// forces and V = V' the velocity in between. F is the force that acted: of the velocities that the step has
// found, with its noise.
#pragma once

#include "engine/kernels/pairs/pair_sums.h"

namespace peclet::engine {

struct MomentumFlux {
  SymmetricTensor by_pairs;      // sum over pairs of sym(r F_i), all terms
  SymmetricTensor by_motion;     // of the motion relative to the flow, as steps report it
  SymmetricTensor conservative;  // contact, repulsion, attraction and the motion: even in the velocities
  SymmetricTensor dissipative;   // lubrication and damping: odd

  SymmetricTensor acted() const { return by_pairs + by_motion; }  // J
};

// The stress that results report, times the volume: with noise that of the motion is a part of it, by which
// the pressure at rest is the one of thermodynamics; without noise it is left out.
inline SymmetricTensor stress_of(const MomentumFlux& flux, bool has_noise) {
  return has_noise ? flux.acted() : flux.by_pairs;
}

inline MomentumFlux flux_of(const PairSums& sums, const SymmetricTensor& motion) {
  MomentumFlux flux;
  flux.by_pairs = total_stress(sums);
  flux.by_motion = motion;
  flux.dissipative = sums.of(StressTerm::lubrication) + sums.of(StressTerm::contact_damping);
  flux.conservative = motion + sums.of(StressTerm::contact_normal) + sums.of(StressTerm::repulsion) +
                      sums.of(StressTerm::attraction);
  return flux;
}

}  // namespace peclet::engine
