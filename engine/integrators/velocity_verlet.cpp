#include "engine/integrators/velocity_verlet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "engine/integrators/acted_stress.h"
#include "engine/integrators/spectral_bound.h"
#include "engine/integrators/spurious_energy.h"
#include "engine/state/threads.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Returns the speeds of two groups of particles together.
Speeds either(const Speeds& a, const Speeds& b) { return {std::max(a.largest, b.largest), a.sum + b.sum}; }

// Returns the largest speed; NaN if one is not finite.
double largest(const Speeds& speeds) {
  return std::isfinite(speeds.sum) ? std::sqrt(speeds.largest) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

VelocityVerlet::VelocityVerlet(ForceField field, const ParticleState& particles, double timestep)
    : Integrator(std::move(field), timestep),
      force_(particles.count(), field_.threads()),
      torque_(particles.count(), field_.threads()) {
  kicks_.resize(distinct_radii(particles.radius).size());
  for (std::size_t i = 0; i < particles.count(); ++i) {
    kicks_[particles.size_class[i]] = {0.5 * timestep / particles.mass[i],
                                       0.5 * timestep / particles.inertia[i]};
  }
}

// A comparison with half steps lasts some twenty times of the fastest modes.
Integrator::Intervals VelocityVerlet::intervals() const {
  return {.sampling = 50, .energy = 500, .stability = 5000, .comparison = 10000, .compared_steps = 20};
}

void VelocityVerlet::start(System& system) {
  Integrator::start(system);
  field_.evaluate(system, force_, torque_);
  open_ = false;
}

StepReport VelocityVerlet::advance_open(System& system) {
  ++system.step;
  ++system.clock.steps;
  const Deformation& deformation = field_.physics().flow.deformation();
  const Matrix3 gradient = deformation.velocity_gradient(system.clock.time());
  if (!keeps_flow(system, gradient)) {
    complete(system);
    follow_flow(system, gradient, timestep_, field_.threads());
  }
  system.box.deform(deformation.displacement_gradient(system.clock));
  // Moving and evaluating in one pass gives the same numbers. Only after it is known whether the list still
  // holds; if not, pairs are computed again with a new list. Springs would then advance twice.
  const bool in_one_walk = field_.threads() <= 1 && system.springs.kinds() == SpringKinds::none;
  double speed = 0;
  PairSums sums;
  if (in_one_walk) {
    std::tie(speed, sums) = move_and_evaluate(system);
  } else {
    speed = move(system);
  }
  StepReport report;
  report.largest_displacement = speed * timestep_;
  // Displacements beyond the range of the list: the step ends here, and the caller reports the cause.
  if (!(speed * timestep_ < system.list.ranges().largest())) return report;
  if (keep_list(system, speed) || !in_one_walk) sums = field_.evaluate_blocks(system, force_, torque_);
  open_ = true;
  report.sums = sums;
  const bool has_noise = field_.physics().thermal_energy > 0;
  if (watcher() != nullptr) {
    field_.show_pairs(system, system.springs, true, weight(), *watcher());
    for (std::size_t i = 0; has_noise && i < system.particles.count(); ++i) {
      watcher()->take_motion(system, i, motion(system, i));
    }
  }
  if (watches_motion() || has_noise) {
    report.motion =
        sum_over_particles(system, field_.threads(), [&](std::size_t i) { return motion(system, i); });
  }
  return report;
}

// Returns the stress of the motion of a particle, times the volume: -m v v with the velocity v of the half
// step, plus half a step of drag. The drag acts at the end of the way that it resists; moved to the middle it
// has no mean. Then a free particle carries kT.
SymmetricTensor VelocityVerlet::motion(const System& system, std::size_t i) const {
  const ParticleState& particles = system.particles;
  const Vector3 v = particles.velocity[i] -
                    field_.physics().flow.at(system.box).velocity(particles.position[i], particles.radius[i]);
  const double drag = translational_drag(field_.physics().viscosity, particles.radius[i]);
  return (0.5 * timestep_ * drag - particles.mass[i]) * symmetric_dyad(v, v);
}

// A mode z of z^2 - (2 - l - k) z + (1 - l) = 0 decays if and only if 2 l + k < 4, with the means l and k of
// dt M^-1 R and dt^2 M^-1 K over its shape.
double VelocityVerlet::stability_share(const System& system) const {
  const MatrixWeights quarters = {0.5 * timestep_, 0.25 * timestep_ * timestep_};
  return largest_eigenvalue(PackingMatrix(system, field_.kinds(), field_.physics(), quarters)).upper();
}

std::optional<double> VelocityVerlet::spurious_energy(const System& system) const {
  return engine::spurious_energy(system, field_.kinds(), field_.physics(), force_, torque_, timestep_);
}

Integrator::HalfSteps VelocityVerlet::compare_half_steps(const System& system, int steps) const {
  // Returns the sum of the stress at the ends of `steps` whole steps, made in steps of timestep / every.
  const auto stress = [&](int every) {
    System copy = system;
    const double timestep = timestep_ / every;
    VelocityVerlet integrator(ForceField(field_.physics(), copy.particles, timestep, 0, field_.threads()),
                              copy.particles, timestep);
    copy.clock = system.clock.with_parts(every);
    integrator.force_ = force_;
    integrator.torque_ = torque_;
    integrator.displacement_bound_ = displacement_bound_;
    double sum = 0;
    for (int step = 1; step <= every * steps; ++step) {
      const PairSums sums = integrator.advance_open(copy).sums;
      for (const SymmetricTensor& s : sums.stress) {
        sum += step % every == 0 ? field_.physics().flow.shear_part(s) : 0;
      }
    }
    return sum;
  };
  return {stress(1), stress(2)};
}

OneBodyInput VelocityVerlet::kick_input(System& system) {
  return field_.one_body_input(system, force_, torque_, kicks_.data());
}

// Adds the forces that the last step has left for this block.
void VelocityVerlet::add_due(const System& system, const ParticleBlock& block) {
  if (open_) field_.add_incoming(system, block, force_, torque_);
}

void VelocityVerlet::complete(System& system) {
  if (!open_) return;
  const OneBodyInput input = kick_input(system);
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  for_each_index(blocks.size(), field_.threads(), [&](std::size_t b) {
    field_.add_incoming(system, blocks[b], force_, torque_);
    field_.one_body().kick(input, blocks[b].begin, blocks[b].end);
  });
  open_ = false;
}

// Makes the second kick of the last step if it is due, the first kick and the drift, in one pass over the
// particles. Returns the largest speed relative to the flow; NaN if one is not finite.
double VelocityVerlet::move(System& system) {
  const OneBodyInput input = kick_input(system);
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  Speeds all;
  for_each_range(blocks.size(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    Speeds speeds;
    for (std::size_t b = begin; b < end; ++b) {
      add_due(system, blocks[b]);
      speeds = either(
          speeds, field_.one_body().kick_and_drift(input, blocks[b].begin, blocks[b].end, open_, timestep_));
    }
#pragma omp critical(move)
    {
      acquire_work();
      all = either(all, speeds);
      release_work();
    }
  });
  open_ = false;
  return largest(all);
}

// Moves each block just before its pairs are evaluated, while it is in the cache. Particles of later blocks,
// which have not moved yet, are in no pair of this block.
std::pair<double, PairSums> VelocityVerlet::move_and_evaluate(System& system) {
  const OneBodyInput input = kick_input(system);
  Speeds speeds;
  const PairSums sums = field_.evaluate_blocks(system, force_, torque_, [&](const ParticleBlock& block) {
    add_due(system, block);
    speeds = either(speeds,
                    field_.one_body().kick_drift_and_drag(input, block.begin, block.end, open_, timestep_));
  });
  open_ = false;
  return {largest(speeds), sums};
}

// Rebuilds the list if it does not hold. Returns true if it was rebuilt.
bool VelocityVerlet::keep_list(System& system, double speed) {
  // A displacement d grows by dt (u - L x_reference) = dt (peculiar velocity + L d).
  displacement_bound_ += timestep_ * (speed + norm(system.box.velocity_gradient()) * displacement_bound_);
  const double allowed = system.list.allowed_displacement(system.box);
  if (displacement_bound_ < allowed) return false;
  displacement_bound_ = system.list.largest_displacement(system.particles, system.box);
  if (displacement_bound_ < allowed) return false;
  rebuild_list(system);
  return true;
}

void VelocityVerlet::mark(const System& system) {
  Integrator::mark(system);
  marked_force_ = force_;
  marked_torque_ = torque_;
}

void VelocityVerlet::return_to_mark(System& system) {
  Integrator::return_to_mark(system);
  force_ = marked_force_;
  torque_ = marked_torque_;
  open_ = false;
}

void VelocityVerlet::save(ArchiveWriter& archive) const {
  if (open_) throw std::logic_error("a step must be complete to be saved");
  archive.put_all(force_, torque_);
  Integrator::save(archive);
}

void VelocityVerlet::load(ArchiveReader& archive) {
  archive.get_all(force_, torque_);
  Integrator::load(archive);
  open_ = false;
}

}  // namespace peclet::engine
