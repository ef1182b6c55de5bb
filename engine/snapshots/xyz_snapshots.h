// Frames of extended XYZ: what this program leaves (final.xyz, `peclet-engine trajectory`), and what others
// write in the same columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// The texts of the frames: a line with the number of spheres, one with Lattice and Properties, and one for
// each sphere. `file` names the text in messages. Throws InputError where a frame is not whole.
std::vector<std::string_view> xyz_frames(std::string_view text, const std::string& file);

// Reads one of these frames. Asks for a Lattice, pos:R:3 and radius:R:1; takes id:I:1, by which spheres are
// sorted, type:S:1 or species:S:1, velo:R:3, angular_velocity:R:3, image:I:3, stress:R:6 and contacts:I:1,
// and of the second line Origin, Step, Time, Strain and Velocity_gradient. Other columns and keys are passed
// over. Throws InputError, also for what check_snapshot() refuses.
Snapshot read_xyz_frame(std::string_view frame, const std::string& file);

}  // namespace peclet::engine
