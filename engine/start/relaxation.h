// The start of a realisation: a packing whose repulsion is about to throw it apart.
#pragma once

#include <functional>

#include "engine/scene/scene.h"
#include "engine/state/system.h"

namespace peclet::engine {

// Lets repulsion and contacts move the spheres, without flow, noise and friction, until an automatic implicit
// step moves none of them by more than a twentieth of the smallest radius. A step that moves one further is
// taken back and made a quarter as long; the step after a good one is twice as long. After two hundred steps
// the packing stays as far as it came. Both methods relax alike, so that a seed is one packing. Changes
// positions, the order of the particles in memory and the list; velocities are zero afterwards. Calls
// `made_step` after every step.
void relax(
    System& system, const Scene& scene, int threads, const std::function<void()>& made_step = [] {});

}  // namespace peclet::engine
