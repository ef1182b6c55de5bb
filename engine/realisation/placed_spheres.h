// Reads the initial spheres of a realisation from a file.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "engine/scene/scene.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Relative tolerance of lengths in files with six digits: half of the sixth digit of 1.00000.
inline constexpr double rounding_of_files = 5e-6;

// True if two lengths are equal within that tolerance of `scale`.
inline bool is_near(double a, double b, double scale) { return std::abs(a - b) <= rounding_of_files * scale; }

// The fault of a file without sizes of spheres.
inline constexpr const char* no_sizes =
    "must have particles/diameter, which is absent: HOOMD-blue 4 writes diameters if its GSD.write_diameter "
    "is True";

struct PlacedSpheres {
  System system;           // particles, box, step 0 and time 0; no list and no springs
  bool in_motion = false;  // the file has velocities and spins
};

// Returns the spheres of the frame that the scene's start names for this seed. Requires a scene with a start;
// `file` is the scene's name in messages. Sphere i of the file, by ids, must have the radius of the scene's
// sphere i. The cell must be the scene's box, sheared along x. Both are compared to a relative 5e-6, because
// files of other programs have six digits. Positions are taken unchanged, as are velocities and spins
// (angular velocities) if the file has both. Throws InputError if the file has another hash or does not fit.
PlacedSpheres placed_spheres(const Scene& scene, std::uint64_t seed, const std::string& file);

// Checks the start of a campaign of at most `seeds` seeds, and the spheres of its first seed, before it runs.
// A list must have a line for each seed. Without noise two seeds that begin at one file would be one
// realisation, so one file for all seeds, or a hash twice in a list, is refused. So are contacts that overlap
// by more than the guard allows. Throws InputError.
void check_start_of_campaign(const Scene& scene, const std::string& file, std::int64_t seeds = 1);

}  // namespace peclet::engine
