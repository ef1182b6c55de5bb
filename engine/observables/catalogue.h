// The observables that a scene asks for.
#pragma once

#include <memory>
#include <vector>

#include "engine/observables/kinds.h"

namespace peclet::engine {

// Throws InputError where box or window are too small for an observable that the scene asks for.
void check_observables(const Scene& scene, const Window& window, const std::string& file);

// What they measure in a window that is completed.
std::vector<Quantity> observed_quantities(const Scene& scene, const Window& window);

// Those that the scene asks for, once it has been checked.
std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          const Window& window);

}  // namespace peclet::engine
