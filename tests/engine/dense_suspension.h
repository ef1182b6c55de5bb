// A sheared suspension with contacts, near pairs, springs and particles outside the cell, for evaluations.
#pragma once

#include "engine/forces/configuration.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Returns parameters with exactly these terms, of the size in Table 4.1 of Li (2023), at shear rate 0.7.
Physics physics_with(const Terms& terms);

// Returns `count` spheres of radii 1 and 1.4 at volume fraction 0.52, in a box tilted by 0.31 of its edge.
// Gaps scatter around zero and velocities around the flow. Every contact has springs of about its overlap,
// and a third of the particles lies outside the cell. The list is up to date.
System dense_suspension(const Physics& physics, std::size_t count, std::uint64_t seed);

// Returns the system as a configuration without noise; springs are named by the images of the list.
Configuration configuration_of(const System& system, const Physics& physics);

}  // namespace peclet::engine
