// The time loop of one realisation.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/integrators/integrator.h"
#include "engine/observables/observable.h"
#include "engine/observables/production.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Steps of the two phases; the step size is constant, so they are known before the first one.
struct Schedule {
  double timestep = 0;
  std::uint64_t equilibration = 0, production = 0;

  std::uint64_t total() const { return equilibration + production; }
};

// Throws InputError when the step is too large, the production window shorter than its 32 blocks, or a phase
// longer than can be counted.
Schedule make_schedule(const Scene& scene, const std::string& file);

// Why a realisation is over.
struct Ending {
  enum class Cause { completed, overlap, displacement, non_finite, packing, timestep };
  Cause cause = Cause::completed;
  std::uint64_t step = 0;
  std::string message;
};

// "completed", "overlap", "displacement", "non-finite", "packing", "timestep"
const char* name_of(Ending::Cause cause);

// What is known of the errors that the finite step makes.
struct StepErrors {
  double largest_stability_share = 0;  // of all checks
  double spurious_energy = 0;          // summed over samples in the production window
  std::uint64_t samples = 0;
  Integrator::HalfSteps half_steps;  // summed over samples in the production window, without noise
  // Of all steps of the production window.
  std::uint64_t solver_iterations = 0;
  double sum_of_solver_residuals = 0, largest_solver_residual = 0;
};

class Simulation {
 public:
  // Spheres without places: start() or load() comes next. Throws InputError where the box is smaller than the
  // range of the forces.
  Simulation(const Scene& scene, const Schedule& schedule, std::uint64_t seed, int threads,
             const std::string& file);

  // Packs the spheres, gives them the streaming flow's velocities (and thermal ones) and evaluates the first
  // forces. Throws PackingError.
  void start();

  // Goes on from another system of the same scene: its particles, box and step. Contacts begin without
  // springs. Throws std::invalid_argument for another number of particles.
  void start(const System& placed);

  // Up to `steps` more steps; returns how the realisation ended once it has. It ends too where the packing
  // has become too stiff for the step: checked before the first step and every few thousand.
  std::optional<Ending> advance(std::uint64_t steps);

  const System& system() const { return system_; }
  const Schedule& schedule() const { return schedule_; }
  const Production& production() const { return production_; }
  const std::vector<std::unique_ptr<Observable>>& observables() const { return observables_; }
  const StepErrors& step_errors() const { return step_errors_; }
  double largest_overlap() const { return largest_overlap_; }  // over the smaller radius, in production

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  std::optional<Ending> check_step();
  std::optional<Ending> verdict(const StepReport& report) const;
  void observe(const StepReport& report);

  Scene scene_;
  Schedule schedule_;
  std::uint64_t seed_;
  int threads_;
  System system_;
  std::vector<PairKind> kinds_;
  std::unique_ptr<Integrator> integrator_;
  Production production_;
  std::vector<std::unique_ptr<Observable>> observables_;  // that the scene asks for
  StepErrors step_errors_;
  double smallest_radius_;
  double largest_overlap_ = 0;
};

}  // namespace peclet::engine
