#include "engine/realisation/step_gate.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/observables/production.h"

namespace peclet::engine {
namespace {

// Steps and half steps are compared a few times in a run.
constexpr std::uint64_t comparisons = 8;

}  // namespace

StepGate::StepGate(const Physics& physics, const Schedule& schedule)
    : production_(schedule.production), is_smooth_(physics.thermal_energy == 0 && physics.flow.is_steady()) {}

std::optional<Ending> StepGate::check(Integrator& integrator, System& system) {
  if (system.step % integrator.intervals().stability != 0) {
    return std::nullopt;
  }
  integrator.complete(system);
  const double share = integrator.stability_share(system);
  errors_.largest_stability_share = std::max(errors_.largest_stability_share, share);
  if (share < 1) {
    return std::nullopt;
  }
  // 2 l dt + w^2 dt^2 shrinks at least in proportion to dt.
  const double step = integrator.timestep();
  return Ending{
      Ending::Cause::timestep, system.step,
      fmt::format("the step {:.4g} is too large for the packing at strain {:.4g}, which allows {:.4g}", step,
                  system.box.strain(), step / share)};
}

void StepGate::observe(std::uint64_t index, const StepReport& report, Integrator& integrator,
                       System& system) {
  errors_.solver_iterations += static_cast<std::uint64_t>(report.solver_iterations);
  errors_.sum_of_solver_residuals += report.solver_residual;
  errors_.largest_solver_residual = std::max(errors_.largest_solver_residual, report.solver_residual);
  errors_.divided_steps += report.division > 0 ? 1 : 0;
  errors_.deepest_division = std::max(errors_.deepest_division, static_cast<std::uint64_t>(report.division));
  const Integrator::Intervals intervals = integrator.intervals();
  // A short window is sampled more often so that each block has its samples.
  if (index % std::min(intervals.energy, production_ / count_of_blocks) == 0) {
    integrator.complete(system);
    if (const std::optional<double> energy = integrator.spurious_energy(system)) {
      errors_.spurious_energy += *energy;
      ++errors_.samples;
    }
  }
  const std::uint64_t between = std::max(production_ / comparisons, intervals.comparison);
  if (is_smooth_ && (index + 1) % between == 0) {
    integrator.complete(system);
    const Integrator::HalfSteps sample = integrator.compare_half_steps(system, intervals.compared_steps);
    errors_.half_steps.whole += sample.whole;
    errors_.half_steps.halved += sample.halved;
  }
}

}  // namespace peclet::engine
