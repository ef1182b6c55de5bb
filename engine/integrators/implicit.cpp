#include "engine/integrators/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/state/field_array.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

constexpr int most_newton_iterations = 3;
// Far more than any packing has needed.
constexpr int most_iterations = 1000;
// An iteration of Newton's method need not solve its system better than the next one's residual will be.
constexpr double forcing = 0.1;

Physics without_noise(Physics physics) {
  physics.thermal_energy = 0;
  return physics;
}

}  // namespace

Implicit::Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                   std::uint64_t seed, int threads, InstructionSet set)
    : physics_(physics),
      timestep_(timestep),
      tolerance_(tolerance),
      field_(without_noise(physics), particles, timestep, seed, threads, set),
      link_(link_kernels(set)),
      inverse_blocks_(6 * particles.count()),
      scratch_(rows_of_scratch(particles.count())),
      solution_(particles.count()),
      residual_(particles.count()),
      direction_(particles.count()),
      product_(particles.count()),
      force_(particles.count(), threads),
      torque_(particles.count(), threads) {
  if (physics.thermal_energy > 0) {
    const double ahead = 0.5 * timestep;
    noisy_ = NoisyFields{
        .with = ForceField(physics, particles, timestep, seed, threads, set, ahead),
        .without = ForceField(without_noise(physics), particles, timestep, seed, threads, set, ahead)};
    noise_force_ = VectorField(particles.count(), threads);
    noise_torque_ = VectorField(particles.count(), threads);
  } else {
    velocity_change_ = VectorField(particles.count(), threads);
    spin_change_ = VectorField(particles.count(), threads);
  }
  const std::size_t classes = distinct_radii(particles.radius).size();
  inertia_.resize(classes);
  diagonal_.resize(classes);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i], mass = particles.mass[i], inertia = particles.inertia[i];
    inertia_[particles.size_class[i]] = {mass, inertia};
    Floats& diagonal = diagonal_[particles.size_class[i]].v;
    for (int c = 0; c < 3; ++c) {
      diagonal[c] = static_cast<float>(mass + timestep * translational_drag(physics.viscosity, radius));
      diagonal[4 + c] = static_cast<float>(inertia + timestep * rotational_drag(physics.viscosity, radius));
    }
  }
}

// A comparison with half steps costs as much as three steps or a little more.
Integrator::Intervals Implicit::intervals() const {
  return {.sampling = 4, .energy = 500, .stability = 5000, .comparison = 100, .compared_steps = 1};
}

void Implicit::start(System& system) {
  const SpringKinds kinds = spring_kinds(field_.terms());
  if (system.springs.kinds() != kinds) {
    system.springs = SpringField(kinds, system.list.pairs().size());
  }
  system.clock.count_in(timestep_);
  rebuild_neighbours(system, field_.threads());
  displacement_bound_ = 0;
}

StepReport Implicit::advance_open(System& system) {
  const auto find = [&] { return noisy_ ? find_noisy_velocities(system) : find_velocities(system); };
  remember(system);
  std::optional<StepReport> found = find();
  if (!found) {
    restart(system);
    found = find();
  }
  StepReport report = found.value_or(StepReport{});
  report.largest_displacement = displacement(system);
  if (!found) {
    // Not even a new list holds. Whoever asked for the step sees why.
    report.largest_displacement = std::max(report.largest_displacement, system.list.ranges().largest());
    ++system.step;
    ++system.clock.steps;
    return report;
  }
  const ParticleState& particles = system.particles;
  if (!noisy_) {
    array(velocity_change_)(Eigen::all, particles.id) = array(particles.velocity) - array(origin_.velocity);
    array(spin_change_)(Eigen::all, particles.id) = array(particles.angular_velocity) - array(origin_.spin);
  }
  move(system, timestep_);
  ++system.step;
  ++system.clock.steps;
  displacement_bound_ +=
      report.largest_displacement + timestep_ * norm(system.box.velocity_gradient()) * displacement_bound_;
  const double allowed = system.list.allowed_displacement(system.box);
  // With room for half of the next step, should it be as large as this one.
  const double next = 0.5 * report.largest_displacement;
  if (displacement_bound_ + next >= allowed) {
    displacement_bound_ = system.list.largest_displacement(particles, system.box);
    if (displacement_bound_ + next >= allowed) {
      rebuild_neighbours(system, field_.threads());
      displacement_bound_ = 0;
    }
  }
  return report;
}

