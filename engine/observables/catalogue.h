// Which observables there are.
#pragma once

#include <memory>
#include <vector>

#include "engine/observables/observable.h"
#include "engine/scene.h"

namespace peclet::engine {

// Those that the scene asks for, for a production window of so many steps. Throws InputError where the box is
// too small or the window too short for one of them.
std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          double timestep, std::uint64_t steps,
                                                          const std::string& file);

}  // namespace peclet::engine
