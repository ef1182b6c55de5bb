// A kind of flow: how a scene asks for it, and what of a scene goes together with it. One function for each,
// declared beside the deformation that it reads; all of them are listed in flows.cpp.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/document/keys.h"
#include "engine/document/scene_document.h"
#include "engine/flow/deformation.h"

namespace peclet::engine {

// What a flow is read from.
struct FlowSource {
  const SceneDocument& scene;
  double shear_rate = 0;  // of /flow/shear_rate or /peclet; 0 without them
  double viscosity = 0, thermal_energy = 0, volume_fraction = 0;
};

struct FlowKind {
  std::string key;  // by which a scene asks for it: "/flow/segments"
  Keys keys;
  // Requires a scene that has the key. Throws InputError where its keys do not go together.
  std::shared_ptr<const Deformation> (*read)(const FlowSource& source);

  std::vector<std::string> beside{};  // other keys of flows that a scene may have with it
  std::string unit{};                 // of durations, that a flow needs for it: "cycles", "stress_times"
  std::string without_strain{};       // why no duration is a strain; empty: strains are durations
  bool has_whole_cycles = false;      // in both phases of a realisation, whatever is measured
  double largest_strain = std::numeric_limits<double>::infinity();  // of a realisation
  std::string own_cell{};  // "a turned cube"; empty: the box of the scene, which may come from a file
  std::vector<std::string> refused_observables{};
};

}  // namespace peclet::engine