std::optional<StepReport> Implicit::find_velocities(System& system) {
  ParticleState& particles = system.particles;
  array(particles.velocity) += array(velocity_change_)(Eigen::all, particles.id);
  array(particles.angular_velocity) += array(spin_change_)(Eigen::all, particles.id);
  StepReport report;
  for (int iteration = 0;; ++iteration) {
    if (!move_half_a_step(system)) {
      return std::nullopt;
    }
    if (iteration == 0) {
      assemble(system, field_);
    }
    report.sums = field_.evaluate(system, force_, torque_);
    const Residual residual = set_residual(system, false);
    // A packing that starts with the streaming flow's velocities has no motion yet but what it is about to
    // do.
    const double motion = residual.squared_motion + (iteration == 0 ? residual.squared : 0);
    const double target = tolerance_ * tolerance_ * motion;
    report.solver_residual = motion > 0 ? std::sqrt(residual.squared / motion) : 0;
    report.sums.finite = report.sums.finite && std::isfinite(residual.squared) && std::isfinite(motion);
    if (!(residual.squared > target) || iteration == most_newton_iterations) {
      return report;
    }
    restore_springs(system);
    if (iteration > 0) {
      assemble(system, field_);
    }
    if (!correct(system, std::max(0.25 * target, forcing * forcing * residual.squared), report)) {
      report.sums.finite = false;
      return report;
    }
  }
}

std::optional<StepReport> Implicit::find_noisy_velocities(System& system) {
  StepReport report;
  const auto solve = [&](bool with_noise) {
    const Residual residual = set_residual(system, with_noise);
    return correct(system, tolerance_ * tolerance_ * (residual.squared_motion + residual.squared), report);
  };
  assemble(system, noisy_->without);
  noisy_->without.evaluate(system, noise_force_, noise_torque_);
  restore_springs(system);
  const PairSums drawn = noisy_->with.evaluate(system, force_, torque_);
  restore_springs(system);
  array(noise_force_) = array(force_) - array(noise_force_);
  array(noise_torque_) = array(torque_) - array(noise_torque_);
  const bool predicted = solve(false);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  assemble(system, field_);
  field_.evaluate(system, force_, torque_);
  restore_springs(system);
  const bool solved = solve(true);

  if (!move_half_a_step(system)) {
    return std::nullopt;
  }
  report.sums = field_.evaluate(system, force_, torque_);
  report.sums.finite = report.sums.finite && predicted && solved;
  report.sums.of(StressTerm::brownian_lubrication) = drawn.of(StressTerm::brownian_lubrication);
  return report;
}

void Implicit::remember(const System& system) {
  origin_.position = system.particles.position;
  origin_.velocity = system.particles.velocity;
  origin_.spin = system.particles.angular_velocity;
  origin_.springs = system.springs;
}

// Once more from the origin, with a new list.
void Implicit::restart(System& system) {
  system.particles.velocity = origin_.velocity;
  system.particles.angular_velocity = origin_.spin;
  restore_springs(system);
  move(system, 0);
  rebuild_neighbours(system, field_.threads());
  displacement_bound_ = 0;
  remember(system);
}

void Implicit::restore_springs(System& system) const {
  if (system.springs.kinds() != SpringKinds::none) {
    system.springs = origin_.springs;
  }
}

// Returns whether the list holds there.
bool Implicit::move_half_a_step(System& system) {
  const double half = 0.5 * displacement(system);
  move(system, 0.5 * timestep_);
  const double allowed = system.list.allowed_displacement(system.box);
  return displacement_bound_ + half < allowed ||
         system.list.largest_displacement(system.particles, system.box) < allowed;
}

// To where the present velocities lead from the origin in that time.
void Implicit::move(System& system, double time) {
  ParticleState& particles = system.particles;
  array(particles.position) = array(origin_.position) + time * array(particles.velocity);
  physics_.flow.deformation().drive(system.box, system.clock.time() + time);
}

