// All observables, and those that a scene asks for. Another one is a line here, a file with its class and an
// entry in engine/scene/observable_keys.cpp.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/observables/kinds.h"
#include "engine/responses/responses.h"

namespace peclet::engine {

inline std::array<ObservableKind, 9> observable_kinds() {
  return {
      mean_squared_displacement(), stress_correlation(), pair_distribution(), contact_network(), profiles(),
      linear_response(),           oscillation(),        transient(),         trajectory()};
}

// Throws InputError where box or window are too small for an observable that the scene asks for.
void check_observables(const Scene& scene, const Window& window, const std::string& file);

// What they measure in a window that is completed.
std::vector<Quantity> observed_quantities(const Scene& scene, const Window& window);

// Those that the scene asks for, once it has been checked.
std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          const Window& window);

}  // namespace peclet::engine
