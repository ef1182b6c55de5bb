// What takes a system from step to step: an integrator, whose flow has the rate of its scene or is given one
// by what holds a stress.
#pragma once

#include <memory>

#include "engine/flow/controlled_shear.h"
#include "engine/integrators/integrator.h"
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

// Steps at a given shear stress: the strain gamma is a coordinate of its own, and its rate, constant in each
// step, is what the stress makes of it. sigma is the stress sigma_xy of all terms, solvent included.
//
// Without noise the strain has no inertia: the rate of a step is the one at which sigma is the given stress.
// A step at a guessed rate tells sigma; while it is off, the step is made again at the rate that the slope
// d sigma / d rate leads to. What is left is made up for by the steps that follow.
//
// With noise M d2gamma/dt2 = V (stress - sigma), and solvent and stresslets, of the viscosity eta (1 + 2.5
// phi), bring a noise of variance 2 kT eta (1 + 2.5 phi) / (V dt) with them, as pairs bring theirs. So at
// stress 0 the rate has the variance kT / M, and gamma diffuses with kT / (V eta eta_r): the theorem of
// fluctuation and dissipation for the strain of a periodic cell. M is small enough for the rate to follow
// within twenty steps or a strain of 0.05, and so large that a step changes little of it. It is that of the
// packing at hand, found again at the steps 1, 2, 4, 8 ...
//
// What a rate gains its spheres gain (integrators/integrator.h): no force depends on where the origin is.
class StressControl final : public Driver {
 public:
  // `shear` is that of the integrator's physics.
  StressControl(const Scene& scene, std::shared_ptr<ControlledShear> shear, double timestep,
                std::uint64_t seed);

  void start(const System& system) override { wait_from(system); }
  // The step is complete.
  StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) override;
  // A system that jams before the window is measured in it from then on; one that stands still in the window
  // ends there.
  std::optional<Ending> ending(const System& system, Schedule& schedule) override;
  void begin_window(const System& system) override { strain_at_window_ = system.box.strain(); }
  // Net strains.
  Strains strains(const System& system, const Schedule& schedule) const override;

  // M / V of the last step; 0 before the first one, and without noise.
  double inertia() const { return inertia_; }

  void save(ArchiveWriter& archive) const override;
  void load(const System& system, ArchiveReader& archive) override;

 private:
  StepReport advance_to_stress(Integrator& integrator, System& system, PairWatcher* watcher);
  StepReport advance_with_inertia(Integrator& integrator, System& system, PairWatcher* watcher);
  void find_inertia(Integrator& integrator, System& system);
  // Returns whether the system has not strained by `least_strain` within the patience of the flow.
  bool has_jammed(const System& system);
  // Begins to wait for the strain of a system that flows.
  void wait_from(const System& system);
  // One step at this rate.
  StepReport step(Integrator& integrator, System& system, double rate);
  // The stress of a step at that rate, without solvent and stresslets.
  double stress_of_pairs(const StepReport& report, const System& system) const;

  std::shared_ptr<ControlledShear> shear_;
  double timestep_, stress_, thermal_energy_;
  double trial_rate_;  // at which a slope is measured with noise
  double response_;    // the time in which the rate follows a stress with noise
  double solvent_;     // eta (1 + 2.5 phi)
  std::uint64_t seed_;

  double rate_;         // of the next step, as far as it is known
  double slope_;        // d sigma / d rate
  double deficit_ = 0;  // of the stress, summed over steps
  double inertia_ = 0;
  double strain_waited_from_ = 0, time_waited_from_ = 0;
  double strain_at_window_ = 0;
};

}  // namespace peclet::engine
