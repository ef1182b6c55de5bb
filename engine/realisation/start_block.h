// Writes the keys of a scene that begins with the spheres of a file: the verb `peclet-engine start`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/measured_sizes.h"

namespace peclet::engine {

struct StartOptions {
  std::vector<std::string> files;  // one for each seed, or one for all
  std::string list;                // file to write with hashes and paths; "": none
  std::int64_t frame = -1;
};

// Returns the keys of a scene for these spheres: count and radii (six digits), volume fraction, height of the
// box if it is no cube, and the start with its hash. With a list writes one, as sha256sum does. Throws
// InputError for a file that no scene can begin with, for one whose spheres or cell are not those of the
// first, and for several files without a list.
WrittenKeys start_block(const StartOptions& options);

}  // namespace peclet::engine
