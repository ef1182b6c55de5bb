#include "engine/integrators/velocity_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/integrators/implicit_rules.h"
#include "engine/state/threads.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

VelocitySolver::VelocitySolver(const Physics& physics, const ParticleState& particles, double timestep,
                               double tolerance, int threads, InstructionSet set, double drag_share)
    : timestep_(timestep),
      tolerance_(tolerance),
      threads_(threads),
      link_(link_kernels(set)),
      pivots_(particles.count()),
      solution_(particles.count()),
      residual_(particles.count()),
      weighted_(particles.count()),
      direction_(particles.count()),
      ahead_(particles.count()),
      moved_(particles.count()),
      loads_(particles.count()),
      flow_(physics.flow) {
  if (flow_.varies()) varying_velocity_ = varying_spin_ = VectorField(particles.count());
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

void VelocitySolver::assemble(System& system, ForceField& field, Loads* loads) {
  if (ordered_ != system.list.builds()) {
    order_.arrange(system.list, system.particles.count(), threads_);
    aside_.resize(rows_of_block * links_per_group * order_.crossing_groups());
    sums_.resize(order_.blocks().size());
    ordered_ = system.list.builds();
  }
  using LoadRows = ForceField::LoadRows;
  const std::optional<LoadRows> rows =
      loads != nullptr ? std::optional(LoadRows{loads->force, loads->torque}) : std::nullopt;
  const ForceField::AssembleLinks assemble_block =
      field.assemble_links(system, weights(), order_, groups_, rows ? &*rows : nullptr);
  const LinkSystem matrix = links(system);
  run_team(threads_, [&](Team& team) {
    const Team::Part mine = team.part_of(matrix.count_of_blocks);
    for (std::size_t block = mine.begin; block < mine.end; ++block) assemble_block(block);
    team.meet();
    link_.factorise(matrix, pivots_.data(), team);
  });
  if (loads != nullptr) field.add_incoming(system, loads->force, loads->torque);
  begun_.reset();
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
  const StepRows rows = {.velocity_before = origin.velocity().data(),
                         .spin_before = origin.spin().data(),
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
  SquaredMotion motion{};
  run_team(threads_, [&](Team& team) {
    link_.set_residual(matrix, rows, solution_.data(), team);
    const double squared = link_.begin(matrix, this->rows(), team);
    const SquaredMotion squared_motion = link_.squared_motion(matrix, rows, direction_.data(), team);
    if (team.is_first()) {
      begun_ = squared;
      motion = squared_motion;
    }
  });
  // If inertia outlives many steps, each changes a small part of the motion, and its errors add up over them.
  // So residuals are relative to that part.
  const double changed = std::max(motion.whole - motion.inertial, 0.0);
  return {.squared = *begun_, .squared_motion = motion.whole > 0 ? changed * changed / motion.whole : 0};
}

bool VelocitySolver::correct(System& system, double target, StepReport& report) {
  const LinkSystem matrix = links(system);
  SolverReport solved;
  run_team(threads_, [&](Team& team) {
    const double squared = begun_ ? *begun_ : link_.begin(matrix, rows(), team);
    const SolverReport found = link_.solve(matrix, rows(), squared, target, most_solver_iterations, team);
    link_.add_motion(matrix, solution_.data(), system.particles.velocity.data(),
                     system.particles.angular_velocity.data(), team);
    if (team.is_first()) solved = found;
  });
  begun_.reset();
  report.solver_iterations += solved.iterations;
  report.solver_residual = relative_residual(tolerance_, solved.squared_residual, target);
  return std::isfinite(solved.squared_residual);
}

LinkSystem VelocitySolver::links(const System& system) {
  return {.particles = system.particles.count(),
          .row = order_.row().data(),
          .size_class = system.particles.size_class.data(),
          .diagonal = diagonal_.data(),
          .blocks = order_.blocks().data(),
          .count_of_blocks = order_.blocks().size(),
          .levels = order_.levels().data(),
          .boundary_levels = order_.boundary_levels(),
          .groups = groups_.data(),
          .incoming = order_.incoming().data(),
          .pivots = pivots_.data(),
          .aside = aside_.data(),
          .crossing_begin = order_.inner_groups(),
          .sums = sums_.data()};
}

SolverRows VelocitySolver::rows() {
  return {.solution = solution_.data(),
          .residual = residual_.data(),
          .weighted = weighted_.data(),
          .direction = direction_.data(),
          .ahead = ahead_.data(),
          .moved = moved_.data(),
          .loads = loads_.data()};
}

}  // namespace peclet::engine
