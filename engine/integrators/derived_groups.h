// Time scales and dimensionless groups of a scene, and what they warn of.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "contract/json.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Dimensionless groups and time scales, a = reference_radius: tau_C = sqrt(rho a^3 / k_n), tau_I = rho a^2 /
// eta, tau_B = eta a^3 / kT, tau_S = 1 / rate, Pe = 6 pi eta a^3 rate / kT, St = tau_I / tau_S, k_hat = k_n /
// (eta a rate). A group without meaning in the scene (tau_B without temperature) is infinite or absent in the
// JSON (null). flow_over_rest: see below. largest_stokes and largest_inertia_over_brownian: the largest
// rho_i a_i^2 rate / eta and rho_i kT / (eta^2 a_i) of all sizes.
struct DerivedGroups {
  std::optional<double> peclet, stokes, relative_stiffness;
  std::optional<double> contact_time, inertial_time, brownian_time, shear_time;
  std::optional<double> flow_over_rest;
  std::optional<double> largest_stokes, largest_inertia_over_brownian;
  // Of a mixture with whole numbers of spheres: the volume fraction as asked for, which the box meets; the
  // volume of the grains over that of all spheres; the largest error of a species' share of the volume,
  // relative to the wanted one; Peclet numbers with the a_cg and a_g of Mixture.
  std::optional<double> volume_fraction, alpha, largest_share_error, peclet_mean, peclet_grains;
  // Where sizes come from a distribution: mean, and standard deviation over mean, of the radii of all
  // spheres.
  std::optional<double> mean_radius, relative_width;
};

// Nearly at rest, below Pe = 0.1: the processor time of a mean in the flow over that of the same relative
// error at rest, by the observable linear_response. Both are averages over the time T of all seeds; with
// eta_p = eta_r - 1 - 2.5 phi and N T the work,
//   error^2 in the flow = 2 kT eta_p / (eta V T rate^2 eta_r^2),  the floor of any mean of the stress,
//   error^2 at rest = 1.2 (t/T) (eta_p / eta_r)^2,  t = 5 eta_r tau_B,  of N = 100 (results/at-rest),
// of which the quotient is (6 pi / Pe)^2 phi a^3 / (300 v eta_r eta_p) with the mean volume v of a sphere.
// eta_r is taken to be (1 - phi / 0.587)^-1.5, as published for the limit. A guess: nothing where that has no
// meaning or linear_response is refused.
inline constexpr double nearly_at_rest = 0.1;

// Returns whether a jam is noticed that is there when the window begins: if the stress is given and the
// window outlasts the patience of the flow.
bool notices_jams(const Scene& scene);

inline Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

DerivedGroups derived_groups(const Scene& scene);
Json to_json(const DerivedGroups& groups);
// What people call each member of to_json(), in the order in which they look for them: a list of objects with
// name, symbol and unit, of some with words.
Json names_of_groups();

// Adds a warning, whose message is a format with its arguments.
template <class... Arguments>
void warn(std::vector<Warning>& warnings, const char* code, fmt::format_string<Arguments...> message,
          Arguments&&... arguments) {
  warnings.push_back({code, fmt::format(message, std::forward<Arguments>(arguments)...)});
}

// What the author should know before anything runs: inertia that is not small, a step beyond the automatic
// one, a window in which no jam is noticed.
std::vector<Warning> scene_warnings(const Scene& scene);
// What the result itself would say in the end: spheres that are too soft, or too dense to be packed.
std::vector<Warning> warnings_before_run(const Scene& scene);

}  // namespace peclet::engine
