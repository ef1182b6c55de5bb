// Drag of the solvent on single spheres, the noise that belongs to it, and the stress of both without pairs.
// The drag itself, zeta (U(x) - U_i) and zeta_r (Omega - Omega_i), is in kernels/one_body.h: Li, Royer & Ness
// (2023) eqs. 5, 6.
#pragma once

#include <numbers>

#include "engine/state/vector3.h"

namespace peclet::engine {

// zeta = 6 pi eta a and zeta_r = 8 pi eta a^3.
inline double translational_drag(double viscosity, double radius) {
  return 6 * std::numbers::pi * viscosity * radius;
}
inline double rotational_drag(double viscosity, double radius) {
  return 8 * std::numbers::pi * viscosity * radius * radius * radius;
}

// Streaming flow U = (rate y, 0, 0) and half its vorticity Omega = (0, 0, -rate / 2).
inline Vector3 streaming_velocity(double shear_rate, double y) { return {shear_rate * y, 0, 0}; }
inline Vector3 streaming_spin(double shear_rate) { return {0, 0, -0.5 * shear_rate}; }

// c sqrt(zeta), c = sqrt(2 kT / dt): times a standard normal vector it is the force, likewise the torque.
// Eqs. 20, 21.
inline double drag_noise_amplitude(double amplitude, double zeta) { return amplitude * std::sqrt(zeta); }

// 2 eta E of the solvent.
inline SymmetricTensor solvent_stress(double viscosity, double shear_rate) {
  SymmetricTensor stress;
  stress.xy = viscosity * shear_rate;
  return stress;
}

// 20/3 pi eta a^3 E of each sphere as if it were alone, over V: 2.5 phi times the solvent's.
inline SymmetricTensor stresslet(double volume_fraction, const SymmetricTensor& solvent) {
  return (2.5 * volume_fraction) * solvent;
}

}  // namespace peclet::engine
