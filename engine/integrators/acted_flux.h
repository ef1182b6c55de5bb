// The flux of momentum of a step (kernels/momentum_flux.h), of a fluid at rest or nearly so: what a step's
// strain makes of its own stress is left out.
//
// With noise an implicit step has acted upon its pairs twice: with the random forces, and what else belongs
// to the beginning, at x_n; and with F(x', V') - A (V - V') at x', where the velocities V' have been
// predicted and A is the matrix of the links that have turned them into V. Both are brought to x_n + dt V
// / 2.
#pragma once

#include "engine/integrators/velocity_solver.h"

namespace peclet::engine {

// -sum m sym(V V'), V the present velocities, both relative to the uniform flow of the cell.
SymmetricTensor flux_by_motion(const System& system, const VectorField& mean_velocity);

class ActedFlux {
 public:
  // `drawn` less `counted` is what acts at the beginning; the loads with the noise of the drag in `field`.
  void begin(const System& system, const PairSums& drawn, const PairSums& counted, const Loads& loads,
             const ForceField& field);
  // At the predicted velocities, with the drag upon these.
  void predict(const System& system, const PairSums& ahead, const Loads& loads, const Physics& physics);
  // Once the velocities are found and before the particles move on from x': the flux by pairs.
  SymmetricTensor end(const System& system, VelocitySolver& solver, double timestep);

 private:
  SymmetricTensor stress_;
  VectorField force_at_beginning_, force_ahead_, predicted_velocity_;
};

}  // namespace peclet::engine
