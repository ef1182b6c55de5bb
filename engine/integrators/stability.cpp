#include "engine/integrators/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/errors.h"
#include "engine/kernels/pair_kinds.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/terms/drag.h"
#include "engine/terms/lubrication.h"
#include "engine/terms/spring_laws.h"

namespace peclet::engine {
namespace {

struct SpherePair {
  double first, second;  // radii
  double mass_first, mass_second;
  double mobility;  // 1/m_i + 1/m_j
};

// Returns the largest damping rate of a pair's translations [1/time]: drag, squeezing and dashpot.
double translational_damping(const Physics& physics, const PairResistance& resistance, double damping,
                             const SpherePair& pair) {
  return std::max(translational_drag(physics.viscosity, pair.first) / pair.mass_first,
                  translational_drag(physics.viscosity, pair.second) / pair.mass_second) +
         (resistance.squeeze + damping) * pair.mobility;
}

// Returns an upper bound of the damping rate of a pair's spins [1/time]: their drag (10/3 of the
// translational rate), the trace of the shear and twist modes, and dashpots. It decides only where
// lubrication is weak or absent.
double rotational_damping(const Physics& physics, const PairResistance& resistance, double damping,
                          const SpherePair& pair) {
  const double inertia_first = 0.4 * pair.mass_first * pair.first * pair.first;
  const double inertia_second = 0.4 * pair.mass_second * pair.second * pair.second;
  return std::max(rotational_drag(physics.viscosity, pair.first) / inertia_first,
                  rotational_drag(physics.viscosity, pair.second) / inertia_second) +
         (resistance.shear + damping) * pair.mobility + resistance.twist_first / inertia_first +
         resistance.twist_second / inertia_second;
}

PairRates rates_of_pair(const Scene& scene, const Species& of_first, const Species& of_second) {
  const Physics& physics = scene.physics;
  const double first = of_first.radius, mass_first = mass_of(scene.particles, of_first);
  const double second = of_second.radius, mass_second = mass_of(scene.particles, of_second);
  const SpherePair pair = {first, second, mass_first, mass_second, 1 / mass_first + 1 / mass_second};
  const double mobility = pair.mobility, sum = first + second;
  const PairKind kind = make_pair_kind(physics, first, second);
  PairResistance resistance{};
  if (physics.lubrication) {
    const PairGeometry touching = {{sum, 0, 0}, {1, 0, 0}, sum, sum};
    resistance = pair_resistance(kind.resistance, kind.gap, touching);
  }
  const double normal_damping = physics.contact ? physics.contact->normal_damping : 0;
  const double dashpots = physics.contact ? largest_contact_damping(*physics.contact, first, second) : 0;
  PairRates rates{};
  rates.damping = std::max(translational_damping(physics, resistance, normal_damping, pair),
                           rotational_damping(physics, resistance, dashpots, pair));
  if (physics.contact) {
    rates.frequency_squared = largest_contact_stiffness(*physics.contact, first, second) * mobility;
  }
  rates.frequency_squared += largest_stiffness(kind.conservative, 0, sum) * mobility;
  return rates;
}

double stable_step(const PairRates& rates) {
  const double l = packing_factor * rates.damping, w2 = packing_factor * rates.frequency_squared;
  // 4 / (l + sqrt(l^2 + 4 w^2)) is the positive root of w^2 dt^2 + 2 l dt = 4, also for w = 0.
  return 4 / (l + std::sqrt(l * l + 4 * w2));
}

// Returns drag / stiffness of the conservative laws beyond the range of lubrication, where only the drag of
// single spheres resists them [time]; infinite if they end before.
double time_beyond_lubrication(const Physics& physics, double first, double second) {
  const double sum = first + second;
  const PairKind kind = make_pair_kind(physics, first, second);
  const double stiffness = largest_stiffness(kind.conservative, kind.lubrication_range - sum, sum);
  const double drag_first = translational_drag(physics.viscosity, first);
  const double drag_second = translational_drag(physics.viscosity, second);
  return drag_first * drag_second / (drag_first + drag_second) / stiffness;
}

// Returns the shortest time in which the approach of an attracted pair grows e-fold: resistance / -V'' where
// V'' < 0. The resistance is that of lubrication and of the drag of both spheres. It is infinite without
// attraction. Twelve gaps per decade are tried, from 1e-8 of the sum of radii to the range of all laws.
double time_of_pulling(const Physics& physics, double first, double second) {
  const PairKind kind = make_pair_kind(physics, first, second);
  const double drag_first = translational_drag(physics.viscosity, first);
  const double drag_second = translational_drag(physics.viscosity, second);
  const double drag = drag_first * drag_second / (drag_first + drag_second);
  const double sum = kind.sum_of_radii, ratio = std::pow(10, 1.0 / 12);
  double shortest = std::numeric_limits<double>::infinity();
  for (double h = 1e-8 * sum; sum + h < kind.range; h *= ratio) {
    const double pulling = -potential(kind.conservative, sum + h, sum).stiffness;
    if (!(pulling > 0)) continue;
    double resistance = drag;
    if (physics.lubrication && sum + h <= kind.lubrication_range) {
      const PairGeometry near = {{sum + h, 0, 0}, {1, 0, 0}, sum + h, sum};
      resistance += pair_resistance(kind.resistance, kind.gap, near).squeeze;
    }
    shortest = std::min(shortest, resistance / pulling);
  }
  return shortest;
}

// Returns X_A of a sphere at the outer gap, with the partner for which it is largest.
double largest_resistance_at_the_outer_gap(const Scene& scene, double radius) {
  const Physics& physics = scene.physics;
  double largest = 0;
  for (const Species& partner : scene.particles.species) {
    const PairKind kind = make_pair_kind(physics, radius, partner.radius);
    const double distance = kind.lubrication_range;
    const PairGeometry parting = {{distance, 0, 0}, {1, 0, 0}, distance, kind.sum_of_radii};
    largest = std::max(largest, pair_resistance(kind.resistance, kind.gap, parting).squeeze);
  }
  return largest;
}

// Returns twice the outer gap over the standard deviation of a leap: the way of a sphere relative to a third
// one in the step in which a pair of the sphere leaves the range of lubrication. The pair keeps the noise
// F_B^2 = 2 kT X_A / dt of a resistance that is gone; it moves the sphere by dt F_B / (m / dt + zeta). The
// squared way of a free sphere is dt^2 kT / (m + zeta dt / 2).
double room_over_leap(const Scene& scene, const Species& species, double resistance, double timestep) {
  const double mass = mass_of(scene.particles, species), energy = scene.physics.thermal_energy;
  const double drag = translational_drag(scene.physics.viscosity, species.radius);
  const double inertia = mass + timestep * drag;
  const double parting = 2 * energy * resistance * timestep / (inertia * inertia);
  const double free = energy / (mass + 0.5 * timestep * drag);
  return 2 * outer_distance(*scene.physics.lubrication, 2 * species.radius) /
         (timestep * std::sqrt(parting + 2 * free));
}

// Returns `longest`, or the shorter step in which `deviations` standard deviations of a leap fit.
double step_of_leaps(const Scene& scene, const Species& species, double deviations, double longest) {
  const double resistance = largest_resistance_at_the_outer_gap(scene, species.radius);
  const auto fits = [&](double step) {
    return room_over_leap(scene, species, resistance, step) >= deviations;
  };
  if (fits(longest)) return longest;
  double low = longest;
  do {
    low /= 2;
    // No normal step fits if energies are near the largest numbers; the run then reports the fault.
    if (!std::isnormal(low)) return longest;
  } while (!fits(low));
  double high = 2 * low;
  constexpr int bisections = 48;
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

// Returns the species whose inertia may bound the step. If all have one density it is the smallest one: small
// spheres leap farthest and have the least room.
std::vector<Species> leaping_species(const Particles& particles) {
  const auto has_own = [](const Species& species) { return species.density.has_value(); };
  if (std::ranges::any_of(particles.species, has_own)) return particles.species;
  const auto by_radius = [](const Species& a, const Species& b) { return a.radius < b.radius; };
  return {*std::ranges::min_element(particles.species, by_radius)};
}

// Returns the longer of `step`, bounded by inertia, and `without_inertia`, bounded by leaps of the species.
Timestep step_with_noise_and_lubrication(const Scene& scene, const Timestep& step,
                                         const Timestep& without_inertia) {
  constexpr double leaps = 5;
  const Physics& physics = scene.physics;
  Timestep inertial = step, leaping = without_inertia;
  for (const Species& species : leaping_species(scene.particles)) {
    const double mass = mass_of(scene.particles, species);
    inertial.stay_below(longest_inertial_step(physics.viscosity, physics.thermal_energy, *physics.lubrication,
                                              species.radius, mass),
                        "inertia");
    leaping.stay_below(step_of_leaps(scene, species, leaps, without_inertia.value), "inertia");
  }
  return leaping.value > inertial.value ? leaping : inertial;
}

}  // namespace

PairRates stiffest_pair(const Scene& scene) {
  PairRates stiffest{};
  double smallest_step = std::numeric_limits<double>::infinity();
  for (const Species& first : scene.particles.species) {
    for (const Species& second : scene.particles.species) {
      const PairRates rates = rates_of_pair(scene, first, second);
      if (stable_step(rates) < smallest_step) {
        smallest_step = stable_step(rates);
        stiffest = rates;
      }
    }
  }
  return stiffest;
}

double largest_timestep(const Scene& scene) { return stable_step(stiffest_pair(scene)); }

// Returns a cell of the scene's volume before numbers of spheres are rounded.
PeriodicCell cell_of(const Scene& scene) {
  double shares = 0, volumes = 0;  // number and volume of the spheres, both in the same units
  for (const Species& species : scene.particles.species) {
    const double a = species.radius, volume = 4.0 / 3.0 * std::numbers::pi * a * a * a;
    const bool by_volume = scene.particles.shares == Particles::Shares::volume;
    shares += by_volume ? species.share / volume : species.share;
    volumes += by_volume ? species.share : species.share * volume;
  }
  const double volume = static_cast<double>(scene.particles.count) * volumes / shares;
  return {box_lengths(scene, std::cbrt(volume / scene.volume_fraction)), Matrix3{}};
}

// ImplicitStep is the longest step, as a strain and in times X_A / k, whose error has been measured.
struct ImplicitStep {
  double strain, contact_times;
};

// Returns a strain that shrinks towards jamming, where spheres move farther and many steps would be divided.
double strain_without_noise(const Scene& scene) {
  return std::clamp(0.2 * (0.65 - scene.volume_fraction), 0.002, 0.01);
}

// Returns the strain of a step with noise. Noise widens the layer through which the flow presses a pair to 1
// / Pe of a radius. If that is ten inner gaps xi or more, noise does not shorten steps.
double strain_with_noise(const Scene& scene, double rate, double radius) {
  const Physics& physics = scene.physics;
  constexpr double shortest = 0.005;
  if (!physics.lubrication || !(rate > 0)) return shortest;
  const double work = translational_drag(physics.viscosity, radius) * radius * radius * rate;
  const double layers = work / physics.thermal_energy * physics.lubrication->inner_gap / 0.1;
  const double longest = std::max(shortest, strain_without_noise(scene));
  return std::clamp(0.01 * std::pow(layers, -0.3), shortest, longest);
}

ImplicitStep longest_implicit_step(const Scene& scene, double rate, double smallest_radius) {
  const Physics& physics = scene.physics;
  const bool conservative = required_terms(physics).conservative, noise = physics.thermal_energy > 0;
  if (physics.contact && physics.contact->friction > 0) {
    // True where springs near the middle of the step are too inaccurate, or (with noise) are not taken there.
    const bool demanding = noise || physics.contact->friction > 1 || physics.contact->rolling_stiffness > 0 ||
                           remembers_sliding(*physics.contact);
    return {demanding ? 0.0025 : 0.005, demanding || conservative ? 2.0 : 4.0};
  }
  if (conservative) return {0.005, 5};
  if (noise) return {strain_with_noise(scene, rate, smallest_radius), 7};
  return {strain_without_noise(scene), 20};
}

Timestep automatic_implicit_timestep(const Scene& scene) {
  const Physics& physics = scene.physics;
  constexpr double brownian_times = 0.0017, pushing_times = 20;
  constexpr double inertial_brownian_times = 0.0045;
  Timestep step;
  double smallest = scene.particles.species.front().radius, largest_inertia = 0;  // rho a^2
  for (const Species& species : scene.particles.species) {
    const double a = species.radius;
    smallest = std::min(smallest, a);
    largest_inertia = std::max(largest_inertia, density_of(scene.particles, species) * a * a);
  }
  const double rate = physics.flow.largest_rate(cell_of(scene));
  const auto [strain, contact_times] = longest_implicit_step(scene, rate, smallest);
  if (rate > 0) {
    const double stokes = largest_inertia * rate / physics.viscosity;
    step.stay_below(strain / ((1 + 2 * stokes) * rate), "flow");
  }
  Scene undamped = scene;  // a dashpot does not lengthen the times of the contact's other motions
  if (undamped.physics.contact) undamped.physics.contact->tangential_damping = 0;
  if (const PairRates rates = stiffest_pair(undamped); rates.frequency_squared > 0) {
    step.stay_below(contact_times * rates.damping / rates.frequency_squared, "contacts");
  }
  for (const Species& first : scene.particles.species) {
    for (const Species& second : scene.particles.species) {
      if (physics.lubrication) {
        step.stay_below(pushing_times * time_beyond_lubrication(physics, first.radius, second.radius),
                        "repulsion");
      }
      step.stay_below(time_of_pulling(physics, first.radius, second.radius), "attraction");
    }
  }
  if (!(physics.thermal_energy > 0)) return step;
  const double brownian_time = physics.viscosity * std::pow(smallest, 3) / physics.thermal_energy;
  Timestep without_inertia = step;
  without_inertia.stay_below(brownian_times * brownian_time, "noise");
  if (!physics.lubrication) return without_inertia;
  step.stay_below(inertial_brownian_times * brownian_time, "noise");
  return step_with_noise_and_lubrication(scene, step, without_inertia);
}

Timestep automatic_timestep(const Scene& scene) {
  if (scene.method == Method::implicit_steps) return automatic_implicit_timestep(scene);
  return {0.5 * largest_timestep(scene), "stability"};
}

Timestep resolved_timestep(const Scene& scene, const std::string& file) {
  const Timestep automatic = automatic_timestep(scene);
  if (!scene.timestep) {
    if (!std::isfinite(automatic.value)) {
      throw InputError(file, "/integrator/timestep", "\"auto\"",
                       "must be a number in a scene without flow, temperature, contact and repulsion");
    }
    return automatic;
  }
  if (scene.method == Method::implicit_steps) {
    if (*scene.timestep > largest_over_automatic * automatic.value) {
      throw InputError(file, "/integrator/timestep", fmt::format("{}", *scene.timestep),
                       fmt::format("must be at most {:.4g}, {} times \"auto\" in this scene",
                                   largest_over_automatic * automatic.value, largest_over_automatic));
    }
    return {*scene.timestep, "given"};
  }
  const double largest = largest_timestep(scene);
  if (*scene.timestep > largest) {
    throw InputError(
        file, "/integrator/timestep", fmt::format("{}", *scene.timestep),
        fmt::format("must be at most {:.4g}, the largest stable step of the scene's stiffest pair in a "
                    "dense packing (or \"auto\", half of that)",
                    largest));
  }
  return {*scene.timestep, "given"};
}

}  // namespace peclet::engine
