// Converts trajectories to texts: the verb `peclet-engine trajectory`.
#pragma once

#include <string>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// Returns a frame of a LAMMPS dump in a triclinic cell (https://docs.lammps.org/Howto_triclinic.html), with
// the bounds of a box around the tilted cell. Columns: id (from 1), type (from 1), x y z, ix iy iz, radius
// and, if the frame has them, vx vy vz, omegax omegay omegaz, stress_xx yy zz xy xz yz (V sigma_i), contacts.
// The unwrapped position is
//   x + ix A1 + iy A2 + iz A3
// also after changes of the basis of the cell. Requires a cell that is not turned.
std::string lammps_frame(const Snapshot& snapshot);

// Returns a frame of extended XYZ: Lattice, Origin, Step and, if the frame has them, Time, Strain,
// Velocity_gradient and the stresses of the cell, stress_TERM; columns as in read_xyz_frame().
std::string xyz_frame(const Snapshot& snapshot);

// Returns the components, separated by blanks, so that they are read back bit by bit.
std::string spaced(const Vector3& vector);

struct ConversionOptions {
  std::string file;
  std::string format;  // "lammps", "xyz", or empty: by the ending of the output
  std::string output;  // empty for standard output
  std::string frames = "0:-1";
};

// Converts the chosen frames, all of which are read before the first is written. Returns a note for the user,
// or an empty text. Throws InputError or std::system_error.
std::string convert_trajectory(const ConversionOptions& options);

}  // namespace peclet::engine
