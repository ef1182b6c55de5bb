// What an observable of a scene is made of (its keys: engine/scene/observable_keys.cpp). All of them are
// listed in catalogue/catalogue.h.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/observables/observable.h"
#include "engine/observables/quantity.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// The production window that is measured in.
struct Window {
  double timestep = 0;
  std::uint64_t steps = 0;
  Vector3 box{};  // its edges
};

// One observable; `settings` are its block in the scene with its defaults.
struct ObservableKind {
  const char* name;
  // Steps between samples unless the scene says otherwise; one at least is taken.
  std::uint64_t (*usual_interval)(const Window& window);
  // Throws InputError where box or window are too small for what the scene asks for.
  void (*check)(const Scene& scene, const Window& window, const std::string& file);
  // What a completed window has measured, with all values of the axes.
  std::vector<Quantity> (*quantities)(const Scene& scene, const Window& window);
  // Requires a scene that has been checked.
  std::unique_ptr<Observable> (*make)(const Scene& scene, const System& system, const Window& window);
};

ObservableKind mean_squared_displacement();
ObservableKind pair_distribution();
ObservableKind contact_network();
ObservableKind profiles();
ObservableKind trajectory();

// Of an observable that is sampled at every step, or that costs a walk over all pairs and changes slowly.
std::uint64_t every_step(const Window& window);
std::uint64_t seldom(const Window& window);

// Steps between the samples of an observable that the scene asks for.
std::uint64_t interval_of(const Scene& scene, const ObservableKind& kind, const Window& window);

// The distinct radii, ascending, as the size classes of the spheres are: of every species there is one.
std::vector<double> radii_in(const Scene& scene);

// Throws InputError when the window has fewer samples of the observable.
void need_samples(const Scene& scene, const ObservableKind& kind, const Window& window, std::uint64_t least,
                  const std::string& file);

}  // namespace peclet::engine
