#include "engine/integrators/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/integrators/implicit_rules.h"
#include "engine/integrators/integrator.h"
#include "engine/integrators/midpoint.h"
#include "engine/integrators/noisy_midpoint.h"
#include "engine/state/eigen_arrays.h"
#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

Physics without_noise(Physics physics) {
  physics.thermal_energy = 0;
  return physics;
}

// Returns the largest |v|^2 in a block, v relative to the flow; NaN if one is not finite.
template <bool is_simple_shear>
double largest_square(const Matrix3& gradient, const VectorField& position, const VectorField& velocity,
                      const ParticleBlock& block) {
  double largest = 0, sum = 0;
  for (std::size_t i = block.begin; i < block.end; ++i) {
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

// Returns the report of two half steps: means over the time, sums and maxima.
StepReport joined(const StepReport& first, const StepReport& second) {
  StepReport both = second;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    both.sums.stress[t] = 0.5 * (first.sums.stress[t] + second.sums.stress[t]);
  }
  const auto mean = [](const SymmetricTensor& a, const SymmetricTensor& b) { return 0.5 * (a + b); };
  both.motion = mean(first.motion, second.motion);
  both.sums.contacts = 0.5 * (first.sums.contacts + second.sums.contacts);
  both.sums.overlaps = 0.5 * (first.sums.overlaps + second.sums.overlaps);
  both.sums.largest_overlap = std::max(first.sums.largest_overlap, second.sums.largest_overlap);
  both.largest_displacement = std::max(first.largest_displacement, second.largest_displacement);
  both.solver_iterations = first.solver_iterations + second.solver_iterations;
  both.solver_residual = 0.5 * (first.solver_residual + second.solver_residual);
  both.division = std::max(first.division, second.division);
  return both;
}

}  // namespace

Implicit::Implicit(const Physics& physics, const ParticleState& particles, double timestep, double tolerance,
                   std::uint64_t seed, int threads, InstructionSet set, double drag_share,
                   StepResistance::Part part)
    : Integrator(ForceField(without_noise(physics), particles, timestep, seed, threads, set, 0, part),
                 timestep),
      solver_(physics, particles, timestep, tolerance, threads, set, drag_share),
      loads_(particles.count(), threads),
      physics_(physics),
      seed_(seed),
      set_(set) {}

void Implicit::divide_steps(double longest_way) {
  longest_way_ = longest_way;
  divisions_left_ = deepest_division;
}

// A comparison with half steps costs a little more than three steps.
Integrator::Intervals Implicit::intervals() const {
  return {.sampling = 4, .energy = 500, .stability = 5000, .comparison = 100, .compared_steps = 1};
}

StepReport Implicit::advance_open(System& system) {
  const StepReport report = advance_part(system);
  ++system.step;
  return report;
}

// Makes a step or a part of one; the caller counts whole steps.
StepReport Implicit::advance_part(System& system) {
  if (meets_a_jump(system)) return advance_halves(system);
  const Deformation& deformation = physics_.flow.deformation();
  const double half = 0.5 * timestep_;
  follow_flow(system, deformation.velocity_gradient(system.clock.time() + half), half, field_.threads());
  origin_.mark(system, field_.threads());
  const bool list_is_new = displacement_bound_ == 0 &&
                           system.list.listed().displacement_gradient == system.box.displacement_gradient();
  std::optional<StepReport> found = find_velocities(system);
  if (!found && !list_is_new) {
    // Tries again from the origin, with a new list.
    return_to_origin(system);
    rebuild_list(system);
    origin_.mark(system, field_.threads());
    found = find_velocities(system);
  }
  StepReport report = found.value_or(StepReport{});
  report.broke_off = !found;
  report.largest_displacement = displacement(system);
  if (divisions_left_ > 0 && is_to_be_divided(report)) {
    return_to_origin(system);
    follow_flow(system, deformation.velocity_gradient(system.clock.time()), -half, field_.threads());
    return advance_halves(system);
  }
  if (!found) {
    // Even a new list does not hold. The reported displacement tells the caller why.
    report.largest_displacement = std::max(report.largest_displacement, system.list.ranges().largest());
    ++system.clock.steps;
    return report;
  }
  if (watcher() != nullptr) show_step(system);
  keep_change(system);
  move(system, timestep_);
  ++system.clock.steps;
  follow_flow(system, deformation.velocity_gradient(system.clock.time()), half, field_.threads());
  follow_list(system, report.largest_displacement);
  return report;
}

// Returns true if the flow jumps in this part of a step and the part may still be divided: down to 2^-5 of
// the step. After the jump the parts double in size.
bool Implicit::meets_a_jump(const System& system) const {
  constexpr int divisions = 5;
  constexpr double rounding = 1e-3;  // share of a part by which rounding may move the jump
  const double from = system.clock.time() - rounding * timestep_;
  return divisions_left_ > deepest_division - divisions &&
         physics_.flow.deformation().jumps_between(from, from + timestep_);
}

