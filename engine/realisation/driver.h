// What takes a system from step to step: an integrator, whose flow has the rate of its scene or is given one
// by what holds a stress.
#pragma once

#include <memory>

#include "engine/integrators/integrator.h"
#include "engine/realisation/ending.h"
#include "engine/realisation/schedule.h"

namespace peclet::engine {

// Strains of the steps before the window and in it.
struct Strains {
  double equilibration = 0, production = 0;
};

class Driver {
 public:
  virtual ~Driver() = default;

  // Begins with this system, before the first step.
  virtual void start(const System& /*system*/) {}
  // Makes one step. `watcher` sees its pairs; it may be null.
  virtual StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) = 0;
  // Returns how the realisation ends after the last step, if the driver ends it. May let the window begin
  // earlier.
  virtual std::optional<Ending> ending(const System& /*system*/, Schedule& /*schedule*/) {
    return std::nullopt;
  }
  // Counts the strain of the window from here on.
  virtual void begin_window(const System& /*system*/) {}
  virtual Strains strains(const System& system, const Schedule& schedule) const = 0;

  virtual void save(ArchiveWriter& /*archive*/) const {}
  virtual void load(const System& /*system*/, ArchiveReader& /*archive*/) {}
};

// Returns the driver of a scene's flow. At a given stress the scene gets a flow of its own, whose rate the
// driver sets: integrators are made afterwards.
std::unique_ptr<Driver> make_driver(Scene& scene, double timestep, std::uint64_t seed);

}  // namespace peclet::engine
