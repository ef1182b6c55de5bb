#include "engine/scene/observable_keys.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/document/keys.h"
#include "engine/flow/flows.h"
#include "engine/scene/scene.h"

namespace peclet::engine {
namespace {

constexpr double most_bins = 1000;

std::optional<ObservableFault> none(const Scene&, const Json&) { return std::nullopt; }

std::optional<ObservableFault> not_at_rest(const Scene& scene, const char* name) {
  const bool rests = scene.physics.flow.rate() == 0 && !scene.physics.flow.varies();
  if (rests && scene.physics.thermal_energy > 0) return std::nullopt;
  return ObservableFault{
      "/observables",
      fmt::format("must not list {} unless the thermal energy is > 0 and the fluid at rest", name)};
}

std::optional<ObservableFault> must_rest(const Scene& scene, const Json&) {
  return not_at_rest(scene, "stress_correlation");
}

std::optional<ObservableFault> must_have_equilibrium(const Scene& scene, const Json&) {
  if (std::optional<ObservableFault> fault = not_at_rest(scene, "linear_response")) return fault;
  const std::string reason = lacking_equilibrium(scene.physics);
  if (reason.empty()) return std::nullopt;
  return ObservableFault{"/observables", "must not list linear_response with " + reason};
}

std::optional<ObservableFault> must_have_whole_bins(const Scene&, const Json& settings) {
  const double bins = settings.at("range").get<double>() / settings.at("bin").get<double>();
  if (std::abs(bins - std::round(bins)) <= 1e-9 * bins && bins >= 1 && bins <= most_bins) return std::nullopt;
  return ObservableFault{"/pair_distribution/bin",
                         fmt::format("must divide /pair_distribution/range, which is {}, into 1 to {} equal "
                                     "parts",
                                     shortened(settings.at("range")), most_bins)};
}

std::optional<ObservableFault> must_touch(const Scene& scene, const Json&) {
  if (scene.physics.contact) return std::nullopt;
  return ObservableFault{"/observables", "must not list contact_network without /contact"};
}

std::optional<ObservableFault> must_have_contacts(const Scene& scene, const Json& settings) {
  if (scene.physics.contact || !settings.at("contacts").get<bool>()) return std::nullopt;
  return ObservableFault{"/trajectory/contacts", "must be false without /contact"};
}

std::optional<ObservableFault> must_be_of_forces_alone(const Scene& scene, const char* name) {
  if (!scene.physics.lubrication || scene.physics.lubrication->form != LubricationParameters::Form::mari) {
    return std::nullopt;
  }
  return ObservableFault{
      "/observables",
      fmt::format("must not list {} with /lubrication/form mari: its stress is not that of the forces alone",
                  name)};
}

std::optional<ObservableFault> must_oscillate(const Scene& scene, const Json&) {
  if (scene.physics.flow.period()) return must_be_of_forces_alone(scene, "oscillation");
  return ObservableFault{"/observables", "must not list oscillation without " + flows_with("cycles")};
}

std::vector<ObservableEntry> entries() {
  return {
      {"mean_squared_displacement", "of each species", "one step", {}, none},
      {"stress_correlation",
       "of the structural Brownian stress of a fluid at rest, and the viscosity by Green and Kubo",
       "one step",
       {},
       must_rest},
      {"pair_distribution",
       "g(r) and g(x, y)",
       "a 256th of the production window",
       {with_default(positive("/pair_distribution/range", "reference radius",
                              "Largest distance; at most half of the shortest edge of the box, in a cube at "
                              "rest 0.707 of it."),
                     4),
        with_default(positive("/pair_distribution/bin", "reference radius",
                              "Width of a bin; a whole number of them, at most 1000, makes up the range."),
                     0.1),
        with_default(positive("/pair_distribution/slab", "reference radius",
                              "Distance |z| below which a pair counts for g(x, y)."),
                     0.1)},
       must_have_whole_bins},
      {"contact_network",
       "contacts of a particle, mobilised friction",
       "a 256th of the production window",
       {},
       must_touch},
      {"profiles",
       "by y: volume fraction, of each radius too, velocity and its variance, stress by term, and the "
       "balance of momentum",
       "a 256th of the production window",
       {with_default({.pointer = "/profiles/bins",
                      .kind = KeyKind::integer,
                      .meaning = "Equal bins of the box along y.",
                      .minimum = 1,
                      .maximum = most_bins},
                     20)},
       none},
      {"linear_response",
       "the viscosity of a fluid at rest, exactly, from the flux of momentum of every step; its curves over "
       "time "
       "and frequency",
       "",
       {},
       must_have_equilibrium},
      {"oscillation",
       "G' and G'' of an oscillating shear, and the third harmonic of the stress; with cross_shear of the "
       "stress "
       "across",
       "",
       {},
       must_oscillate},
      {"transient",
       "shear stress, normal stress differences and pressure over the strain, or time, of the window",
       "",
       {with_default({.pointer = "/transient/bins",
                      .kind = KeyKind::integer,
                      .meaning = "Equal parts of the production window.",
                      .minimum = 1,
                      .maximum = most_bins},
                     50)},
       [](const Scene& scene, const Json&) { return must_be_of_forces_alone(scene, "transient"); }},
      {"trajectory",
       "trajectory.gsd beside the result, with places, motion and stress of each sphere in every frame",
       "a 256th of the production window",
       {with_default({.pointer = "/trajectory/contacts",
                      .kind = KeyKind::boolean,
                      .meaning = "Whether frames list the contacts, with their forces."},
                     false)},
       must_have_contacts,
       /*interval_is_a_duration=*/true},
  };
}

}  // namespace

std::string lacking_equilibrium(const Physics& physics) {
  if (physics.contact && physics.contact->friction > 0) {
    return "/contact/friction > 0: friction leads to no equilibrium of known probabilities";
  }
  if (physics.contact && physics.contact->normal_damping > 0) {
    return "/contact/normal_damping > 0: what it dissipates no noise gives back";
  }
  if (physics.lubrication && physics.lubrication->form == LubricationParameters::Form::mari) {
    return "/lubrication/form mari: its stress is not that of the forces alone";
  }
  return "";
}

const std::vector<ObservableEntry>& observable_entries() {
  static const std::vector<ObservableEntry> all = entries();
  return all;
}

std::vector<Key> observable_keys() {
  std::string meaning = "stress: the tensor, split by term, which is always there.";
  std::vector<std::string> names{"stress"};
  Keys blocks;
  for (const ObservableEntry& entry : observable_entries()) {
    meaning += fmt::format(" {}: {}.", entry.name, entry.meaning);
    names.push_back(entry.name);
    if (!entry.has_settings()) continue;
    blocks.push_back(block('/' + entry.name, "How the observable of that name is measured."));
    const std::string interval = fmt::format("/{}/interval", entry.name);
    const std::string unless_given = fmt::format("in whole steps; {} unless given.", entry.usual_interval);
    if (entry.interval_is_a_duration) {
      const Keys limits =
          duration_keys(interval, "From one to the next, " + unless_given, positive, /*is_required=*/false);
      blocks.insert(blocks.end(), limits.begin(), limits.end());
    } else if (!entry.usual_interval.empty()) {
      blocks.push_back(positive(interval, "time", "Time between samples, " + unless_given));
    }
    blocks.insert(blocks.end(), entry.settings.begin(), entry.settings.end());
  }
  blocks.insert(blocks.begin(), choice("/observables/*", meaning, names));
  return blocks;
}

}  // namespace peclet::engine
