// The one place that judges what files say of spheres.
#pragma once

#include <string>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// Throws InputError naming `file` if a number of the snapshot cannot be computed with as what it is:
//   lattice vectors: linearly independent, of lengths from 1e-30 to 1e30, none shorter across the others than
//     a millionth of the longest one;
//   centres and corner: within a million cells of the origin, so that a cell can be counted in an integer;
//   radii: from a millionth of the longest edge to that edge;
//   other numbers: finite, at most 1e30 in magnitude; a time, unless it is 0, at least 1e-30;
//   names of stresses: letters, digits, '_', '-' and '/';
//   contacts: between two spheres that are there, pushing apart or not at all.
// Requires lists of as many entries as there are spheres, or none.
void check_snapshot(const Snapshot& snapshot, const std::string& file);

}  // namespace peclet::engine
