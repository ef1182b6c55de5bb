// The block start of a scene: where spheres begin, if not where a packing puts them.
#pragma once

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

inline constexpr const char* start_keys = R"(
/start? | object | Where the spheres begin: at a frame of a file with the same spheres and the same cell,
    which may be sheared; absent: in a random packing. Strain and time count from there.
/start/file | string | Absolute path of a trajectory (GSD) or a final configuration (extended XYZ), at which
    every seed begins. In a campaign only with noise, which alone tells these seeds apart.
/start/list | string; instead of file | Absolute path of a list of such files, as sha256sum writes it: seed k
    begins at the file of line k + 1. Seeds beyond it fail.
/start/sha256 | hash | SHA-256 of the file or the list, as sha256sum prints it: the point is that of this
    content, and another one is refused.
/start/frame | integer >= -1000000000 and <= 1000000000; default -1 | Frame of the file, from 0; -1 is the
    last one, -2 the one before it.
)";

// Requires the block.
inline Start read_start(const SceneDocument& scene) {
  Start start;
  start.is_list = scene.has("/start/list");
  start.path = scene.at(start.pointer()).get<std::string>();
  start.sha256 = scene.at("/start/sha256").get<std::string>();
  start.frame = scene.at("/start/frame").get<std::int64_t>();
  if (!start.path.starts_with('/')) {
    scene.refuse(start.pointer(), "must be an absolute path: engines work in other folders");
  }
  return start;
}

}  // namespace peclet::engine
