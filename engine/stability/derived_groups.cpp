// Li 2023, equations 3.55 to 3.58 and 2.7.
#include "engine/stability/derived_groups.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "engine/stability/stability.h"

namespace peclet::engine {

namespace {

// Inertia over shear and over Brownian motion above which it is no longer small; the second is what the
// published flow curves accept at low Pe.
constexpr double largest_inertia_over_shear = 0.1;
constexpr double largest_inertia_over_brownian = 0.17;

double mean_sphere_volume(const Particles& particles) {
  double sum = 0;
  const bool by_volume = particles.shares == Particles::Shares::volume;
  for (const Species& species : particles.species) {
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(species.radius, 3);
    sum += by_volume ? species.share / volume : species.share * volume;
  }
  return by_volume ? 1 / sum : sum;
}

std::optional<double> flow_over_rest(const Scene& scene, double peclet) {
  const Physics& physics = scene.physics;
  const double fraction = scene.volume_fraction, jammed = 0.587;
  const bool refused = physics.flow.varies() || !has_known_equilibrium(physics);
  if (refused || !(peclet > 0) || peclet >= nearly_at_rest || fraction >= jammed) return std::nullopt;
  const double viscosity = std::pow(1 - fraction / jammed, -1.5), of_pairs = viscosity - 1 - 2.5 * fraction;
  if (!(of_pairs > 0)) return std::nullopt;
  const double size = std::pow(scene.particles.reference_radius, 3) / mean_sphere_volume(scene.particles);
  return std::pow(6 * std::numbers::pi / peclet, 2) * fraction * size / (300 * viscosity * of_pairs);
}

// A ratio that was chosen to be the bound, in decimals, counts as having reached it.
bool reaches(double ratio, double bound) { return ratio >= bound * (1 - 1e-9); }

}  // namespace

DerivedGroups derived_groups(const Scene& scene) {
  const Physics& physics = scene.physics;
  const double a = scene.particles.reference_radius;
  const double density = scene.particles.density;
  const double a_cubed = a * a * a;
  const double inertial_time = density * a * a / physics.viscosity;

  DerivedGroups groups;
  groups.inertial_time = inertial_time;
  groups.stokes = inertial_time * physics.flow.rate();
  if (physics.flow.rate() > 0) groups.shear_time = 1 / physics.flow.rate();
  if (physics.thermal_energy > 0) {
    groups.brownian_time = physics.viscosity * a_cubed / physics.thermal_energy;
    groups.peclet = 6 * std::numbers::pi * *groups.brownian_time * physics.flow.rate();
    groups.flow_over_rest = flow_over_rest(scene, *groups.peclet);
  }
  if (physics.contact) {
    groups.contact_time = std::sqrt(density * a_cubed / physics.contact->normal_stiffness);
    if (physics.flow.rate() > 0) {
      groups.relative_stiffness =
          physics.contact->normal_stiffness / (physics.viscosity * a * physics.flow.rate());
    }
  }
  return groups;
}

Json to_json(const DerivedGroups& groups) {
  const auto number = [](const std::optional<double>& group) { return group ? Json(*group) : Json(nullptr); };
  return {{"peclet", number(groups.peclet)},
          {"stokes", number(groups.stokes)},
          {"relative_stiffness", number(groups.relative_stiffness)},
          {"contact_time", number(groups.contact_time)},
          {"inertial_time", number(groups.inertial_time)},
          {"brownian_time", number(groups.brownian_time)},
          {"shear_time", number(groups.shear_time)},
          {"flow_over_rest", number(groups.flow_over_rest)}};
}

std::vector<Warning> scene_warnings(const Scene& scene) {
  const DerivedGroups groups = derived_groups(scene);
  std::vector<Warning> warnings;
  if (groups.shear_time) {
    const double ratio = *groups.inertial_time / *groups.shear_time;
    if (reaches(ratio, largest_inertia_over_shear)) {
      warnings.push_back(
          {"inertia-shear",
           fmt::format("inertia is not small beside shear: St = tau_I / tau_S = {:.4g} (tau_I = {:.4g}, "
                       "tau_S = {:.4g}), the bound is {}; the result depends on the particles' mass, a "
                       "smaller density or shear rate cures it",
                       ratio, *groups.inertial_time, *groups.shear_time, largest_inertia_over_shear)});
    }
  }
  if (groups.brownian_time) {
    const double ratio = *groups.inertial_time / *groups.brownian_time;
    if (reaches(ratio, largest_inertia_over_brownian)) {
      warnings.push_back(
          {"inertia-thermal",
           fmt::format("inertia is not small beside Brownian motion: tau_I / tau_B = {:.4g} (tau_I = "
                       "{:.4g}, tau_B = {:.4g}), the bound is {}; particles coast between collisions, "
                       "a smaller density or temperature cures it",
                       ratio, *groups.inertial_time, *groups.brownian_time, largest_inertia_over_brownian)});
    }
  }
  // Of smooth motion in uniform shear half steps tell the error.
  const bool noise = scene.physics.thermal_energy > 0;
  const bool friction = scene.physics.contact && scene.physics.contact->friction > 0;
  if (scene.method == Method::implicit_steps && scene.timestep &&
      (noise || friction || scene.physics.flow.varies())) {
    if (const double excess = *scene.timestep / automatic_timestep(scene); excess > 1) {
      warnings.push_back(
          {"timestep",
           fmt::format("the step is {:.3g} times the automatic one; with {} nothing else tells its "
                       "error: see results/speed-accuracy and results/stability",
                       excess,
                       noise      ? "noise"
                       : friction ? "friction"
                                  : "waves")});
    }
  }
  return warnings;
}

}  // namespace peclet::engine
