// Which observables there are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/observables/observable.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Throws InputError where the cubic box is too small, or the production window of so many steps too short,
// for an observable that the scene asks for.
void check_observables(const Scene& scene, double edge, double timestep, std::uint64_t steps,
                       const std::string& file);

// Names of the numbers that they add to a result's mean, at which a campaign may aim.
std::vector<std::string> names_of_numbers(const Scene& scene);

// Those that the scene asks for, once it has been checked.
std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const System& system,
                                                          double timestep, std::uint64_t steps);

}  // namespace peclet::engine
