// Frames of a GSD file of the schema "hoomd", of this program or another one.
#pragma once

#include "engine/snapshots/gsd_file.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// A frame of an open file. As the schema has it, what a frame lacks is that of the first frame, if this has
// as many spheres, and else the schema's default: diameter 1, and no motion. Throws InputError for what is
// not of the schema, and for what check_snapshot() refuses.
Snapshot read_gsd_frame(const gsd::Reader& file, std::uint64_t frame);

}  // namespace peclet::engine
