#include "engine/integrators/noisy_midpoint.h"

#include <algorithm>

#include "engine/state/field_array.h"
#include "engine/terms/drag.h"
#include "engine/terms/inertial_step.h"

namespace peclet::engine {
namespace {

// The predicted velocities need not be better than half of their way changes the resistance: their tolerance
// is that many times the one of the velocities.
constexpr double of_prediction = 5;

bool carried_by_inertia(const Physics& physics, const ParticleState& particles, double timestep) {
  if (!physics.lubrication || particles.count() == 0) return false;
  const auto smallest =
      static_cast<std::size_t>(std::ranges::min_element(particles.radius) - particles.radius.begin());
  return timestep <= longest_inertial_step(physics.viscosity, physics.thermal_energy, *physics.lubrication,
                                           particles.radius[smallest], particles.mass[smallest]);
}

}  // namespace

NoisyMidpoint::NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep,
                             double tolerance, std::uint64_t seed, int threads, InstructionSet set)
    : NoisyMidpoint(physics, particles, timestep, tolerance, seed, threads, set,
                    carried_by_inertia(physics, particles, timestep)) {}

NoisyMidpoint::NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep,
                             double tolerance, std::uint64_t seed, int threads, InstructionSet set,
                             bool inertial)
    : Implicit(physics, particles, timestep, tolerance, seed, threads, set, inertial ? 0.5 : 1),
      with_noise_(physics, particles, timestep, seed, threads, set, 0.5 * timestep),
      at_beginning_(field_.physics(), particles, timestep, seed, threads, set, 0.5 * timestep,
                    inertial ? StepResistance::Part::at_beginning : StepResistance::Part::whole),
      ahead_(field_.physics(), particles, timestep, seed, threads, set, 0,
             inertial ? StepResistance::Part::ahead : StepResistance::Part::whole),
      on_the_way_(field_.physics(), particles, timestep, seed, threads, set, 0,
                  StepResistance::Part::on_the_way),
      noise_(particles.count(), threads),
      inertial_(inertial) {}

std::optional<StepReport> NoisyMidpoint::find_velocities(System& system) {
  StepReport report;
  solver_.assemble(system, at_beginning_);
  const PairSums counted = at_beginning_.evaluate(system, noise_.force, noise_.torque);
  restore_springs(system);
  const PairSums drawn = with_noise_.evaluate(system, loads_.force, loads_.torque);
  restore_springs(system);
  array(noise_.force) = array(loads_.force) - array(noise_.force);
  array(noise_.torque) = array(loads_.torque) - array(noise_.torque);
  if (watches_flux()) {
    acted_flux_.begin(system, drawn, counted, noise_, with_noise_);
  }
  const bool predicted = solve(system, nullptr, of_prediction, report);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  solver_.assemble(system, ahead_);
  const PairSums ahead = ahead_.evaluate(system, loads_.force, loads_.torque);
  restore_springs(system);
  if (watches_flux()) {
    acted_flux_.predict(system, ahead, loads_, field_.physics());
  }
  if (inertial_) {
    leave_half_of_the_drag(system);
  }
  const bool solved = solve(system, &noise_, 1, report);
  const SymmetricTensor acted =
      watches_flux() ? acted_flux_.end(system, solver_, timestep_) : SymmetricTensor{};

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  report.sums = on_the_way_.evaluate(system, loads_.force, loads_.torque);
  report.sums.finite = report.sums.finite && predicted && solved;
  report.sums.of(StressTerm::brownian_lubrication) = drawn.of(StressTerm::brownian_lubrication);
  if (watches_flux()) {
    report.flux = flux(system, report.sums, acted);
  }
  return report;
}

// `acted`: by pairs.
MomentumFlux NoisyMidpoint::flux(const System& system, const PairSums& sums, SymmetricTensor acted) {
  VectorField mean_velocity = origin_.velocity;
  array(mean_velocity) = 0.5 * (array(mean_velocity) + array(system.particles.velocity));
  const SymmetricTensor motion = flux_by_motion(system.particles, mean_velocity);
  MomentumFlux flux = flux_of(sums, motion);
  flux.acted = acted + motion;
  return flux;
}

// The drag on V becomes that on (V_n + V) / 2.
void NoisyMidpoint::leave_half_of_the_drag(const System& system) {
  const ParticleState& particles = system.particles;
  const double viscosity = field_.physics().viscosity;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i];
    const double half = 0.5 * translational_drag(viscosity, radius);
    const double half_turning = 0.5 * rotational_drag(viscosity, radius);
    loads_.force.row(i) += half * (particles.velocity.row(i) - origin_.velocity.row(i));
    loads_.torque.row(i) += half_turning * (particles.angular_velocity.row(i) - origin_.spin.row(i));
  }
}

bool NoisyMidpoint::solve(System& system, const Loads* noise, double factor, StepReport& report) {
  const VelocitySolver::Residual residual = solver_.set_residual(system, origin_, loads_, noise);
  const double tolerance = factor * solver_.tolerance(), squared_tolerance = tolerance * tolerance;
  return solver_.correct(system, squared_tolerance * (residual.squared_motion + residual.squared), report);
}

}  // namespace peclet::engine