bool Implicit::is_to_be_divided(const StepReport& report) const {
  return report.broke_off || !report.sums.finite || !(report.largest_displacement <= longest_way_) ||
         (report.solver_residual > unsolved && divisions_left_ > deepest_division - divisions_of_unsolved);
}

void Implicit::show_step(const System& system) {
  field_.show_pairs(system, origin_.springs(), false, weight(), *watcher());
}

// Makes the step again from its origin, as two halves.
StepReport Implicit::advance_halves(System& system) {
  if (!half_) {
    half_ = with_timestep(0.5 * timestep_, system.particles);
    half_->divisions_left_ = divisions_left_ - 1;
    if (watches_motion()) half_->watch_motion();
  }
  half_->show_pairs_to(watcher(), 0.5 * weight());
  half_->forget_change();
  half_->displacement_bound_ = displacement_bound_;
  const Clock whole = system.clock;
  system.clock = whole.with_parts(2);
  const std::uint64_t part = system.part;
  system.part = 2 * part;
  StepReport report = half_->advance_part(system);
  if (!report.broke_off && report.sums.finite) {
    ++system.part;
    report = joined(report, half_->advance_part(system));
  }
  ++report.division;
  system.part = part;
  system.clock = {whole.origin, whole.timestep, whole.steps + 1};
  displacement_bound_ = half_->displacement_bound_;
  forget_change();
  return report;
}

// Rebuilds the list if it does not hold for the next step, now that particles have moved by up to `way`.
void Implicit::follow_list(System& system, double way) {
  displacement_bound_ += way + timestep_ * norm(system.box.velocity_gradient()) * displacement_bound_;
  const double allowed = system.list.allowed_displacement(system.box);
  // The list must leave room for half of a next step as large as this one.
  const double next = 0.5 * way;
  if (displacement_bound_ + next >= allowed) {
    displacement_bound_ = system.list.largest_displacement(system.particles, system.box, field_.threads());
    if (displacement_bound_ + next >= allowed) rebuild_list(system);
  }
}

void Implicit::return_to_origin(System& system) {
  origin_.return_to(system, field_.threads());
  system.box.deform(physics_.flow.deformation().displacement_gradient(system.clock.time()));
}

void Implicit::restore_springs(System& system) const {
  if (system.springs.kinds() != SpringKinds::none) system.springs = origin_.springs();
}

bool Implicit::move_half_a_step(System& system) {
  const double half = 0.5 * displacement(system);
  move(system, 0.5 * timestep_);
  const double allowed = system.list.allowed_displacement(system.box);
  return displacement_bound_ + half < allowed ||
         system.list.largest_displacement(system.particles, system.box, field_.threads()) < allowed;
}

// Moves particles and cell to where the present velocities lead from the origin in this time.
void Implicit::move(System& system, double time) {
  ParticleState& particles = system.particles;
  for_each_index(particles.count(), field_.threads(), [&](std::size_t i) {
    particles.position.row(i) = origin_.position().row(i) + time * particles.velocity.row(i);
  });
  system.box.deform(physics_.flow.deformation().displacement_gradient(system.clock.time() + time));
}

// Returns the largest displacement of a step at the present velocities, relative to the uniform flow; NaN if
// one is not finite.
double Implicit::displacement(const System& system) const {
  const Matrix3& gradient = system.box.velocity_gradient();
  const auto largest =
      gradient == simple_shear(gradient.column[1].x) ? largest_square<true> : largest_square<false>;
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  std::vector<double> squared(blocks.size());
  for_each_index(blocks.size(), field_.threads(), [&](std::size_t b) {
    squared[b] = largest(gradient, origin_.position(), system.particles.velocity, blocks[b]);
  });
  // NaN counts as the largest value.
  const auto is_less = [](double a, double b) { return !std::isnan(a) && !(a >= b); };
  return timestep_ * std::sqrt(*std::ranges::max_element(squared, is_less));
}

Integrator::HalfSteps Implicit::compare_half_steps(const System& system, int steps) const {
  // Returns the sum of the stress over the time of `steps` steps, in steps of timestep / every.
  const auto stress = [&](int every) {
    System copy = system;
    const std::unique_ptr<Implicit> integrator = with_timestep(timestep_ / every, copy.particles);
    copy.clock = system.clock.with_parts(every);
    integrator->displacement_bound_ = displacement_bound_;
    double sum = 0;
    for (int step = 1; step <= every * steps; ++step) {
      const PairSums sums = integrator->advance_open(copy).sums;
      for (const SymmetricTensor& s : sums.stress) {
        sum += physics_.flow.shear_part(s) / every;
      }
    }
    return sum;
  };
  return {stress(1), stress(2)};
}

// Returns an integrator for steps of this size that divides them in the same way.
std::unique_ptr<Implicit> Implicit::with_timestep(double timestep, const ParticleState& particles) const {
  std::unique_ptr<Implicit> other =
      implicit_steps(physics_, particles, timestep, solver_.tolerance(), seed_, field_.threads(), set_);
  other->longest_way_ = longest_way_;
  other->divisions_left_ = divisions_left_;
  return other;
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
