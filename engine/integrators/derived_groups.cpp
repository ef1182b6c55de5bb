// The groups follow Li (2023), equations 2.7 and 3.55 to 3.58.
#include "engine/integrators/derived_groups.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/flow/controlled_shear.h"
#include "engine/integrators/stability.h"

namespace peclet::engine {

namespace {

// Bounds of tau_I / tau_S and tau_I / tau_B from which on inertia is not small. Published flow curves reach
// the second at low Pe.
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

bool is_steady_shear(const ImposedFlow& flow) {
  return flow.is_steady() && flow.steady_gradient() == simple_shear(flow.rate());
}

std::optional<double> flow_over_rest(const Scene& scene, double peclet) {
  const Physics& physics = scene.physics;
  const double fraction = scene.volume_fraction, jammed = 0.587;
  const bool refused = !is_steady_shear(physics.flow) || !has_known_equilibrium(physics);
  if (refused || !(peclet > 0) || peclet >= nearly_at_rest || fraction >= jammed) return std::nullopt;
  const double viscosity = std::pow(1 - fraction / jammed, -1.5), of_pairs = viscosity - 1 - 2.5 * fraction;
  if (!(of_pairs > 0)) return std::nullopt;
  const double size = std::pow(scene.particles.reference_radius, 3) / mean_sphere_volume(scene.particles);
  return std::pow(6 * std::numbers::pi / peclet, 2) * fraction * size / (300 * viscosity * of_pairs);
}

// Returns true if the ratio reaches the bound, up to rounding.
bool reaches(double ratio, double bound) { return ratio >= bound * (1 - 1e-9); }

double brownian_time(const Physics& physics, double a) {
  return physics.viscosity * (a * a * a) / physics.thermal_energy;
}

double peclet_number(const Physics& physics, double a) {
  return 6 * std::numbers::pi * brownian_time(physics, a) * physics.flow.rate();
}

// Returns the largest f(density, radius) over all sizes; empty without sizes.
template <typename Function>
std::optional<double> largest_of_sizes(const Particles& particles, const Function& f) {
  std::optional<double> largest;
  for (const Species& species : particles.species) {
    const double value = f(density_of(particles, species), species.radius);
    largest = std::max(largest.value_or(value), value);
  }
  return largest;
}

double largest_relative_error(const std::vector<double>& shares, const std::vector<double>& wanted) {
  double largest = 0;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    largest = std::max(largest, std::abs(shares[s] / wanted[s] - 1));
  }
  return largest;
}

void add_mixture_groups(const Scene& scene, DerivedGroups& groups) {
  const Particles& particles = scene.particles;
  const Mixture& mixture = *particles.mixture;
  const std::vector<double> shares = volume_shares(particles, species_numbers(particles));
  groups.volume_fraction = scene.volume_fraction;
  const auto grains = shares.begin() + static_cast<std::ptrdiff_t>(mixture.colloid_species);
  groups.alpha = std::accumulate(grains, shares.end(), 0.0);
  groups.largest_share_error = largest_relative_error(shares, wanted_volume_shares(particles));
  if (scene.physics.thermal_energy > 0) {
    groups.peclet_mean = peclet_number(scene.physics, mixture.mean_radius());
    groups.peclet_grains = peclet_number(scene.physics, mixture.grain_radius);
  }
}

void add_stresses(const Physics& physics, double a, DerivedGroups& groups) {
  if (physics.flow.steady_rate() > 0) groups.viscous_stress = unit_of_stress(physics);
  if (physics.thermal_energy > 0) groups.thermal_stress = physics.thermal_energy / (a * a * a);
  if (physics.contact && physics.contact->critical_load > 0) {
    groups.critical_stress = physics.contact->critical_load / (a * a);
  }
  if (physics.repulsion) groups.repulsion_stress = -of_pair(*physics.repulsion, a, a).slope(0.0) / (a * a);
}

void add_size_moments(const Particles& particles, DerivedGroups& groups) {
  const std::vector<std::size_t> number = species_numbers(particles);
  const auto count = static_cast<double>(particles.count);
  double mean = 0, variance = 0;
  for (std::size_t s = 0; s < number.size(); ++s) {
    mean += static_cast<double>(number[s]) / count * particles.species[s].radius;
  }
  for (std::size_t s = 0; s < number.size(); ++s) {
    const double from_mean = particles.species[s].radius - mean;
    variance += static_cast<double>(number[s]) / count * from_mean * from_mean;
  }
  groups.mean_radius = mean;
  groups.relative_width = std::sqrt(variance) / mean;
}

// The groups in the order of the tables that show them. Without its `only_with` a group is left out.
struct NamedGroup {
  using Value = std::optional<double> DerivedGroups::*;
  const char *name, *words, *symbol, *unit;
  Value value, only_with = nullptr;
};
using Groups = DerivedGroups;
constexpr NamedGroup named_groups[] = {
    {"volume_fraction", "", "φ", "1", &Groups::volume_fraction, &Groups::alpha},
    {"alpha", "share of grains as made", "α_made", "1", &Groups::alpha, &Groups::alpha},
    {"largest_share_error", "share error", "", "1", &Groups::largest_share_error, &Groups::alpha},
    {"mean_radius", "", "⟨a⟩", "length", &Groups::mean_radius, &Groups::mean_radius},
    {"relative_width", "", "", "1", &Groups::relative_width, &Groups::mean_radius},
    {"peclet", "Péclet number", "Pe", "1", &Groups::peclet},
    {"peclet_mean", "Péclet number of the mean radius", "Pe_cg", "1", &Groups::peclet_mean, &Groups::alpha},
    {"peclet_grains", "Péclet number of the grains", "Pe_g", "1", &Groups::peclet_grains, &Groups::alpha},
    {"stokes", "Stokes number", "St", "1", &Groups::stokes},
    {"largest_stokes", "largest Stokes number", "St_max", "1", &Groups::largest_stokes},
    {"relative_stiffness", "", "k̂", "1", &Groups::relative_stiffness},
    {"contact_time", "", "τ_C", "time", &Groups::contact_time},
    {"inertial_time", "", "τ_I", "time", &Groups::inertial_time},
    {"brownian_time", "Brownian time", "τ_B", "time", &Groups::brownian_time},
    {"shear_time", "", "τ_S", "time", &Groups::shear_time},
    {"viscous_stress", "", viscous_stress_symbol, "stress", &Groups::viscous_stress, &Groups::viscous_stress},
    {"thermal_stress", "", "k_B T / a^3", "stress", &Groups::thermal_stress, &Groups::thermal_stress},
    {"critical_stress", "", "F_CL / a^2", "stress", &Groups::critical_stress, &Groups::critical_stress},
    {"repulsion_stress", "", "F_R / a^2", "stress", &Groups::repulsion_stress, &Groups::repulsion_stress},
    {"largest_inertia_over_brownian", "", "(τ_I/τ_B)_max", "1", &Groups::largest_inertia_over_brownian},
    {"flow_over_rest", "flow/rest", "", "1", &Groups::flow_over_rest}};

bool has(const std::vector<Warning>& warnings, const std::string& code) {
  return std::ranges::any_of(warnings, [&](const Warning& warning) { return warning.code == code; });
}

// Warns if inertia is small for the radius of reference, but not for all sizes.
void warn_of_other_sizes(const Scene& scene, const DerivedGroups& groups, std::vector<Warning>& warnings) {
  const auto compare = [&](const char* code, const char* beside, const char* symbol,
                           const std::optional<double>& largest, double bound) {
    if (!largest || !reaches(*largest, bound) || has(warnings, code)) return;
    warn(warnings, code,
         "inertia is small beside {} for the radius {:.4g}, but not for all sizes: {} is up "
         "to {:.4g}, the bound is {}; a smaller density cures it, or densities by size "
         "(/particles/density_rule \"equal-inertia\")",
         beside, scene.particles.reference_radius, symbol, *largest, bound);
  };
  compare("inertia-shear", "shear", "St", groups.largest_stokes, largest_inertia_over_shear);
  compare("inertia-thermal", "Brownian motion", "tau_I / tau_B", groups.largest_inertia_over_brownian,
          largest_inertia_over_brownian);
}

// Warns if w tau_I is not small. In an oscillation this matters at any amplitude.
void warn_of_oscillation(const Scene& scene, std::vector<Warning>& warnings) {
  const std::optional<double> period = scene.physics.flow.period();
  if (!period || has(warnings, "inertia-shear")) return;
  const double frequency = 2 * std::numbers::pi / *period;
  const std::optional<double> largest = largest_of_sizes(scene.particles, [&](double rho, double radius) {
    return rho * radius * radius / scene.physics.viscosity * frequency;
  });
  if (!largest || !reaches(*largest, largest_inertia_over_shear)) return;
  warn(warnings, "inertia-shear",
       "inertia is not small beside the oscillation: rho a^2 w / eta is up to {:.4g}, the bound is "
       "{}; moduli depend on the particles' mass, a smaller density or frequency cures it",
       *largest, largest_inertia_over_shear);
}

// Warns if whole numbers of spheres miss the share of a species by more than a tenth of it.
void warn_of_composition(const Scene& scene, const DerivedGroups& groups, std::vector<Warning>& warnings) {
  constexpr double largest_error = 0.1;
  if (!groups.alpha || *groups.largest_share_error <= largest_error) return;
  const Particles& particles = scene.particles;
  const std::vector<std::size_t> number = species_numbers(particles);
  const std::vector<double> shares = volume_shares(particles, number),
                            wanted = wanted_volume_shares(particles);
  std::size_t worst = 0;
  for (std::size_t s = 1; s < shares.size(); ++s) {
    const auto error = [&](std::size_t k) { return std::abs(shares[k] / wanted[k] - 1); };
    if (error(s) > error(worst)) worst = s;
  }
  warn(warnings, "composition",
       "whole numbers of spheres miss the shares: {} of radius {} have {:.4f} of the "
       "volume, {:.4f} was asked for; alpha is {:.4f} for {:.4f}; a larger "
       "/particles/count cures it",
       number[worst], particles.species[worst].radius, shares[worst], wanted[worst], *groups.alpha,
       particles.mixture->alpha);
}

void warn_of_patience(const Scene& scene, std::vector<Warning>& warnings) {
  const ControlledShear* const flow = scene.physics.flow.deformation().at_stress();
  if (flow == nullptr || notices_jams(scene)) return;
  warn(warnings, "patience",
       "the window of {:.4g} stress times is not longer than the {:.4g} after which a flow that "
       "stands still counts as jammed: flowing and viscosity_of_those_flowing have no value; a "
       "longer /duration/production or a smaller /flow/jammed_viscosity cures it",
       time_of(scene.production, scene) / flow->stress_time(), flow->patience() / flow->stress_time());
}

// Returns the volume fraction of random packings, phi = 0.634 + 0.0658 d + 0.0857 S d^2: d is the standard
// deviation of the radius over its mean, S its skewness (Desmond & Weeks, Phys. Rev. E 90, 022204, 2014).
double densest_random_packing(const Particles& particles) {
  const std::vector<std::size_t> number = species_numbers(particles);
  const auto moment = [&](double centre, int power) {
    double sum = 0;
    for (std::size_t s = 0; s < number.size(); ++s) {
      sum += static_cast<double>(number[s]) * std::pow(particles.species[s].radius - centre, power);
    }
    return sum / static_cast<double>(particles.count);
  };
  const double mean = moment(0, 1), variance = moment(mean, 2), width = std::sqrt(variance) / mean;
  const double skewness = variance > 0 ? moment(mean, 3) / std::pow(variance, 1.5) : 0;
  return 0.634 + 0.0658 * width + 0.0857 * skewness * width * width;
}

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
    groups.brownian_time = brownian_time(physics, a);
    // At a given stress the rate is a result.
    if (physics.flow.deformation().at_stress() == nullptr) {
      groups.peclet = peclet_number(physics, a);
      groups.flow_over_rest = flow_over_rest(scene, *groups.peclet);
    }
  }
  if (physics.contact) {
    groups.contact_time = std::sqrt(density * a_cubed / physics.contact->normal_stiffness);
    if (physics.flow.rate() > 0) {
      groups.relative_stiffness =
          physics.contact->normal_stiffness / (physics.viscosity * a * physics.flow.rate());
    }
  }
  groups.largest_stokes = largest_of_sizes(scene.particles, [&](double rho, double radius) {
    return rho * radius * radius / physics.viscosity * physics.flow.rate();
  });
  if (physics.thermal_energy > 0) {
    groups.largest_inertia_over_brownian = largest_of_sizes(scene.particles, [&](double rho, double radius) {
      return rho * physics.thermal_energy / (physics.viscosity * physics.viscosity * radius);
    });
  }
  add_stresses(physics, a, groups);
  if (scene.particles.mixture) add_mixture_groups(scene, groups);
  if (scene.particles.distributed) add_size_moments(scene.particles, groups);
  return groups;
}

