#include "engine/integrators/noisy_midpoint.h"

#include <algorithm>

#include "engine/state/field_array.h"
#include "engine/terms/drag.h"
#include "engine/terms/inertial_step.h"
#include "engine/threads/for_each_range.h"

namespace peclet::engine {
namespace {

// The predicted velocities need not be better than half of their way changes the resistance: their tolerance
// is that many times the one of the velocities.
constexpr double of_prediction = 5;

bool carried_by_inertia(const Physics& physics, const ParticleState& particles, double timestep) {
  if (!physics.lubrication || particles.count() == 0) return false;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    if (timestep > longest_inertial_step(physics.viscosity, physics.thermal_energy, *physics.lubrication,
                                         particles.radius[i], particles.mass[i])) {
      return false;
    }
  }
  return true;
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
  const PairSums counted = assemble(system, at_beginning_, noise_);
  const PairSums drawn = with_noise_.evaluate(system, loads_.force, loads_.torque);
  restore_springs(system);
  for_each_range(system.particles.count(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      noise_.force.row(i) = loads_.force.row(i) - noise_.force.row(i);
      noise_.torque.row(i) = loads_.torque.row(i) - noise_.torque.row(i);
    }
  });
  if (watches_flux()) {
    acted_flux_.begin(system, drawn, counted, noise_, with_noise_);
  }
  const bool predicted = solve(system, nullptr, of_prediction, report);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  const PairSums ahead = assemble(system, ahead_, loads_);
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

// The sums are those that the flux of momentum takes.
PairSums NoisyMidpoint::assemble(System& system, ForceField& field, Loads& loads) {
  if (field.leaves_loads_with_links() && !watches_flux()) {
    solver_.assemble(system, field, &loads);
    return {};
  }
  solver_.assemble(system, field);
  const PairSums sums = field.evaluate(system, loads.force, loads.torque);
  restore_springs(system);
  return sums;
}

// `acted`: by pairs.
MomentumFlux NoisyMidpoint::flux(const System& system, const PairSums& sums, SymmetricTensor acted) {
  const SymmetricTensor motion = flux_by_motion(system, mean_velocity(system));
  MomentumFlux flux = flux_of(sums, motion);
  flux.acted = acted + motion;
  return flux;
}

// The drag on V becomes that on (V_n + V) / 2.
void NoisyMidpoint::leave_half_of_the_drag(const System& system) {
  const ParticleState& particles = system.particles;
  const double viscosity = field_.physics().viscosity;
  for_each_range(particles.count(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double radius = particles.radius[i];
      const double half = 0.5 * translational_drag(viscosity, radius);
      const double half_turning = 0.5 * rotational_drag(viscosity, radius);
      loads_.force.row(i) += half * (particles.velocity.row(i) - origin_.velocity.row(i));
      loads_.torque.row(i) += half_turning * (particles.angular_velocity.row(i) - origin_.spin.row(i));
    }
  });
}

bool NoisyMidpoint::solve(System& system, const Loads* noise, double factor, StepReport& report) {
  const VelocitySolver::Residual residual = solver_.set_residual(system, origin_, loads_, noise);
  const double tolerance = factor * solver_.tolerance(), squared_tolerance = tolerance * tolerance;
  return solver_.correct(system, squared_tolerance * (residual.squared_motion + residual.squared), report);
}

}  // namespace peclet::engine
