// Spheres where a file has them: the start of a realisation that follows another one.
#pragma once

#include <cstdint>
#include <string>

#include "engine/scene/scene.h"
#include "engine/state/system.h"

namespace peclet::engine {

struct PlacedSpheres {
  System system;           // particles, box, step 0 and time 0; no list and no springs
  bool in_motion = false;  // the file has velocities and spins
};

// The frame that a scene's start names for this seed. Requires a scene with a start; `file` names it in
// messages. Sphere i of the file, in the order of its ids, has to have the radius of the scene's sphere i,
// and the cell to be the scene's box, sheared along x: both to 5e-6, because files of other programs have six
// digits. Places are taken as they are, and so are velocities and spins (angular velocities) where the file
// has both. Throws InputError where a file is not the one of the hash, or does not fit.
PlacedSpheres placed_spheres(const Scene& scene, std::uint64_t seed, const std::string& file);

// For a campaign of at most `seeds` seeds, before it runs: the same of the first seed. A list has to have a
// line for each of them. Without noise two seeds that begin at one file would be one realisation: a list that
// has a hash twice is refused, and so is one file for all seeds.
void check_start_of_campaign(const Scene& scene, const std::string& file, std::int64_t seeds = 1);

}  // namespace peclet::engine
