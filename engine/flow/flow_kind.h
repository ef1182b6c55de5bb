// A kind of flow: how a scene asks for it, and what of a scene goes together with it. One function for each,
// declared beside the deformation that it reads; all of them are listed in flow_kind.cpp.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/flow/deformation.h"
#include "engine/flow/scene_document.h"

namespace peclet::engine {

// What a flow is read from.
struct FlowSource {
  const SceneDocument& scene;
  double shear_rate = 0;  // of /flow/shear_rate or /peclet; 0 without them
  double viscosity = 0, thermal_energy = 0, volume_fraction = 0;
};

struct FlowKind {
  std::string key;   // by which a scene asks for it: "/flow/segments"
  std::string keys;  // rows of a table
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

// Returns all flows. The first is the flow of a scene that asks for no other: shear at a rate, or a fluid at
// rest.
const std::vector<FlowKind>& flow_kinds();

// Returns the keys of the flows that have this unit of durations: "/flow/oscillation or /flow/cross_shear".
std::string flows_with(const std::string& unit);

// Returns the kind of flow that the scene asks for. Throws InputError where keys of another one stand beside
// it.
const FlowKind& flow_kind_of(const SceneDocument& scene);

ImposedFlow read_flow(const FlowSource& source);

// Rows of a duration by limits in this range, "> 0"; some of them are known to some flows alone. A pointer
// that ends in ? is not required.
std::string duration_keys(const std::string& pointer, const std::string& range, const std::string& meaning);

// Throws InputError where the duration at this place has a limit that the flow does not know.
void check_duration(const SceneDocument& scene, const FlowKind& flow, const std::string& pointer);

}  // namespace peclet::engine