// The largest one of a step at the present velocities, relative to the streaming flow; NaN if one is not
// finite.
double Implicit::displacement(const System& system) const {
  const ParticleState& particles = system.particles;
  const BackgroundFlow flow(system.box.velocity_gradient());
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 streaming = flow.velocity(origin_.position[i]);
    const Row peculiar = particles.velocity.row(i) - Row{streaming.x, streaming.y, streaming.z, 0};
    const Row squares = peculiar * peculiar;
    const double squared = squares[0] + squares[1] + squares[2];
    largest = std::max(largest, squared);
    sum += squared;
  }
  return std::isfinite(sum) ? timestep_ * std::sqrt(largest) : std::numeric_limits<double>::quiet_NaN();
}

// At the present places and velocities. Springs must be those of the origin.
void Implicit::assemble(System& system, ForceField& field) {
  const double half = 0.5 * timestep_;
  count_of_groups_ = field.assemble_links(
      system, {.timestep = timestep_, .normal_time = half, .resistance_time = noisy_ ? 0 : half}, groups_);
  link_.invert_blocks(links(system), scratch_.data(), inverse_blocks_.data());
}

Implicit::Residual Implicit::set_residual(const System& system, bool with_noise) {
  const ParticleState& particles = system.particles;
  const StepRows rows = {.velocity_before = origin_.velocity.data(),
                         .spin_before = origin_.spin.data(),
                         .position = particles.position.data(),
                         .velocity = particles.velocity.data(),
                         .spin = particles.angular_velocity.data(),
                         .force = force_.data(),
                         .torque = torque_.data(),
                         .noise_force = with_noise ? noise_force_.data() : nullptr,
                         .noise_torque = with_noise ? noise_torque_.data() : nullptr,
                         .inertia = inertia_.data(),
                         .timestep = timestep_,
                         .flow = plain(BackgroundFlow(system.box.velocity_gradient()))};
  const LinkSystem matrix = links(system);
  link_.set_residual(matrix, rows, residual_.data());
  const SquaredMotion motion = link_.squared_motion(matrix, rows, direction_.data(), product_.data());
  // What a step changes is the smaller a part of the motion the more inertia outlives the step, and errors of
  // that part add up for as long.
  const double changed = std::max(motion.whole - motion.inertial, 0.0);
  return {.squared = link_.squared_norm(matrix, residual_.data()),
          .squared_motion = motion.whole > 0 ? changed * changed / motion.whole : 0};
}

// Adds to the velocities what takes the residual away. Returns whether that is finite.
bool Implicit::correct(System& system, double target, StepReport& report) {
  const SolverReport solved =
      link_.solve(links(system), {solution_.data(), residual_.data(), direction_.data(), product_.data()},
                  target, most_iterations);
  report.solver_iterations += solved.iterations;
  report.solver_residual = target > 0 ? tolerance_ * std::sqrt(solved.squared_residual / target) : 0;
  link_.add_motion(system.particles.count(), solution_.data(), system.particles.velocity.data(),
                   system.particles.angular_velocity.data());
  return std::isfinite(solved.squared_residual);
}

LinkSystem Implicit::links(const System& system) const {
  return {.particles = system.particles.count(),
          .size_class = system.particles.size_class.data(),
          .diagonal = diagonal_.data(),
          .groups = groups_.data(),
          .count_of_groups = count_of_groups_,
          .inverse_blocks = inverse_blocks_.data()};
}

Integrator::HalfSteps Implicit::compare_half_steps(const System& system, int steps) const {
  // `every` steps of timestep / every for one that counts.
  const auto stress = [&](int every) {
    System copy = system;
    Implicit integrator(physics_, copy.particles, timestep_ / every, tolerance_, 0, field_.threads());
    copy.clock = system.clock.with_parts(every);
    integrator.displacement_bound_ = displacement_bound_;
    double sum = 0;
    for (int step = 1; step <= every * steps; ++step) {
      const PairSums sums = integrator.advance_open(copy).sums;
      for (const SymmetricTensor& s : sums.stress) {
        sum += s.xy / every;
      }
    }
    return sum;
  };
  return {stress(1), stress(2)};
}

void Implicit::save(ArchiveWriter& archive) const {
  if (!noisy_) {
    archive.put(velocity_change_);
    archive.put(spin_change_);
  }
  archive.put(displacement_bound_);
}

void Implicit::load(const System& system, ArchiveReader& archive) {
  if (!noisy_) {
    velocity_change_ = archive.get_field(system.particles.count());
    spin_change_ = archive.get_field(system.particles.count());
  }
  displacement_bound_ = archive.get<double>();
}

}  // namespace peclet::engine
