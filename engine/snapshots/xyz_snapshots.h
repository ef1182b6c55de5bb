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

// One of these. Asks for pos:R:3, radius:R:1 and a Lattice whose first vector is along x and whose second one
// is in the plane of x and y; takes id:I:1, by which spheres are sorted, species:S:1, velo:R:3,
// angular_velocity:R:3, image:I:3, stress:R:6 and contacts:I:1, and of the second line Origin, Step, Time and
// Strain. Other columns are passed over. Throws InputError.
Snapshot read_xyz_frame(std::string_view frame, const std::string& file);

}  // namespace peclet::engine
