#include "engine/integrators/velocity_verlet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/integrators/spectral_bound.h"
#include "engine/integrators/spurious_energy.h"
#include "engine/state/for_each_range.h"

namespace peclet::engine {

VelocityVerlet::VelocityVerlet(ForceField field, const ParticleState& particles, double timestep)
    : field_(std::move(field)), timestep_(timestep), force_(particles.count()), torque_(particles.count()) {
  kicks_.resize(distinct_radii(particles.radius).size());
  for (std::size_t i = 0; i < particles.count(); ++i) {
    kicks_[particles.size_class[i]] = {0.5 * timestep / particles.mass[i],
                                       0.5 * timestep / particles.inertia[i]};
  }
}

void VelocityVerlet::start(System& system) {
  const SpringKinds kinds = spring_kinds(field_.terms());
  if (system.springs.kinds() != kinds) {
    system.springs = SpringField(kinds, system.list.pairs().size());
  }
  rebuild_neighbours(system, field_.threads());
  displacement_bound_ = 0;
  field_.evaluate(system, force_, torque_);
}

StepReport VelocityVerlet::advance(System& system) {
  kick(system.particles);
  const double speed = drift(system.particles);
  ++system.step;
  system.box.set_strain(system.box.shear_rate() * timestep_ * static_cast<double>(system.step));
  // Beyond all bounds there are no neighbours to be found; whoever asked for the step sees why.
  if (!(speed * timestep_ < system.list.ranges().largest())) {
    return {{}, speed * timestep_};
  }
  keep_list(system, speed);
  const PairSums sums = field_.evaluate(system, force_, torque_);
  kick(system.particles);
  return {sums, speed * timestep_};
}

// A mode z of z^2 - (2 - l - k) z + (1 - l) = 0, with l and k the means of dt M^-1 R and dt^2 M^-1 K over its
// shape, decays if and only if 2 l + k < 4.
double VelocityVerlet::stability_share(const System& system) const {
  const MatrixWeights quarters = {0.5 * timestep_, 0.25 * timestep_ * timestep_};
  return largest_eigenvalue(PackingMatrix(system, field_.kinds(), field_.physics(), quarters)).upper();
}

double VelocityVerlet::spurious_energy(const System& system) const {
  return engine::spurious_energy(system, field_.kinds(), field_.physics(), force_, torque_, timestep_);
}

void VelocityVerlet::kick(ParticleState& particles) const {
  for_each_range(particles.count(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Kick& of = kicks_[particles.size_class[i]];
      particles.velocity.row(i) += of.translational * force_.row(i);
      particles.angular_velocity.row(i) += of.rotational * torque_.row(i);
    }
  });
}

// Moves the particles; returns the largest speed relative to the streaming flow, NaN if one is not finite.
double VelocityVerlet::drift(ParticleState& particles) const {
  double largest_of_all = 0;
  bool all_bounded = true;
  for_each_range(particles.count(), field_.threads(), [&](std::size_t begin, std::size_t end) {
    double largest = 0, sum = 0;
    const double rate = field_.physics().shear_rate, dt = timestep_;
    for (std::size_t i = begin; i < end; ++i) {
      const Row& u = particles.velocity.row(i);
      Row& x = particles.position.row(i);
      const double peculiar = u[0] - rate * x[1];
      const double squared = peculiar * peculiar + u[1] * u[1] + u[2] * u[2];
      largest = largest > squared ? largest : squared;
      sum += squared;
      x += dt * u;
    }
#pragma omp critical(drift)
    {
      largest_of_all = std::max(largest_of_all, largest);
      all_bounded = all_bounded && std::isfinite(sum);  // max() would pass over a NaN
    }
  });
  return all_bounded ? std::sqrt(largest_of_all) : std::numeric_limits<double>::quiet_NaN();
}

void VelocityVerlet::keep_list(System& system, double speed) {
  // A displacement d grows by dt (u - rate y_reference) = dt (peculiar velocity + rate d_y).
  displacement_bound_ += timestep_ * (speed + system.box.shear_rate() * displacement_bound_);
  const double allowed = system.list.allowed_displacement(system.box);
  if (displacement_bound_ < allowed) {
    return;
  }
  displacement_bound_ = system.list.largest_displacement(system.particles, system.box);
  if (!(displacement_bound_ < allowed)) {
    rebuild_neighbours(system, field_.threads());
    displacement_bound_ = 0;
  }
}

void VelocityVerlet::save(ArchiveWriter& archive) const {
  archive.put(force_);
  archive.put(torque_);
  archive.put(displacement_bound_);
}

void VelocityVerlet::load(const System& system, ArchiveReader& archive) {
  force_ = archive.get_field(system.particles.count());
  torque_ = archive.get_field(system.particles.count());
  displacement_bound_ = archive.get<double>();
}

}  // namespace peclet::engine
