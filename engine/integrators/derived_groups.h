// DerivedGroups holds the time scales and dimensionless groups of a scene; scene_warnings() judges them.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "contract/json.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// A group that has no meaning in the scene is empty, and null in the JSON. a is reference_radius.
struct DerivedGroups {
  // Pe = 6 pi eta a^3 rate / kT,  St = tau_I / tau_S,  k_hat = k_n / (eta a rate).
  std::optional<double> peclet, stokes, relative_stiffness;
  // tau_C = sqrt(rho a^3 / k_n),  tau_I = rho a^2 / eta,  tau_B = eta a^3 / kT,  tau_S = 1 / rate  [time].
  std::optional<double> contact_time, inertial_time, brownian_time, shear_time;
  // Stresses: eta rate of a steady flow, kT / a^3, critical load / a^2, and F_R / a^2 with the repulsion F_R
  // of two spheres of radius a that touch.
  std::optional<double> viscous_stress, thermal_stress, critical_stress, repulsion_stress;
  std::optional<double> flow_over_rest;  // see nearly_at_rest
  // The largest rho_i a_i^2 rate / eta and rho_i kT / (eta^2 a_i) of all sizes.
  std::optional<double> largest_stokes, largest_inertia_over_brownian;
  // Groups of a mixture with whole numbers of spheres. The volume fraction is that of the scene, which the
  // box meets. alpha is the volume of the grains over that of all spheres. The share error is the largest
  // relative error of a species' share of the volume. The Peclet numbers take a_cg and a_g of Mixture.
  std::optional<double> volume_fraction, alpha, largest_share_error, peclet_mean, peclet_grains;
  // Mean, and standard deviation over mean, of the radii of all spheres. Empty without a size distribution.
  std::optional<double> mean_radius, relative_width;
};

// The Peclet number below which flow_over_rest is estimated: the processor time for a viscosity in the flow,
// over that for the same relative error at rest by the observable linear_response. With the total time T of
// all seeds,
//   error^2 in the flow = 2 kT eta_p / (eta V T rate^2 eta_r^2),  the floor of any mean of the stress,
//   error^2 at rest     = 1.2 (t/T) (eta_p / eta_r)^2,  t = 5 eta_r tau_B,  for N = 100 (results/at-rest),
//   flow_over_rest      = (6 pi / Pe)^2 phi a^3 / (300 v eta_r eta_p).
// eta_p = eta_r - 1 - 2.5 phi, v is the mean volume of a sphere, and the work is N T. eta_r is taken as (1 -
// phi / 0.587)^-1.5, as published for the limit. flow_over_rest is empty where that has no meaning or
// linear_response is refused.
inline constexpr double nearly_at_rest = 0.1;

// Returns true if the production window can show that the flow has jammed: the stress is given, and the
// window is longer than the patience of the flow.
bool notices_jams(const Scene& scene);

inline Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

DerivedGroups derived_groups(const Scene& scene);
Json to_json(const DerivedGroups& groups);
// Returns how tables show the members of to_json(), in order: objects with name, symbol, unit, some words.
Json names_of_groups();

// Adds a warning with a formatted message.
template <class... Arguments>
void warn(std::vector<Warning>& warnings, const char* code, fmt::format_string<Arguments...> message,
          Arguments&&... arguments) {
  warnings.push_back({code, fmt::format(message, std::forward<Arguments>(arguments)...)});
}

// Returns warnings of inertia that is not small, missed shares, a step beyond the automatic one, and a window
// that is too short to show a jam.
std::vector<Warning> scene_warnings(const Scene& scene);
// Returns warnings that the result makes superfluous: spheres that are too soft, or too dense to be packed.
std::vector<Warning> warnings_before_run(const Scene& scene);
// Warns if friction sets in near this mean shear stress because thermal motion opens contacts. How many are
// closed then goes with the size of implicit steps, and eta_r with it (results/stability).
void warn_of_step_at_onset_of_friction(const Scene& scene, double timestep, double stress,
                                       std::vector<Warning>& warnings);

}  // namespace peclet::engine
