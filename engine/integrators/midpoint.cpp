#include "engine/integrators/midpoint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/integrators/acted_stress.h"
#include "engine/integrators/implicit_rules.h"
#include "engine/state/eigen_arrays.h"
#include "engine/state/threads.h"

namespace peclet::engine {

Midpoint::Midpoint(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                   std::uint64_t seed, int threads, InstructionSet set)
    : Implicit(physics, particles, timestep, tolerance, seed, threads, set, /*drag_share=*/1,
               StepResistance::Part::on_the_way),
      velocity_change_(particles.count(), threads),
      spin_change_(particles.count(), threads) {
  field_.feel_springs_after(felt_share);
}

std::optional<StepReport> Midpoint::find_velocities(System& system) {
  ParticleState& particles = system.particles;
  for_each_index(particles.count(), field_.threads(), [&](std::size_t i) {
    particles.velocity.row(i) += velocity_change_.row(particles.id[i]);
    particles.angular_velocity.row(i) += spin_change_.row(particles.id[i]);
  });
  const NewtonIterations iterations = newton_iterations(system.springs.kinds() != SpringKinds::none);
  StepReport report;
  for (int iteration = 0;; ++iteration) {
    if (!move_half_a_step(system)) return std::nullopt;
    if (iteration == 0) solver_.assemble(system, field_);
    report.sums = field_.evaluate(system, loads_.force, loads_.torque);
    const VelocitySolver::Residual residual = solver_.set_residual(system, origin_, loads_, nullptr);
    // A packing that starts with the velocities of the flow has no motion yet except for its residual.
    const double motion = residual.squared_motion + (iteration == 0 ? residual.squared : 0);
    const double target = std::max(solver_.tolerance() * solver_.tolerance() * motion, no_motion);
    report.solver_residual = motion > 0 ? std::sqrt(residual.squared / motion) : 0;
    report.sums.finite = report.sums.finite && std::isfinite(residual.squared) && std::isfinite(motion);
    const int most =
        residual.squared > far_residual * far_residual * target ? iterations.most : iterations.usual;
    if (!(residual.squared > target) || iteration >= most) {
      if (watches_motion()) report.motion = stress_of_motion(system);
      return report;
    }
    restore_springs(system);
    if (iteration > 0) solver_.assemble(system, field_);
    const double left = std::min(solver_.tolerance() / usual_tolerance, 1.0) *
                        (iteration == 0 ? iterations.first_forcing : iterations.forcing);
    if (!solver_.correct(system, std::max(0.25 * target, left * left * residual.squared), report)) {
      report.sums.finite = false;
      return report;
    }
  }
}

// Returns -sum m sym(V V') with V' = (V_n + V) / 2, both relative to the flow.
SymmetricTensor Midpoint::stress_of_motion(const System& system) const {
  const ParticleState& particles = system.particles;
  return sum_over_particles(system, field_.threads(), [&](std::size_t i) {
    const Vector3 mean = 0.5 * (origin_.velocity()[i] + particles.velocity[i]);
    return -particles.mass[i] * symmetric_dyad(relative_to_flow(system, i, particles.velocity[i]),
                                               relative_to_flow(system, i, mean));
  });
}

void Midpoint::keep_change(const System& system) {
  const ParticleState& particles = system.particles;
  for_each_index(particles.count(), field_.threads(), [&](std::size_t i) {
    velocity_change_.row(particles.id[i]) = particles.velocity.row(i) - origin_.velocity().row(i);
    spin_change_.row(particles.id[i]) = particles.angular_velocity.row(i) - origin_.spin().row(i);
  });
}

void Midpoint::forget_change() {
  array(velocity_change_).setZero();
  array(spin_change_).setZero();
}

void Midpoint::mark(const System& system) {
  Implicit::mark(system);
  marked_velocity_change_ = velocity_change_;
  marked_spin_change_ = spin_change_;
}

void Midpoint::return_to_mark(System& system) {
  Implicit::return_to_mark(system);
  velocity_change_ = marked_velocity_change_;
  spin_change_ = marked_spin_change_;
}

void Midpoint::save(ArchiveWriter& archive) const {
  archive.put_all(velocity_change_, spin_change_);
  Implicit::save(archive);
}

void Midpoint::load(ArchiveReader& archive) {
  archive.get_all(velocity_change_, spin_change_);
  Implicit::load(archive);
}

}  // namespace peclet::engine
