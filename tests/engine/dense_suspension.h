// A sheared suspension with contacts, near pairs, springs and particles outside the cell: something to
// evaluate terms on.
#pragma once

#include "engine/forces/configuration.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Parameters for exactly these terms, of the size that Table 4.1 of Li (2023) has them, at rate 0.7.
Physics physics_with(const Terms& terms);

// `count` spheres of radii 1 and 1.4 at volume fraction 0.52 in a box tilted by 0.31 of its edge. Gaps
// scatter around zero; velocities scatter around the streaming flow; every contact has springs of about its
// overlap; a third of the particles stands in other images of the cell. The list is up to date.
System dense_suspension(const Physics& physics, std::size_t count, std::uint64_t seed);

// The system as a configuration, without noise; springs under the images of the list.
Configuration configuration_of(const System& system, const Physics& physics);

}  // namespace peclet::engine
