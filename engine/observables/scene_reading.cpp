#include "engine/observables/scene_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/flow/flow_kind.h"
#include "engine/observables/observable.h"

namespace peclet::engine {
namespace {

// Returns the number of samples in the window if the scene has no interval; 0: one at each step.
std::uint64_t samples_unless_given(Sampling sampling) {
  if (sampling == Sampling::seldom) return 256;
  return sampling == Sampling::rarely ? 64 : 0;
}

// Returns the key rows of "/observables/*" and of the settings of all observables.
std::string observable_keys() {
  std::string meaning = "stress: the stress tensor by term, always measured.", names = "stress", blocks;
  for (const ObservableKind& kind : observable_kinds()) {
    meaning += fmt::format(" {}: {}.", kind.name, kind.meaning);
    names += ", " + kind.name;
    if (!kind.has_settings()) continue;
    blocks += fmt::format("/{0}? | object | Settings of the observable {0}.\n", kind.name);
    const std::string interval = fmt::format("/{}/interval?", kind.name);
    const std::string unless_given = fmt::format(
        "in whole steps; {} unless given.",
        samples_unless_given(kind.sampling) == 0
            ? "one step"
            : fmt::format("a {}th of the production window", samples_unless_given(kind.sampling)));
    if (kind.interval_is_a_duration) {
      blocks += fmt::format(
          "{} | object; as /duration/production | Interval between samples, {} The shortest of its limits "
          "counts; at least one is required.\n",
          interval, unless_given);
    } else if (kind.sampling != Sampling::of_every_step) {
      blocks += fmt::format("{} | number > 0; in time | Time between samples, {}\n", interval, unless_given);
    }
    blocks += kind.settings + '\n';
  }
  return fmt::format("/observables/* | one of {} | {}\n{}", names, meaning, blocks);
}

// Returns the steps between samples, at least 1 and at most 1e18, which is longer than any window.
std::uint64_t steps_between(Sampling sampling, const std::optional<double>& interval, const Window& window) {
  if (interval) {
    return static_cast<std::uint64_t>(std::clamp(std::round(*interval / window.timestep), 1.0, 1e18));
  }
  const std::uint64_t samples = samples_unless_given(sampling);
  return samples == 0 ? 1 : std::max<std::uint64_t>(1, window.steps / samples);
}

void read_observable(const ObservableKind& kind, const SceneDocument& document, Scene& scene) {
  const FlowKind& flow = flow_kind_of(document);
  if (std::ranges::count(flow.refused_observables, kind.name) > 0) {
    document.refuse("/observables", "must not list {} with {}: it does not support this flow", kind.name,
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

// Reads the observables that the scene lists. Refuses settings of observables that are not listed. Defaults
// of settings that are left out do not become part of the scene.
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
      try {
        filled[kind.name] = scene_keys().validate(Json::object(), "", '/' + kind.name);
      } catch (const InputError& error) {
        throw error.within(file, '/' + kind.name);
      }
    }
    read_observable(kind, document, scene);
  }
}

}  // namespace

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
