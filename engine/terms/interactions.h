// Parameters of the forces between pairs, as a scene gives them.
#pragma once

namespace peclet::engine {

// Linear contact between overlapping spheres; with friction > 0 a tangential spring, with rolling stiffness a
// rolling one. Stiffnesses in force per length, damping in force per velocity.
struct ContactParameters {
  double normal_stiffness = 0;
  double normal_damping = 0;
  double friction = 0;
  double tangential_stiffness = 0;  // 2/7 of the normal one unless given
  double rolling_stiffness = 0;
  double rolling_friction = 0;  // that of sliding unless given
};

// Squeeze, shear and pump modes between near spheres, gaps as 2 (r - a_i - a_j) / (a_i + a_j).
struct LubricationParameters {
  double inner_gap = 1e-3;
  double outer_gap = 0.05;
};

// Exponential repulsion: potential strength * exp(-h / kappa), kappa = relative_length (a_i + a_j), h <
// cutoff_lengths kappa.
struct RepulsionParameters {
  double strength = 0;
  double relative_length = 0.01;
  double cutoff_lengths = 20;
};

}  // namespace peclet::engine
