#include "engine/integrators/noisy_midpoint.h"

#include "engine/state/field_array.h"

namespace peclet::engine {

NoisyMidpoint::NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep,
                             double tolerance, std::uint64_t seed, int threads, InstructionSet set)
    : Implicit(physics, particles, timestep, tolerance, seed, threads, set),
      with_noise_(physics, particles, timestep, seed, threads, set, 0.5 * timestep),
      without_noise_(field_.physics(), particles, timestep, seed, threads, set, 0.5 * timestep),
      noise_(particles.count(), threads) {}

std::optional<StepReport> NoisyMidpoint::find_velocities(System& system) {
  constexpr double resistance_stays = 0;
  StepReport report;
  solver_.assemble(system, without_noise_, resistance_stays);
  without_noise_.evaluate(system, noise_.force, noise_.torque);
  restore_springs(system);
  const PairSums drawn = with_noise_.evaluate(system, loads_.force, loads_.torque);
  restore_springs(system);
  array(noise_.force) = array(loads_.force) - array(noise_.force);
  array(noise_.torque) = array(loads_.torque) - array(noise_.torque);
  const bool predicted = solve(system, nullptr, report);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  solver_.assemble(system, field_, resistance_stays);
  field_.evaluate(system, loads_.force, loads_.torque);
  restore_springs(system);
  const bool solved = solve(system, &noise_, report);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  report.sums = field_.evaluate(system, loads_.force, loads_.torque);
  report.sums.finite = report.sums.finite && predicted && solved;
  report.sums.of(StressTerm::brownian_lubrication) = drawn.of(StressTerm::brownian_lubrication);
  return report;
}

bool NoisyMidpoint::solve(System& system, const Loads* noise, StepReport& report) {
  const VelocitySolver::Residual residual = solver_.set_residual(system, origin_, loads_, noise);
  const double squared_tolerance = solver_.tolerance() * solver_.tolerance();
  return solver_.correct(system, squared_tolerance * (residual.squared_motion + residual.squared), report);
}

}  // namespace peclet::engine
