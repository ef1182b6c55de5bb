#include "engine/integrators/noisy_midpoint.h"

#include "engine/integrators/implicit_rules.h"
#include "engine/state/threads.h"
#include "engine/terms/drag.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

// Returns the physics that noise and the resistance beside it come from.
Physics lubrication_alone(Physics physics) {
  physics.contact.reset();
  for_each_conservative_law([](StressTerm /*part*/, auto& law) { law.reset(); }, physics);
  return physics;
}

}  // namespace

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

NoisyMidpoint::NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep,
                             double tolerance, std::uint64_t seed, int threads, InstructionSet set)
    : NoisyMidpoint(physics, particles, timestep, tolerance, seed, threads, set,
                    carried_by_inertia(physics, particles, timestep)) {}

NoisyMidpoint::NoisyMidpoint(const Physics& physics, const ParticleState& particles, double timestep,
                             double tolerance, std::uint64_t seed, int threads, InstructionSet set,
                             bool inertial)
    : Implicit(physics, particles, timestep, tolerance, seed, threads, set, inertial ? 0.5 : 1),
      with_noise_(lubrication_alone(physics), particles, timestep, seed, threads, set, 0,
                  inertial ? StepResistance::Part::jump : StepResistance::Part::none),
      at_beginning_(field_.physics(), particles, timestep, seed, threads, set, 0.5 * timestep,
                    inertial ? StepResistance::Part::at_beginning : StepResistance::Part::whole),
      ahead_(field_.physics(), particles, timestep, seed, threads, set, 0,
             inertial ? StepResistance::Part::ahead : StepResistance::Part::whole),
      noise_(particles.count(), threads),
      inertial_(inertial) {}

std::optional<StepReport> NoisyMidpoint::find_velocities(System& system) {
  StepReport report;
  assemble(system, at_beginning_, loads_);
  const bool of_each_pair = watcher() != nullptr;
  stress_.begin(with_noise_.evaluate_pairs(system, noise_.force, noise_.torque), noise_.force);
  if (of_each_pair) stress_.begin_pairs(system, with_noise_);
  for_each_range(system.particles.count(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    with_noise_.add_drag_noise(system, begin, end, noise_.force, noise_.torque);
  });
  const bool predicted = solve(system, factor_of_prediction, report);

  if (!move_half_a_step(system)) return std::nullopt;
  stress_.predict(system, assemble(system, ahead_, loads_), loads_, field_.physics());
  if (of_each_pair) stress_.predict_pairs(system, ahead_);
  if (inertial_) leave_half_of_the_drag(system);
  const bool solved = solve(system, 1, report);
  report.sums = stress_.end(system, ahead_, solver_.weights(), timestep_);
  if (of_each_pair) stress_.end_pairs(system, ahead_, solver_.weights(), timestep_);

  if (!move_half_a_step(system)) return std::nullopt;
  if (system.springs.kinds() != SpringKinds::none) {
    field_.evaluate(system, loads_.force, loads_.torque);  // advances the springs
  }
  report.motion =
      sum_over_particles(system, field_.threads(), [&](std::size_t i) { return motion(system, i); });
  report.sums.finite = report.sums.finite && predicted && solved;
  return report;
}

void NoisyMidpoint::show_step(const System& system) {
  watcher()->begin(system, weight());
  stress_.show_pairs(system, *watcher());
  for (std::size_t i = 0; i < system.particles.count(); ++i) {
    watcher()->take_motion(system, i, motion(system, i));
  }
}

// Returns the sums of the loads.
PairSums NoisyMidpoint::assemble(System& system, ForceField& field, Loads& loads) {
  if (field.leaves_loads_with_links()) {
    solver_.assemble(system, field, &loads);
    return field.linked_sums();
  }
  solver_.assemble(system, field);
  const PairSums sums = field.evaluate(system, loads.force, loads.torque);
  restore_springs(system);
  return sums;
}

// Returns the stress of the motion of a particle, times the volume: -m V (V_n + V) / 2 and the part of its
// drag and of the noise of its drag. These act on single particles and have no stress by themselves, but the
// places where they act count. The noise acts at x_n. The drag on V, and that on V_n if there is one, act in
// the middle of the way that they resist. Their mean is then zero at any place, and a free particle carries
// kT at any step.
SymmetricTensor NoisyMidpoint::motion(const System& system, std::size_t i) const {
  const ParticleState& particles = system.particles;
  const Vector3 flow =
      field_.physics().flow.at(system.box).velocity(particles.position[i], particles.radius[i]);
  const Vector3 after = particles.velocity[i] - flow, before = origin_.velocity()[i] - flow,
                mean = 0.5 * (before + after);
  const Vector3 noise = noise_.force[i] - stress_.force_at_beginning(i);
  const double dragged = inertial_ ? translational_drag(field_.physics().viscosity, particles.radius[i]) : 0;
  return -particles.mass[i] * symmetric_dyad(after, mean) + -0.5 * timestep_ * symmetric_dyad(after, noise) +
         0.5 * timestep_ * dragged * symmetric_dyad(before, mean);
}

// Turns the drag on V into that on (V_n + V) / 2.
void NoisyMidpoint::leave_half_of_the_drag(const System& system) {
  const ParticleState& particles = system.particles;
  const double viscosity = field_.physics().viscosity;
  for_each_index(particles.count(), field_.threads(), [&](std::size_t i) {
    const double radius = particles.radius[i];
    const double half = 0.5 * translational_drag(viscosity, radius);
    const double half_turning = 0.5 * rotational_drag(viscosity, radius);
    loads_.force.row(i) += half * (particles.velocity.row(i) - origin_.velocity().row(i));
    loads_.torque.row(i) += half_turning * (particles.angular_velocity.row(i) - origin_.spin().row(i));
  });
}

bool NoisyMidpoint::solve(System& system, double factor, StepReport& report) {
  const VelocitySolver::Residual residual = solver_.set_residual(system, origin_, loads_, &noise_);
  const double tolerance = factor * solver_.tolerance(), squared_tolerance = tolerance * tolerance;
  return solver_.correct(system, squared_tolerance * (residual.squared_motion + residual.squared), report);
}

}  // namespace peclet::engine
