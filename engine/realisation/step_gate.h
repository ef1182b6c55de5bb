// Whether the step is small enough: what it takes of the stable range, the energy that it makes, and how far
// the stress of steps is from that of half steps.
#pragma once

#include <optional>

#include "engine/realisation/schedule.h"

namespace peclet::engine {

// What is known of the errors that the finite step makes.
struct StepErrors {
  double largest_stability_share = 0;  // of all checks
  double spurious_energy = 0;          // summed over samples in the production window
  std::uint64_t samples = 0;
  Integrator::HalfSteps half_steps;  // summed over samples in the production window, without noise
  // Of all steps of the production window.
  std::uint64_t solver_iterations = 0;
  double sum_of_solver_residuals = 0, largest_solver_residual = 0;
  std::uint64_t divided_steps = 0;
  std::uint64_t deepest_division = 0;  // the smallest part was 2^-deepest_division of its step
};

class StepGate {
 public:
  StepGate(const Physics& physics, const Schedule& schedule);

  // Before each step: how the realisation ends where the packing has become too stiff for it. Looks at the
  // first step and every few thousand.
  std::optional<Ending> check(Integrator& integrator, System& system);

  // After the step of the production window that has this index. Completes it where it takes a sample.
  void observe(std::uint64_t index, const StepReport& report, Integrator& integrator, System& system);

  const StepErrors& errors() const { return errors_; }

  void save(ArchiveWriter& archive) const { archive.put(errors_); }
  void load(ArchiveReader& archive) { errors_ = archive.get<StepErrors>(); }
  // What is not of the production window alone.
  void load_before_window(ArchiveReader& archive) {
    errors_ = {};
    errors_.largest_stability_share = archive.get<StepErrors>().largest_stability_share;
  }

 private:
  std::uint64_t production_;  // steps
  bool is_smooth_;            // steps and half steps can be compared
  StepErrors errors_;
};

}  // namespace peclet::engine
