// An observable: a measurement besides the stress, sampled during the production window.
//
// Each observable is one file with its class, its keys and a function that returns its ObservableKind. The
// list in observable.cpp names this function.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/flow/scene_document.h"
#include "engine/kernels/pair_kinds.h"
#include "engine/kernels/pair_pass.h"
#include "engine/observables/accumulators.h"
#include "engine/scene/scene.h"
#include "engine/snapshots/gsd_file.h"

namespace peclet::engine {

// The production window.
struct Window {
  double timestep = 0;
  std::uint64_t steps = 0;
  Vector3 box{};  // edges

  double volume() const { return box.x * box.y * box.z; }
};

// The run that an observable is made for.
struct Plan {
  const Scene& scene;
  const Window& window;
  std::uint64_t interval;  // steps between samples; the first sample is at the first step of the window
  const std::string& file;

  double time_between() const { return window.timestep * static_cast<double>(interval); }
  std::uint64_t samples() const { return (window.steps - 1) / interval + 1; }

  // Throws InputError, in the name of this observable, if the window has fewer samples.
  void need_samples(const char* name, std::uint64_t least) const;
};

class Observable : public Accumulators {
 public:
  // Constructors register quantities. They throw InputError if the box or the window is too small.
  explicit Observable(const Plan& plan) : interval_(plan.interval) {}
  virtual ~Observable() = default;

  std::uint64_t interval() const { return interval_; }
  // Override both to take the flux of momentum of every step of the window.
  virtual bool takes_flux() const { return false; }
  virtual void take_flux(const MomentumFlux& /*flux*/) {}
  // Returns the watcher that receives the pairs of each sampled step before sample(), or null.
  virtual PairWatcher* watcher() { return nullptr; }
  // Requires a complete step (integrator.h). `block` counts the 32 blocks of the window from 0. Throws
  // ScriptError if a script of the user fails.
  virtual void sample(const System& /*system*/, std::size_t /*block*/) {}
  // Returns the processor time that other processes have spent for it since the last call [s].
  virtual double take_seconds() { return 0; }
  // Returns the frames that are written beside the result, or null.
  virtual gsd::Frames* frames() { return nullptr; }

 private:
  std::uint64_t interval_;
};

using MakeFromPlan = std::function<std::unique_ptr<Observable>(const Plan&)>;

// Returns a maker of observables of this class, whose constructor takes a plan and these settings.
template <class Measured, class... Settings>
MakeFromPlan maker(const Settings&... settings) {
  return [=](const Plan& plan) { return std::make_unique<Measured>(plan, settings...); };
}

enum class Sampling {
  of_every_step,  // without a key for the interval
  often,          // at every step unless the scene has an interval
  seldom,         // at every 256th of the window unless the scene has an interval: costly, changing slowly
  rarely          // at every 64th: as costly as several steps
};

struct ObservableKind {
  std::string name;
  std::string meaning;  // follows the name in the list of all
  Sampling sampling = Sampling::seldom;
  bool interval_is_a_duration = false;  // in strain, Brownian times or time; else it is a time
  std::string settings{};               // key rows of the block "/NAME", without its interval
  std::vector<std::string> numbers{};   // numbers of the result that are not below its name
  // Reads the settings. Throws InputError if they or the observable do not suit the scene.
  MakeFromPlan (*read)(const SceneDocument& document, const Scene& scene);

  bool has_settings() const { return sampling != Sampling::of_every_step || !settings.empty(); }
};

// The kinds of observables, each in a file of this folder.
ObservableKind mean_squared_displacement();
ObservableKind stress_correlation();
ObservableKind pair_distribution();
ObservableKind contact_network();
ObservableKind fabric();
ObservableKind profiles();
ObservableKind linear_response();
ObservableKind oscillation();
ObservableKind transient();
ObservableKind trajectory();
ObservableKind measure();

const std::vector<ObservableKind>& observable_kinds();

// Makes the observables that the scene lists. Throws InputError if box or window are too small for one.
std::vector<std::unique_ptr<Observable>> make_observables(const Scene& scene, const Window& window,
                                                          const std::string& file);

// Throws InputError unless the thermal energy is > 0 and the fluid is at rest.
void require_rest(const SceneDocument& document, const Scene& scene, const char* name);

// Throws InputError if lubrication has the form mari, whose stress is not that of the forces alone.
void require_stress_of_forces(const SceneDocument& document, const Scene& scene, const char* name);

// Returns the distinct radii in ascending order, one for each size class.
std::vector<double> radii_in(const Scene& scene);

// Returns the kinds of pairs of these size classes.
std::vector<PairKind> pair_kinds_in(const Scene& scene);

}  // namespace peclet::engine
