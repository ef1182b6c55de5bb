// The spheres of a realisation as a text that other programs draw and go on from.
#pragma once

#include <string>

#include "engine/state/system.h"

namespace peclet::engine {

// Extended XYZ: the number of spheres; a line with the three lattice vectors of the deformed cell, the
// columns, time, strain and the columns of the velocity gradient; then of each sphere its number for life, by
// which they are sorted, the centre, the radius, the velocity and the angular velocity, in the units of the
// scene. Numbers are read back as they were, bit by bit. A centre may lie outside of the cell; its velocity
// is that of the image there.
std::string extended_xyz(const System& system);

}  // namespace peclet::engine
