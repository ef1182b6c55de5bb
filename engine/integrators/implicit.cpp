#include "engine/integrators/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/integrators/midpoint.h"
#include "engine/integrators/noisy_midpoint.h"
#include "engine/state/field_array.h"

namespace peclet::engine {
namespace {

Physics without_noise(Physics physics) {
  physics.thermal_energy = 0;
  return physics;
}

// Of the velocities relative to the flow; NaN if one is not finite.
template <bool is_simple_shear>
double largest_square(const Matrix3& gradient, const VectorField& position, const VectorField& velocity) {
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    Vector3 peculiar = velocity[i];
    if constexpr (is_simple_shear) {
      peculiar.x -= gradient.column[1].x * position.row(i)[1];
    } else {
      peculiar -= gradient * position[i];
    }
    const double squared = dot(peculiar, peculiar);
    largest = std::max(largest, squared);
    sum += squared;
  }
  return std::isfinite(sum) ? largest : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Implicit::Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                   std::uint64_t seed, int threads, InstructionSet set, double drag_share)
    : timestep_(timestep),
      field_(without_noise(physics), particles, timestep, seed, threads, set),
      solver_(physics, particles, timestep, tolerance, set, drag_share),
      loads_(particles.count(), threads),
      physics_(physics) {}

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
  remember(system);
  std::optional<StepReport> found = find_velocities(system);
  if (!found) {
    restart(system);
    found = find_velocities(system);
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
  keep_change(system);
  move(system, timestep_);
  ++system.step;
  ++system.clock.steps;
  displacement_bound_ +=
      report.largest_displacement + timestep_ * norm(system.box.velocity_gradient()) * displacement_bound_;
  const double allowed = system.list.allowed_displacement(system.box);
  // With room for half of the next step, should it be as large as this one.
  const double next = 0.5 * report.largest_displacement;
  if (displacement_bound_ + next >= allowed) {
    displacement_bound_ = system.list.largest_displacement(system.particles, system.box);
    if (displacement_bound_ + next >= allowed) {
      rebuild_neighbours(system, field_.threads());
      displacement_bound_ = 0;
    }
  }
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

// The largest one of a step at the present velocities, relative to the uniform flow; NaN if one is not
// finite.
double Implicit::displacement(const System& system) const {
  const Matrix3& gradient = system.box.velocity_gradient();
  const double squared = gradient == simple_shear(gradient.column[1].x)
                             ? largest_square<true>(gradient, origin_.position, system.particles.velocity)
                             : largest_square<false>(gradient, origin_.position, system.particles.velocity);
  return timestep_ * std::sqrt(squared);
}

Integrator::HalfSteps Implicit::compare_half_steps(const System& system, int steps) const {
  // `every` steps of timestep / every for one that counts.
  const auto stress = [&](int every) {
    System copy = system;
    const std::unique_ptr<Implicit> integrator =
        implicit_steps(physics_, copy.particles, timestep_ / every, solver_.tolerance(), 0, field_.threads());
    copy.clock = system.clock.with_parts(every);
    integrator->displacement_bound_ = displacement_bound_;
    double sum = 0;
    for (int step = 1; step <= every * steps; ++step) {
      const PairSums sums = integrator->advance_open(copy).sums;
      for (const SymmetricTensor& s : sums.stress) {
        sum += s.xy / every;
      }
    }
    return sum;
  };
  return {stress(1), stress(2)};
}

void Implicit::save(ArchiveWriter& archive) const { archive.put(displacement_bound_); }

void Implicit::load(const System& /*system*/, ArchiveReader& archive) {
  displacement_bound_ = archive.get<double>();
}

std::unique_ptr<Implicit> implicit_steps(const Physics& physics, const ParticleState& particles,
                                         double timestep, double tolerance, std::uint64_t seed, int threads,
                                         InstructionSet set) {
  if (physics.thermal_energy > 0) {
    return std::make_unique<NoisyMidpoint>(physics, particles, timestep, tolerance, seed, threads, set);
  }
  return std::make_unique<Midpoint>(physics, particles, timestep, tolerance, seed, threads, set);
}

}  // namespace peclet::engine
