// These functions give the drag of the solvent on single spheres, its noise, and the stress of solvent and
// single spheres. The drag itself, zeta (U(x) - U_i) and zeta_r (Omega - Omega_i), is in kernels/one_body.h.
// Equation numbers are those of Li, Royer & Ness (2023).
#pragma once

#include <numbers>

#include "engine/flow/background_flow.h"

namespace peclet::engine {

// Return zeta = 6 pi eta a [force/velocity] and zeta_r = 8 pi eta a^3 [torque time] (eqs. 5, 6).
inline double translational_drag(double viscosity, double radius) {
  return 6 * std::numbers::pi * viscosity * radius;
}
inline double rotational_drag(double viscosity, double radius) {
  return 8 * std::numbers::pi * viscosity * radius * radius * radius;
}

// Returns c sqrt(zeta) with c = `amplitude` = sqrt(2 kT / dt). Times a standard normal vector it is the
// force; with zeta_r it is the torque (eqs. 20, 21).
inline double drag_noise_amplitude(double amplitude, double zeta) { return amplitude * std::sqrt(zeta); }

// Returns the stress 2 eta E of the solvent.
inline SymmetricTensor solvent_stress(double viscosity, const Matrix3& velocity_gradient) {
  return (2 * viscosity) * strain_of(velocity_gradient);
}

// Returns 20/3 pi eta a^3 E of an isolated sphere. `strain` is E with Faxen's correction, (1 + a^2/10 lap) E.
inline SymmetricTensor stresslet_of_sphere(double viscosity, double radius, const SymmetricTensor& strain) {
  return (20.0 / 3.0 * std::numbers::pi * viscosity * radius * radius * radius) * strain;
}

// Returns the stresslets of all spheres in a uniform E over the volume: 2.5 phi times the solvent's stress.
inline SymmetricTensor stresslet(double volume_fraction, const SymmetricTensor& solvent) {
  return (2.5 * volume_fraction) * solvent;
}

}  // namespace peclet::engine
