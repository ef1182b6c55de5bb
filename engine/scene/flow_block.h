// The blocks fluid, flow and limits of a scene, and its Peclet number: how the solvent moves.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/keys.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_document.h"

namespace peclet::engine {

Keys flow_keys();

// What /flow says by itself; a fluid at rest where a Peclet number or a stress sets the rate.
ImposedFlow read_flow(const SceneDocument& scene);

// Rate and temperature where they follow from a Peclet number within limits, and the flow at a given stress.
void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics);

// What forbids the observable of this name in the flow of the scene; nothing where nothing does.
std::optional<std::string> fault_of_observable(const SceneDocument& scene, const std::string& name);

// Rules of /duration that a flow brings, at one of its phases.
void check_duration_of_flow(const SceneDocument& scene, const std::string& pointer);

}  // namespace peclet::engine
