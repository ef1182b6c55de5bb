#include "engine/integrators/velocity_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Far more than any packing has needed.
constexpr int most_iterations = 1000;

}  // namespace

VelocitySolver::VelocitySolver(const Physics& physics, const ParticleState& particles, double timestep,
                               double tolerance, InstructionSet set, double drag_share)
    : timestep_(timestep),
      tolerance_(tolerance),
      link_(link_kernels(set)),
      inverse_blocks_(6 * particles.count()),
      scratch_(rows_of_scratch(particles.count())),
      solution_(particles.count()),
      residual_(particles.count()),
      direction_(particles.count()),
      product_(particles.count()),
      flow_(physics.flow) {
  if (flow_.varies()) {
    varying_velocity_ = varying_spin_ = VectorField(particles.count());
  }
  const std::size_t classes = distinct_radii(particles.radius).size();
  inertia_.resize(classes);
  diagonal_.resize(classes);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i], mass = particles.mass[i], inertia = particles.inertia[i];
    inertia_[particles.size_class[i]] = {mass, inertia};
    const double drag_time = drag_share * timestep;
    Floats& diagonal = diagonal_[particles.size_class[i]].v;
    for (int c = 0; c < 3; ++c) {
      diagonal[c] = static_cast<float>(mass + drag_time * translational_drag(physics.viscosity, radius));
      diagonal[4 + c] = static_cast<float>(inertia + drag_time * rotational_drag(physics.viscosity, radius));
    }
  }
}

void VelocitySolver::assemble(System& system, ForceField& field, double resistance_time) {
  count_of_groups_ = field.assemble_links(
      system, {.timestep = timestep_, .normal_time = 0.5 * timestep_, .resistance_time = resistance_time},
      groups_);
  link_.invert_blocks(links(system), scratch_.data(), inverse_blocks_.data());
}

VelocitySolver::Residual VelocitySolver::set_residual(const System& system, const StepOrigin& origin,
                                                      const Loads& loads, const Loads* noise) {
  const ParticleState& particles = system.particles;
  if (flow_.varies()) {
    const BackgroundFlow flow = flow_.at(system.box);
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const auto [velocity, spin] = flow.varying_motion(particles.position[i], particles.radius[i]);
      varying_velocity_.set(i, velocity);
      varying_spin_.set(i, spin);
    }
  }
  const StepRows rows = {.velocity_before = origin.velocity.data(),
                         .spin_before = origin.spin.data(),
                         .position = particles.position.data(),
                         .velocity = particles.velocity.data(),
                         .spin = particles.angular_velocity.data(),
                         .force = loads.force.data(),
                         .torque = loads.torque.data(),
                         .noise_force = noise != nullptr ? noise->force.data() : nullptr,
                         .noise_torque = noise != nullptr ? noise->torque.data() : nullptr,
                         .inertia = inertia_.data(),
                         .timestep = timestep_,
                         .flow = plain_flow(system.box.velocity_gradient()),
                         .varying_velocity = flow_.varies() ? varying_velocity_.data() : nullptr,
                         .varying_spin = flow_.varies() ? varying_spin_.data() : nullptr};
  const LinkSystem matrix = links(system);
  link_.set_residual(matrix, rows, residual_.data());
  const SquaredMotion motion = link_.squared_motion(matrix, rows, direction_.data(), product_.data());
  // What a step changes is the smaller a part of the motion the more inertia outlives the step, and errors of
  // that part add up for as long.
  const double changed = std::max(motion.whole - motion.inertial, 0.0);
  return {.squared = link_.squared_norm(matrix, residual_.data()),
          .squared_motion = motion.whole > 0 ? changed * changed / motion.whole : 0};
}

bool VelocitySolver::correct(System& system, double target, StepReport& report) {
  const SolverReport solved =
      link_.solve(links(system), {solution_.data(), residual_.data(), direction_.data(), product_.data()},
                  target, most_iterations);
  report.solver_iterations += solved.iterations;
  report.solver_residual = target > 0 ? tolerance_ * std::sqrt(solved.squared_residual / target) : 0;
  link_.add_motion(system.particles.count(), solution_.data(), system.particles.velocity.data(),
                   system.particles.angular_velocity.data());
  return std::isfinite(solved.squared_residual);
}

LinkSystem VelocitySolver::links(const System& system) const {
  return {.particles = system.particles.count(),
          .size_class = system.particles.size_class.data(),
          .diagonal = diagonal_.data(),
          .groups = groups_.data(),
          .count_of_groups = count_of_groups_,
          .inverse_blocks = inverse_blocks_.data()};
}

}  // namespace peclet::engine
