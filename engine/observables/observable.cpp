#include "engine/observables/observable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/errors.h"
#include "engine/flow/flow_kind.h"

namespace peclet::engine {
namespace {

// Returns the rows of all blocks and of "/observables/*".
std::string observable_keys() {
  std::string meaning = "stress: the tensor, split by term, which is always there.", names = "stress", blocks;
  for (const ObservableKind& kind : observable_kinds()) {
    meaning += fmt::format(" {}: {}.", kind.name, kind.meaning);
    names += ", " + kind.name;
    if (!kind.has_settings()) continue;
    blocks += fmt::format("/{}? | object | How the observable of that name is measured.\n", kind.name);
    const std::string interval = fmt::format("/{}/interval?", kind.name);
    const std::string unless_given =
        fmt::format("in whole steps; {} unless given.",
                    kind.sampling == Sampling::often ? "one step" : "a 256th of the production window");
    if (kind.interval_is_a_duration) {
      blocks += duration_keys(interval, "> 0", "From one to the next, " + unless_given);
    } else if (kind.sampling != Sampling::of_every_step) {
      blocks += fmt::format("{} | number > 0; in time | Time between samples, {}\n", interval, unless_given);
    }
    blocks += kind.settings + '\n';
  }
  return fmt::format("/observables/* | one of {} | {}\n{}", names, meaning, blocks);
}

// Steps between samples, one at least. A time that is longer than any window is never again.
std::uint64_t steps_between(Sampling sampling, const std::optional<double>& interval, const Window& window) {
  constexpr std::uint64_t seldom_samples = 256;
  if (interval) {
    return static_cast<std::uint64_t>(std::clamp(std::round(*interval / window.timestep), 1.0, 1e18));
  }
  return sampling == Sampling::seldom ? std::max<std::uint64_t>(1, window.steps / seldom_samples) : 1;
}

void read_observable(const ObservableKind& kind, const SceneDocument& document, Scene& scene) {
  const FlowKind& flow = flow_kind_of(document);
  if (std::ranges::count(flow.refused_observables, kind.name) > 0) {
    document.refuse("/observables", "must not list {} with {}, whose flow it does not know", kind.name,
                    flow.key);
  }
  const MakeFromPlan make = kind.read(document, scene);
  std::optional<double> interval;
  if (const std::string pointer = fmt::format("/{}/interval", kind.name); document.has(pointer)) {
    interval = kind.interval_is_a_duration ? time_of(read_duration(document, pointer, scene.physics), scene)
                                           : document.number(pointer);
  }
  scene.observables[kind.name] = [=, sampling = kind.sampling](const Scene& of, const Window& window,
                                                               const std::string& file) {
    return make({of, window, steps_between(sampling, interval, window), file});
  };
}

// A block of settings is refused where its observable is not listed. The defaults of a block that is left out
// are no part of the scene.
void read_observables(const std::string& file, Scene& scene) {
  Json filled = scene.document;
  const SceneDocument document(filled, file);
  const Json list = filled.at("observables");
  for (const ObservableKind& kind : observable_kinds()) {
    const bool has_block = kind.has_settings() && filled.contains(kind.name);
    if (std::find(list.begin(), list.end(), kind.name) == list.end()) {
      if (has_block) document.refuse('/' + kind.name, "must be left out unless /observables lists it");
      continue;
    }
    if (kind.has_settings() && !has_block) {
      filled[kind.name] = scene_keys().validate(Json::object(), file, '/' + kind.name);
    }
    read_observable(kind, document, scene);
  }
}

}  // namespace

const std::vector<ObservableKind>& observable_kinds() {
  static const std::vector<ObservableKind> all{mean_squared_displacement(),
                                               stress_correlation(),
                                               pair_distribution(),
                                               contact_network(),
                                               fabric(),
                                               profiles(),
                                               linear_response(),
                                               oscillation(),
                                               transient(),
                                               trajectory()};
  return all;
}

std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const Window& window,
                                                          const std::string& file) {
  std::vector<std::unique_ptr<Observable>> made;
  for (const auto& [name, make] : scene.observables) made.push_back(make(scene, window, file));
  return made;
}

void Plan::need_samples(const char* name, std::uint64_t least) const {
  if (samples() >= least) return;
  throw InputError(file, fmt::format("/{}/interval", name), fmt::format("{} samples", samples()),
                   fmt::format("must leave at least {} samples in the production window of {} steps", least,
                               window.steps));
}

void require_rest(const SceneDocument& document, const Scene& scene, const char* name) {
  const bool rests = scene.physics.flow.rate() == 0 && !scene.physics.flow.varies();
  if (rests && scene.physics.thermal_energy > 0) return;
  document.refuse("/observables", "must not list {} unless the thermal energy is > 0 and the fluid at rest",
                  name);
}

void require_stress_of_forces(const SceneDocument& document, const Scene& scene, const char* name) {
  const auto& lubrication = scene.physics.lubrication;
  if (!lubrication || lubrication->form != LubricationParameters::Form::mari) return;
  document.refuse("/observables",
                  "must not list {} with /lubrication/form mari: its stress is not that of the forces alone",
                  name);
}

std::vector<double> radii_in(const Scene& scene) {
  std::vector<double> radii;
  for (const Species& species : scene.particles.species) radii.push_back(species.radius);
  return distinct_radii(radii);
}

std::vector<PairKind> pair_kinds_in(const Scene& scene) {
  return make_pair_kinds(scene.physics, radii_in(scene));
}

const KeyTable& scene_keys() {
  static const KeyTable table = scene_keys_with(observable_keys());
  return table;
}

Scene read_scene(const Json& document, const std::string& file) {
  Scene scene = read_without_observables(scene_keys().validate(document, file), file);
  read_observables(file, scene);
  return scene;
}

}  // namespace peclet::engine
