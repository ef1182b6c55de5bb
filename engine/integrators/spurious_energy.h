// spurious_energy() returns the energy that a step of velocity Verlet makes because it is finite:
//   C = dt^2 / 2 sum (F^2 / m + T^2 / I) + sum over springs [E(x) - E(x - dt U') - dt U'.grad E(x)].
// Forces F and torques T of a configuration x act for a whole step, while they change velocities from U' to
// U' + dt F / m. Springs act with their final tension while dt U' stretches them. If work is counted with the
// velocities that forces were evaluated with, kinetic and elastic energy grow by C more than the work. For a
// linear spring the bracket is -k (extension)^2 / 2. To first order the balance over a window is
//   V rate sigma_xy dt summed = dissipated + stored + work of inertia - C summed.
// In smooth motion C is of first order in the step. Where modes overshoot, beyond the stable range, it is
// many times the work of the flow.
#pragma once

#include "engine/kernels/pair_kinds.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Returns C of the step that has just ended. Velocities are those of the full step, force and torque those at
// the present positions. A tangential or rolling spring at Coulomb's limit slides and counts as not growing.
double spurious_energy(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                       const VectorField& force, const VectorField& torque, double timestep);

}  // namespace peclet::engine
