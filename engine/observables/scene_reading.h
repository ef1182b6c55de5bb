// The document of a scene: its keys, with those of all observables, and what they mean.
#pragma once

#include <string>

#include "contract/key_table.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

const KeyTable& scene_keys();

// Reads and checks a scene. `file` names it in messages. Throws InputError.
Scene read_scene(const Json& document, const std::string& file);

}  // namespace peclet::engine
