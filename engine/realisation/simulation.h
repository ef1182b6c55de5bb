// Runs the time loop of one realisation.
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

// Errors of the finite step.
struct StepErrors {
  double largest_stability_share = 0;  // Integrator::stability_share(), over all checks
  double spurious_energy = 0;          // summed over samples in the production window
  std::uint64_t samples = 0;
  Integrator::HalfSteps half_steps{};  // summed over samples in the production window, without noise
  // Solver statistics of all steps of the production window.
  std::uint64_t solver_iterations = 0;
  double sum_of_solver_residuals = 0, largest_solver_residual = 0;
  std::uint64_t divided_steps = 0;
  std::uint64_t deepest_division = 0;  // the smallest part was 2^-deepest_division of its step
};

// One realisation in memory: the system, its driver and integrator, and its measurements.
class Simulation {
 public:
  // Makes the spheres without positions; call start() or load() next. Throws InputError as check_fit().
  Simulation(const Scene& scene, const Schedule& schedule, std::uint64_t seed, int threads,
             const std::string& file);

  // Packs the spheres, gives them the streaming flow's velocities (and thermal ones) and evaluates the first
  // forces. Throws PackingError.
  void start(const std::function<void()>& made_step = [] {});

  // Starts from another system of the same scene: its particles, box, step and clock. Contacts begin without
  // springs. If not `in_motion`, the spheres get the velocities of a fresh start. Throws
  // std::invalid_argument if the number of particles differs.
  void start(const System& placed, bool in_motion = true);

  // Makes up to `steps` steps; returns the ending once the realisation has ended.
  std::optional<Ending> advance(std::uint64_t steps);

  const System& system() const { return system_; }
  // Returns the schedule. If the system jams before the production window, the window begins there.
  const Schedule& schedule() const { return schedule_; }
  const Production& production() const { return production_; }
  const std::vector<std::unique_ptr<Observable>>& observables() const { return observables_; }
  const StepErrors& step_errors() const { return errors_; }
  // Returns the largest overlap in the production window, in units of the smaller radius of the pair.
  double largest_overlap() const { return largest_overlap_; }

  // Returns strains in which both directions count as positive; at a given stress net strains.
  Strains strains() const { return driver_->strains(system_, schedule_); }
  // Returns the processor time that other processes have spent on it since the last call [s].
  double take_seconds();
  const Driver& driver() const { return *driver_; }

  // Returns the frames that an observable writes to a file beside the result, or null.
  gsd::Frames* frames();

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);
  // Loads only the state that further steps need, without measurements. The saved realisation must have the
  // same motion (motion_of()); its windows and observables may differ.
  void load_motion(ArchiveReader& archive);

 private:
  friend class CardEnsemble;

  void begin();
  void load_system(ArchiveReader& archive);
  PairWatcher* watchers_of_step();
  // Returns the ending if the packing is too stiff for the step; checks at the first and every few thousand.
  std::optional<Ending> check_stability();
  // Returns the ending if a script of the user fails.
  std::optional<Ending> observe(const StepReport& report);
  // Returns the interval, shortened to a block of the production window, so that each block has samples.
  std::uint64_t at_most_a_block(std::uint64_t interval) const {
    return std::min(interval, schedule_.production / count_of_blocks);
  }
  // Returns the number of steps between comparisons with half steps in the window; 0 if there are none.
  std::uint64_t steps_between_comparisons() const;
  // Compares the stress of the next steps with that of half steps.
  void compare_half_steps();
  // Samples the energy error of the step, and compares the stress of steps with that of half steps.
  void note_errors(std::uint64_t index, const StepReport& report);

  Scene scene_;
  Schedule schedule_;
  std::uint64_t random_key_;
  int threads_;
  System system_;
  Matrix3 edges_at_start_;  // of the cell at strain 0; the cell of a start in a file may be sheared
  std::vector<PairKind> kinds_;
  std::unique_ptr<Driver> driver_;
  std::unique_ptr<Integrator> integrator_;
  Production production_;
  std::vector<std::unique_ptr<Observable>> observables_;  // those that the scene lists
  PairWatchers watchers_;                                 // of the next step
  StepErrors errors_;
  double smallest_radius_;
  double largest_overlap_ = 0;
};

}  // namespace peclet::engine
