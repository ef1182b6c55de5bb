// The blocks fluid, flow and limits of a scene, and its Peclet number: how the solvent moves.
#pragma once

#include "engine/document/keys.h"
#include "engine/document/scene_document.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

Keys flow_keys();

// Sets the flow of a scene whose fluid and laws have been read; rate and temperature where they follow from a
// Peclet number within limits. Throws InputError where no flow is given.
void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics);

}  // namespace peclet::engine