Json to_json(const DerivedGroups& groups) {
  Json json = Json::object();
  for (const NamedGroup& group : named_groups) {
    if (group.only_with == nullptr || groups.*group.only_with)
      json[group.name] = or_null(groups.*group.value);
  }
  return json;
}

Json names_of_groups() {
  Json names = Json::array();
  for (const NamedGroup& group : named_groups) {
    names.push_back({{"name", group.name}, {"symbol", group.symbol}, {"unit", group.unit}});
    if (*group.words != '\0') names.back()["words"] = group.words;
  }
  return names;
}

bool notices_jams(const Scene& scene) {
  const ControlledShear* const flow = scene.physics.flow.deformation().at_stress();
  return flow != nullptr && time_of(scene.production, scene) > flow->patience() * (1 + 1e-9);
}

std::vector<Warning> scene_warnings(const Scene& scene) {
  const DerivedGroups groups = derived_groups(scene);
  std::vector<Warning> warnings;
  if (groups.shear_time) {
    const double ratio = *groups.inertial_time / *groups.shear_time;
    if (reaches(ratio, largest_inertia_over_shear)) {
      warn(warnings, "inertia-shear",
           "inertia is not small beside shear: St = tau_I / tau_S = {:.4g} (tau_I = {:.4g}, "
           "tau_S = {:.4g}), the bound is {}; the result depends on the particles' mass, a "
           "smaller density or shear rate cures it",
           ratio, *groups.inertial_time, *groups.shear_time, largest_inertia_over_shear);
    }
  }
  if (groups.brownian_time) {
    const double ratio = *groups.inertial_time / *groups.brownian_time;
    if (reaches(ratio, largest_inertia_over_brownian)) {
      warn(warnings, "inertia-thermal",
           "inertia is not small beside Brownian motion: tau_I / tau_B = {:.4g} (tau_I = "
           "{:.4g}, tau_B = {:.4g}), the bound is {}; particles coast between collisions, "
           "a smaller density or temperature cures it",
           ratio, *groups.inertial_time, *groups.brownian_time, largest_inertia_over_brownian);
    }
  }
  warn_of_oscillation(scene, warnings);
  warn_of_other_sizes(scene, groups, warnings);
  warn_of_composition(scene, groups, warnings);
  warn_of_patience(scene, warnings);
  // Without noise, friction and waves a comparison with half steps shows the error of a step.
  const bool noise = scene.physics.thermal_energy > 0;
  const bool friction = scene.physics.contact && scene.physics.contact->friction > 0;
  if (scene.method == Method::implicit_steps && scene.timestep &&
      (noise || friction || scene.physics.flow.varies())) {
    if (const double excess = *scene.timestep / automatic_timestep(scene).value; excess > 1) {
      warn(warnings, "timestep",
           "the step is {:.3g} times the automatic one; with {} no other test shows its "
           "error: see results/speed-accuracy and results/stability",
           excess,
           noise      ? "noise"
           : friction ? "friction"
                      : "waves");
    }
  }
  return warnings;
}

