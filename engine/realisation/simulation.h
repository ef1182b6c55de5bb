// The time loop of one realisation.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/observables/observable.h"
#include "engine/observables/production.h"
#include "engine/realisation/driver.h"

namespace peclet::engine {

// What is known of the errors that the finite step makes.
struct StepErrors {
  double largest_stability_share = 0;  // of all checks
  double spurious_energy = 0;          // summed over samples in the production window
  std::uint64_t samples = 0;
  Integrator::HalfSteps half_steps{};  // summed over samples in the production window, without noise
  // Of all steps of the production window.
  std::uint64_t solver_iterations = 0;
  double sum_of_solver_residuals = 0, largest_solver_residual = 0;
  std::uint64_t divided_steps = 0;
  std::uint64_t deepest_division = 0;  // the smallest part was 2^-deepest_division of its step
};

class Simulation {
 public:
  // Spheres without places: start() or load() comes next. Throws InputError where the box is smaller than the
  // range of the forces.
  Simulation(const Scene& scene, const Schedule& schedule, std::uint64_t seed, int threads,
             const std::string& file);

  // Packs the spheres, gives them the streaming flow's velocities (and thermal ones) and evaluates the first
  // forces. Throws PackingError.
  void start(const std::function<void()>& made_step = [] {});

  // Goes on from another system of the same scene: its particles, box and step. Contacts begin without
  // springs; spheres that are not in motion get the velocities of a fresh start. Throws std::invalid_argument
  // for another number of particles.
  void start(const System& placed, bool in_motion = true);

  // Up to `steps` more steps; returns how the realisation ended once it has. It ends too where the packing
  // has become too stiff for the step: checked before the first step and every few thousand.
  std::optional<Ending> advance(std::uint64_t steps);

  const System& system() const { return system_; }
  // Where it jams before the window begins, the window begins there.
  const Schedule& schedule() const { return schedule_; }
  const Production& production() const { return production_; }
  const std::vector<std::unique_ptr<Observable>>& observables() const { return observables_; }
  const StepErrors& step_errors() const { return errors_; }
  double largest_overlap() const { return largest_overlap_; }  // over the smaller radius, in production

  // Strains are summed over both directions; at a given stress they are net.
  Strains strains() const { return driver_->strains(system_, schedule_); }
  const Driver& driver() const { return *driver_; }

  // What an observable writes beside the result; null: nothing.
  gsd::Frames* frames();

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);
  // Of what save() has written that alone on which further steps depend. Of a realisation of the same motion,
  // whatever its windows and observables are; nothing has been measured afterwards.
  void load_motion(ArchiveReader& archive);

 private:
  void begin();
  void load_system(ArchiveReader& archive);
  PairWatcher* watchers_of_step();
  // Before each step: returns how the realisation ends where the packing has become too stiff for the step.
  // Looks at the first step and every few thousand.
  std::optional<Ending> check_stability();
  void observe(const StepReport& report);
  // Returns the interval, shortened so that each block of a short window has its samples.
  std::uint64_t at_most_a_block(std::uint64_t interval) const {
    return std::min(interval, schedule_.production / count_of_blocks);
  }
  // Notes the energy that the step makes, and how far the stress of steps is from that of half steps.
  void note_errors(std::uint64_t index, const StepReport& report);

  Scene scene_;
  Schedule schedule_;
  std::uint64_t seed_;
  int threads_;
  System system_;
  Matrix3 edges_at_start_;  // of the cell, from which strain counts; a start in a file may be sheared
  std::vector<PairKind> kinds_;
  std::unique_ptr<Driver> driver_;
  std::unique_ptr<Integrator> integrator_;
  Production production_;
  std::vector<std::unique_ptr<Observable>> observables_;  // that the scene asks for
  PairWatchers watchers_;                                 // of the step to come
  StepErrors errors_;
  double smallest_radius_;
  double largest_overlap_ = 0;
};

}  // namespace peclet::engine
