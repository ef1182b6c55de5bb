// What a configuration shows by itself; sampled, not accumulated at every step.
#pragma once

#include "engine/kernels/pairs/pair_kinds.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Sigma^B = -(kT / V) sum_i (a_i / Delta_i) sum_{j: h < Delta_i} n n with Delta_i = 0.05 a_i: every pair is
// seen from both sides, overlapping ones included. Li, Royer & Ness (2023) eqs. 25, 26. Zero without
// temperature.
SymmetricTensor structural_brownian_stress(const System& system, const std::vector<PairKind>& kinds,
                                           double thermal_energy);

// Mean of m |U - streaming flow|^2 / 3 and of I |Omega - streaming spin|^2 / 3 over the particles: kT each in
// equilibrium.
struct KineticTemperatures {
  double translational, rotational;
};

KineticTemperatures kinetic_temperatures(const System& system, const ImposedFlow& imposed);

// What the variation of the flow within the cell adds to the stresslets of isolated spheres, over V: the sum
// of 20/3 pi eta a^3 (1 + a^2/10 lap) E'.
SymmetricTensor varying_stresslet(const ParticleState& particles, const PeriodicCell& box,
                                  const Physics& physics);

}  // namespace peclet::engine
