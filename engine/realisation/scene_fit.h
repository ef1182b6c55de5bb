// Whether spheres, box and observables of a scene go together.
#pragma once

#include <string>

#include "engine/realisation/schedule.h"

namespace peclet::engine {

// What can be known without placing a sphere, in no more time and memory than a few milliseconds and bytes
// for the largest scene. Throws InputError where a species has no sphere, where the box is smaller than the
// range of the forces, and where an observable does not fit.
void check_fit(const Scene& scene, const Schedule& schedule, const std::string& file);

}  // namespace peclet::engine
