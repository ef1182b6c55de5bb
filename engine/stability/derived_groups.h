// Time scales and dimensionless groups of a scene, and what they warn of.
#pragma once

#include <optional>
#include <vector>

#include "contract/json.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Dimensionless groups and time scales, a = reference_radius: tau_C = sqrt(rho a^3 / k_n), tau_I = rho a^2 /
// eta, tau_B = eta a^3 / kT, tau_S = 1 / rate, Pe = 6 pi eta a^3 rate / kT, St = tau_I / tau_S, k_hat = k_n /
// (eta a rate). A group without meaning in the scene (tau_B without temperature) is infinite or absent in the
// JSON (null).
struct DerivedGroups {
  std::optional<double> peclet, stokes, relative_stiffness;
  std::optional<double> contact_time, inertial_time, brownian_time, shear_time;
};

DerivedGroups derived_groups(const Scene& scene);
Json to_json(const DerivedGroups& groups);

// What the author should know before anything runs: inertia that is not small, a step beyond the automatic
// one.
std::vector<Warning> scene_warnings(const Scene& scene);

}  // namespace peclet::engine
