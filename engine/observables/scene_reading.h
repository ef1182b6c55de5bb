// Reads the document of a scene, with the keys of all observables.
#pragma once

#include <string>

#include "contract/key_table.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Returns all keys of a scene, with those of the observables.
const KeyTable& scene_keys();

// Reads and checks a scene. `file` names it in messages. Throws InputError if the document is not a valid
// scene.
Scene read_scene(const Json& document, const std::string& file);

}  // namespace peclet::engine
