// Trajectories as texts: the verb `peclet-engine trajectory`.
#pragma once

#include <string>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// A frame of LAMMPS' dump in a triclinic cell (https://docs.lammps.org/Howto_triclinic.html): the bounds are
// those of a box that holds the tilted cell. Columns: id (from 1), type (from 1), x y z, ix iy iz, radius,
// and what the frame has of vx vy vz, omegax omegay omegaz, stress_xx yy zz xy xz yz (V sigma_i), contacts. x
// + ix A1 + iy A2 + iz A3 is the way that a sphere has gone, also where the basis of the cell changes.
// Requires a cell that is not turned.
std::string lammps_frame(const Snapshot& snapshot);

// A frame of extended XYZ: Lattice, Origin, Step and, where the frame has them, Time, Strain,
// Velocity_gradient and the stresses of the cell, stress_TERM; columns as read_xyz_frame() takes them.
std::string xyz_frame(const Snapshot& snapshot);

// Returns the components, parted by blanks, so that they are read back bit by bit.
std::string spaced(const Vector3& vector);

struct ConversionOptions {
  std::string file;
  std::string format;  // "lammps", "xyz"; empty: what the name of the output ends in
  std::string output;  // empty: standard output
  std::string frames = "0:-1";
};

// Reads every frame that is chosen before anything is written. Returns what there is to say of the file, if
// anything. Throws InputError, std::system_error.
std::string convert_trajectory(const ConversionOptions& options);

}  // namespace peclet::engine
