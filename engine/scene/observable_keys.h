// What a scene may ask for besides the stress: the name in /observables and the block of the same name. One
// entry of the list in observable_keys.cpp for each; engine/observables/kinds.h has what is done for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/key_table.h"

namespace peclet::engine {

struct Scene;

// What is wrong with a scene that asks for an observable: where, and what is allowed there.
struct ObservableFault {
  std::string pointer, allowed;
};

struct ObservableEntry {
  std::string name;
  std::string meaning;         // behind its name in the list of all
  std::string usual_interval;  // between samples: "one step"; empty: all steps count, whatever the scene says
  std::vector<Key> settings;   // in the block "/NAME", besides its interval
  // Rules that bind several keys; nothing where the scene keeps them. `settings` have their defaults.
  std::optional<ObservableFault> (*fault)(const Scene& scene, const Json& settings);

  bool interval_is_a_duration = false;  // in strain, Brownian times or time; else it is a time

  bool has_settings() const { return !usual_interval.empty() || !settings.empty(); }
};

const std::vector<ObservableEntry>& observable_entries();

// The keys of all blocks, and the choices of "/observables/*".
std::vector<Key> observable_keys();

}  // namespace peclet::engine
