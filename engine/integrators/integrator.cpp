#include "engine/integrators/integrator.h"

#include "engine/flow/background_flow.h"
#include "engine/state/threads.h"

namespace peclet::engine {

bool keeps_flow(const System& system, const Matrix3& gradient) {
  return gradient == system.box.velocity_gradient() && gradient * gradient == Matrix3{};
}

void follow_flow(System& system, const Matrix3& gradient, double time, int threads) {
  if (keeps_flow(system, gradient)) return;
  const Matrix3 change = gradient - system.box.velocity_gradient();
  const Matrix3 gain = change + time * (gradient * gradient);
  const Vector3 spin = spin_of(change);
  ParticleState& particles = system.particles;
  for_each_index(particles.count(), threads, [&](std::size_t i) {
    particles.velocity.add(i, gain * particles.position[i]);
    particles.angular_velocity.add(i, spin);
  });
  system.box.set_velocity_gradient(gradient);
}

namespace {

void copy_state(const System& from, System& to, int threads) {
  for_each_index(from.particles.position.size(), threads, [&](std::size_t i) {
    to.particles.position.row(i) = from.particles.position.row(i);
    to.particles.velocity.row(i) = from.particles.velocity.row(i);
    to.particles.angular_velocity.row(i) = from.particles.angular_velocity.row(i);
  });
  to.springs = from.springs;
  to.box = from.box;
  to.clock = from.clock;
  to.step = from.step;
  to.part = from.part;
}

}  // namespace

void StepOrigin::mark(const System& system, int threads) {
  const std::size_t count = system.particles.count();
  ParticleState& particles = marked_.particles;
  for (VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    if (field->size() != count) *field = VectorField(count, threads);
  }
  copy_state(system, marked_, threads);
}

void StepOrigin::mark_with_list(const System& system, int threads) {
  if (marked_.list.builds() != system.list.builds()) {
    marked_.particles = system.particles;
    marked_.list = system.list;
  }
  mark(system, threads);
}

// Restores particles and list as well if a rebuild has reordered them.
void StepOrigin::return_to(System& system, int threads) const {
  const bool has_list = marked_.list.builds() > 0;
  if (has_list && marked_.list.builds() != system.list.builds()) {
    system.particles = marked_.particles;
    system.list = marked_.list;
  }
  copy_state(marked_, system, threads);
}

void Integrator::start(System& system) {
  const SpringKinds kinds = spring_kinds(field_.terms());
  if (system.springs.kinds() != kinds) system.springs = SpringField(kinds, system.list.pairs().size());
  system.clock.count_in(timestep_);
  rebuild_list(system);
}

void Integrator::rebuild_list(System& system) {
  rebuild_neighbours(system, field_.threads());
  displacement_bound_ = 0;
}

void Integrator::mark(const System& system) {
  mark_.mark_with_list(system, field_.threads());
  marked_bound_ = displacement_bound_;
}

void Integrator::return_to_mark(System& system) {
  mark_.return_to(system, field_.threads());
  displacement_bound_ = marked_bound_;
}

}  // namespace peclet::engine
