// Brings the script of measurements into a scene, so that the scene is whole wherever it is computed.
//
// A person writes the name of a file at /measure/script. Programs that read a file add the text of the script
// at /measure/text. Text and name are then part of the scene and of its hash: another script makes another
// point, and the scene needs no file on the machine that computes it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "contract/json.h"

namespace peclet {

// Longest script [bytes].
constexpr std::size_t longest_script = std::size_t{1} << 16;

// Adds the text of the script that `scene` names, relative to `folder`, unless the scene names none or has
// the text. Throws InputError at `pointer` + "/measure/script" of `file` if the script cannot be read, is too
// long or is not in UTF-8.
void add_script(Json& scene, const std::filesystem::path& folder, const std::string& file,
                const std::string& pointer);

}  // namespace peclet
