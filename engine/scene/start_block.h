// The block start of a scene: where spheres begin, if not where a packing puts them.
#pragma once

#include <optional>
#include <string>

#include "engine/flow/scene_document.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

inline Keys start_keys() {
  return {
      block("/start",
            "Where the spheres begin: at a frame of a file with the same spheres and the same cell, which "
            "may be "
            "sheared; absent: in a random packing. Strain and time count from there."),
      {.pointer = "/start/file",
       .kind = KeyKind::string,
       .meaning =
           "Absolute path of a trajectory (GSD) or a final configuration (extended XYZ), at which every "
           "seed begins. In a campaign only with noise, which alone tells these seeds apart.",
       .required = true},
      {.pointer = "/start/list",
       .kind = KeyKind::string,
       .meaning =
           "Absolute path of a list of such files, as sha256sum writes it: seed k begins at the file of "
           "line k + 1. Seeds beyond it fail.",
       .required = false,
       .instead_of = "file"},
      {.pointer = "/start/sha256",
       .kind = KeyKind::string,
       .meaning =
           "SHA-256 of the file or the list, as sha256sum prints it: the point is that of this content, "
           "and another one is refused.",
       .required = true},
      {.pointer = "/start/frame",
       .kind = KeyKind::integer,
       .meaning = "Frame of the file, from 0; -1 is the last one, -2 the one before it.",
       .default_value = -1,
       .minimum = -1'000'000'000,
       .maximum = 1'000'000'000},
  };
}

inline bool is_sha256(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

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
  if (!is_sha256(start.sha256)) {
    scene.refuse("/start/sha256", "must be 64 digits and letters a to f, as sha256sum prints it");
  }
  return start;
}

}  // namespace peclet::engine