namespace {

// Warns if a given stress presses contacts together by more than a result is flagged for (overlap).
void warn_of_soft_contacts_under_stress(const Scene& scene, std::vector<Warning>& warnings) {
  // The mean overlap over a is 14 to 15 times stress a / k_n at phi = 0.45 and 0.56 (results/stress-control).
  constexpr double overlap_by_stress = 15, most = 1e-3;
  const double stress = scene.physics.flow.deformation().at_stress()->stress();
  const double overlap =
      overlap_by_stress * stress * scene.particles.reference_radius / scene.physics.contact->normal_stiffness;
  if (overlap <= most) return;
  warn(warnings, "soft",
       "spheres are soft: the stress presses contacts together by about {:.2g} of a radius, more than "
       "{:g}, so that spheres take up less than their volume fraction; a larger normal_stiffness cures it",
       overlap, most);
}

// Half of the effect of friction is reached where stress a^2 is this part of sqrt(k_n k_B T), a sixth at a
// third and nine tenths at ten times that (results/friction-repulsion for phi = 0.45 to 0.53,
// results/mixtures-noise for k_n that differ 60-fold).
constexpr double onset_over_thermal_load = 0.03;

// Returns the stress near which friction sets in only because contacts are as soft as they are; empty without
// noise or friction. Thermal motion opens contacts that are pressed by much less than sqrt(k_n k_B T), so
// that the onset goes with k_n, unless a repulsion or a critical load holds spheres apart up to a larger
// force; it is then empty, too.
std::optional<double> onset_of_friction_by_softness(const Scene& scene) {
  const Physics& physics = scene.physics;
  if (!(physics.thermal_energy > 0) || !physics.contact || !(physics.contact->friction > 0)) return {};
  const std::optional<Mixture>& mixture = scene.particles.mixture;
  const double a = mixture && mixture->alpha > 0 ? mixture->grain_radius : scene.particles.reference_radius;
  const double load =
      onset_over_thermal_load * std::sqrt(physics.contact->normal_stiffness * physics.thermal_energy);
  const double repulsion = physics.repulsion ? -of_pair(*physics.repulsion, a, a).slope(0.0) : 0;
  if (std::max(repulsion, physics.contact->critical_load) > load) return {};
  return load / (a * a);
}

// Warns if friction sets in near the stress of this flow only because contacts are as soft as they are.
void warn_of_softness_at_onset_of_friction(const Scene& scene, std::vector<Warning>& warnings) {
  const std::optional<double> onset = onset_of_friction_by_softness(scene);
  if (!onset) return;
  const Physics& physics = scene.physics;
  const ControlledShear* const held = physics.flow.deformation().at_stress();
  const double unit = held != nullptr ? held->stress() : physics.viscosity * physics.flow.rate();
  // At a given rate the viscosity is not known; that of suspensions that friction may thicken is 3 to 100.
  const auto [least, most] = held != nullptr ? std::pair(0.1, 10.0) : std::pair(3.0, 100.0);
  const double units = *onset / unit;
  if (!(least < units && units < most)) return;
  warn(warnings, "soft",
       "thermal motion opens soft contacts, so that friction sets in near the stress {:g} "
       "sqrt(normal_stiffness k_B T) / a^2, here {:.2g} times {}: see whether four times the "
       "normal_stiffness or explicit steps change the viscosity, or give the repulsion that decides it",
       onset_over_thermal_load, units, held != nullptr ? "the given one" : "viscosity rate");
}

// Warns if the radius of reference is the first one of a distribution, far from the mean: few want its Pe.
void warn_of_first_radius(const Scene& scene, std::vector<Warning>& warnings) {
  constexpr double largest_difference = 0.1;
  const Particles& particles = scene.particles;
  const double a = particles.reference_radius;
  const std::optional<double> mean = derived_groups(scene).mean_radius;
  const bool is_first = a == particles.species.front().radius;
  if (!mean || !is_first || std::abs(a / *mean - 1) <= largest_difference) return;
  warn(warnings, "radius",
       "the radius a of Pe, St and all groups is {:.4g}, the first one of the distribution, and the mean is "
       "{:.4g}: /particles/reference_radius chooses another one",
       a, *mean);
}

// Warns if the flow presses spheres together by so much more or less than the critical load that friction
// acts at all contacts or at none: mostly a load in other units.
void warn_of_critical_load(const Scene& scene, std::vector<Warning>& warnings) {
  constexpr double furthest = 1e4;
  const Physics& physics = scene.physics;
  if (!physics.contact || !(physics.contact->friction > 0) || !(physics.contact->critical_load > 0)) return;
  const ControlledShear* const held = physics.flow.deformation().at_stress();
  const double stress = held != nullptr ? held->stress() : physics.viscosity * physics.flow.rate();
  if (!(stress > 0)) return;
  const double a = scene.particles.reference_radius;
  const double loads = stress * a * a / physics.contact->critical_load;
  if (1 / furthest <= loads && loads <= furthest) return;
  warn(warnings, "critical-load",
       "{} is {:.2g} times the critical_load, so that friction acts {}: is the load in the units of the "
       "scene?",
       held != nullptr ? "stress a^2" : "viscosity rate a^2", loads,
       loads > 1 ? "at every contact" : "at none but the hardest contacts");
}

}  // namespace

