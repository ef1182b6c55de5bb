// FlowKind tells how a scene asks for a kind of flow and what else such a scene may have. Each kind is
// returned by a function beside its deformation; flow_kind.cpp lists them all.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/flow/deformation.h"
#include "engine/flow/scene_document.h"

namespace peclet::engine {

// FlowSource holds the values that a flow is read from.
struct FlowSource {
  const SceneDocument& scene;
  double shear_rate = 0;  // [1/time], from /flow/shear_rate or /peclet; 0 without them
  double viscosity = 0, thermal_energy = 0, volume_fraction = 0;
};

struct FlowKind {
  std::string key;   // asks for this flow, such as "/flow/segments"
  std::string keys;  // rows of the table of keys
  // Reads the deformation from a scene that has the key. Throws InputError if its keys contradict each other.
  std::shared_ptr<const Deformation> (*read)(const FlowSource& source);

  std::vector<std::string> beside{};  // keys of other flows that the scene may have with it
  std::string unit{};                 // unit of durations that needs this flow: "cycles", "stress_times"
  std::string without_strain{};       // why durations cannot be strains; empty: they can
  bool has_whole_cycles = false;      // both phases last whole cycles, whatever is measured
  double largest_strain = std::numeric_limits<double>::infinity();  // limit of a realisation
  std::string own_cell{};  // the shape that the flow gives the cell, "a turned cube"; empty: the scene's box
  std::vector<std::string> refused_observables{};
};

// Returns all kinds of flow. The first one, shear at a given rate, is the default; its rate may be 0.
const std::vector<FlowKind>& flow_kinds();

// Returns the keys of the flows with this unit of durations: "/flow/oscillation or /flow/cross_shear".
std::string flows_with(const std::string& unit);

// Returns the scene's kind of flow. Throws InputError if the scene has a key that this kind excludes.
const FlowKind& flow_kind_of(const SceneDocument& scene);

// Reads the flow of a scene, waves included. Throws InputError.
ImposedFlow read_flow(const FlowSource& source);

// Returns the rows of a duration, which may have a limit in each of its units. `range` is the range of the
// limits, "> 0".
std::string duration_keys(const std::string& pointer, const std::string& range, const std::string& meaning);

// Throws InputError if the duration at this pointer has a limit whose unit the flow lacks.
void check_duration(const SceneDocument& scene, const FlowKind& flow, const std::string& pointer);

}  // namespace peclet::engine
