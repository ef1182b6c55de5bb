// Drives an integrator step by step, either in the flow of the scene or at a given stress.
#pragma once

#include <memory>

#include "engine/flow/controlled_shear.h"
#include "engine/integrators/integrator.h"
#include "engine/realisation/schedule.h"

namespace peclet::engine {

// Strains of the steps before the production window and in it.
struct Strains {
  double equilibration = 0, production = 0;
};

// Makes the steps of a realisation. A driver that sets the flow overrides the optional functions.
class Driver {
 public:
  virtual ~Driver() = default;

  // Called before the first step.
  virtual void start(const System& /*system*/) {}
  // Makes one step and shows its pairs to `watcher`, which may be null.
  virtual StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) = 0;
  // Returns the ending of the realisation if the driver ends it after the last step. May move the beginning
  // of the window in `schedule` to an earlier step.
  virtual std::optional<Ending> ending(const System& /*system*/, Schedule& /*schedule*/) {
    return std::nullopt;
  }
  // Counts the strain of the production window from here on.
  virtual void begin_window(const System& /*system*/) {}
  virtual Strains strains(const System& system, const Schedule& schedule) const = 0;

  virtual void save(ArchiveWriter& /*archive*/) const {}
  virtual void load(const System& /*system*/, ArchiveReader& /*archive*/) {}
};

// Returns the driver for a scene. At a given stress it replaces the flow of `scene` by a copy whose rate the
// driver sets, so integrators must be made afterwards.
std::unique_ptr<Driver> make_driver(Scene& scene, double timestep, std::uint64_t seed);

// Steps at a given shear stress. The strain gamma is a coordinate of its own; its rate is constant during a
// step. sigma is the stress sigma_xy of all terms, solvent included.
//
// Without noise the strain has no inertia: the rate of each step is the one at which sigma is the given
// stress. A step at a trial rate gives sigma. If it misses the stress, the step is repeated at a rate
// corrected with the slope d sigma / d rate. Later steps make up for the remaining deficit.
//
// With noise the strain has an inertia M:
//
//   M d^2 gamma / dt^2 = V (stress - sigma + noise)
//   variance of the noise: 2 kT eta (1 + 2.5 phi) / (V dt)
//   M = V t_r (d sigma / d rate)
//
// V is the volume of the cell, dt the step. The noise is that of solvent and stresslets, whose viscosity is
// eta (1 + 2.5 phi); pairs have noise of their own. At stress 0 the rate has the variance kT / M, and gamma
// diffuses with kT / (V eta eta_r), as the fluctuation-dissipation theorem demands for the strain of a
// periodic cell. The response time t_r is the time of a strain of 0.05, at least 5 and at most 20 steps. M is
// measured before the first step and at the steps 1, 2, 4, 8 ...
//
// When the rate changes, velocities of spheres change with the flow (integrators/integrator.h): forces do not
// depend on the origin.
class StressControl final : public Driver {
 public:
  // `shear` must be the flow of the integrator's physics.
  StressControl(const Scene& scene, std::shared_ptr<ControlledShear> shear, double timestep,
                std::uint64_t seed);

  void start(const System& system) override { wait_from(system); }
  // Makes one step and completes it.
  StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) override;
  // If the system jams before the window, the window begins now; if in the window, the realisation ends.
  std::optional<Ending> ending(const System& system, Schedule& schedule) override;
  void begin_window(const System& system) override { strain_at_window_ = system.box.strain(); }
  // Returns net strains.
  Strains strains(const System& system, const Schedule& schedule) const override;

  // Returns M / V of the last step; 0 before the first step, and without noise.
  double inertia() const { return inertia_; }

  void save(ArchiveWriter& archive) const override;
  void load(const System& system, ArchiveReader& archive) override;

 private:
  StepReport advance_to_stress(Integrator& integrator, System& system, PairWatcher* watcher);
  StepReport advance_with_inertia(Integrator& integrator, System& system, PairWatcher* watcher);
  void find_inertia(Integrator& integrator, System& system);
  // Returns true if the system has not strained by `least_strain` within the patience of the flow.
  bool has_jammed(const System& system);
  // Restarts the waiting time for `least_strain`.
  void wait_from(const System& system);
  StepReport step(Integrator& integrator, System& system, double rate);
  // Returns sigma_xy of a step without solvent and stresslets; with noise the stress that acts on the strain.
  double stress_of_pairs(const StepReport& report, const System& system) const;

  std::shared_ptr<ControlledShear> shear_;
  double timestep_, stress_, thermal_energy_;
  double trial_rate_;  // rate at which the slope is measured, with noise
  double response_;    // response time of the rate, with noise
  double solvent_;     // eta (1 + 2.5 phi)
  std::uint64_t seed_;

  double rate_;         // of the last step, the first guess for the next; with noise, of the next step
  double slope_;        // d sigma / d rate
  double deficit_ = 0;  // given stress minus sigma, summed over steps
  double inertia_ = 0;
  double strain_waited_from_ = 0, time_waited_from_ = 0;
  double strain_at_window_ = 0;
};

}  // namespace peclet::engine