std::vector<Warning> warnings_before_run(const Scene& scene) {
  // At phi = 0.40 the mean overlap is 0.6, 0.4 and 0.2 % of a radius at k_hat = 10^3, 5 10^3 and 2 10^4. In
  // dense suspensions some overlaps reach the 5 % that ends a realisation.
  constexpr double stiff = 1e4;
  const Physics& physics = scene.physics;
  std::vector<Warning> warnings;
  warn_of_first_radius(scene, warnings);
  warn_of_critical_load(scene, warnings);
  if (const double densest = densest_random_packing(scene.particles);
      !scene.start && scene.volume_fraction > densest) {
    warn(warnings, "packing",
         "random packings of these spheres reach a volume fraction of about "
         "{:.3f} (Desmond & Weeks 2014); at {:.4g} seeds are likely to end "
         "with the cause packing",
         densest, scene.volume_fraction);
  }
  if (physics.contact && physics.flow.deformation().at_stress() != nullptr) {
    warn_of_soft_contacts_under_stress(scene, warnings);
  } else if (const std::optional<double> stiffness = derived_groups(scene).relative_stiffness;
             stiffness && *stiffness < stiff) {
    warn(warnings, "soft",
         "spheres are soft: normal_stiffness / (viscosity a rate) = {:.4g}, below {:g} contacts "
         "overlap visibly; dense suspensions then end with the cause overlap, others flow as "
         "softer ones; a larger normal_stiffness cures it",
         *stiffness, stiff);
  }
  warn_of_softness_at_onset_of_friction(scene, warnings);
  return warnings;
}

void warn_of_step_at_onset_of_friction(const Scene& scene, double timestep, double stress,
                                       std::vector<Warning>& warnings) {
  // At the onset eta_r is 19 % too high at the automatic step, 12 and 5 % at a quarter and a sixteenth of it.
  // At 0.15 and 7 times the onset no error is seen. The factor 3 is a choice between.
  constexpr double near = 3, fine = 1.0 / 64;
  if (scene.method != Method::implicit_steps) return;
  const std::optional<double> onset = onset_of_friction_by_softness(scene);
  if (!onset || !(stress > *onset / near && stress < *onset * near)) return;
  if (timestep <= fine * automatic_timestep(scene).value * (1 + 1e-9)) return;
  warn(warnings, "timestep",
       "friction sets in near this stress, {:.2g} times {:g} sqrt(normal_stiffness k_B T) / a^2, because "
       "thermal motion opens soft contacts. Long implicit steps keep too many closed: at the automatic one "
       "the viscosity may be a fifth too high. Explicit steps, or 1/{:g} of the automatic one, are better.",
       stress / *onset, onset_over_thermal_load, 1 / fine);
}

}  // namespace peclet::engine
