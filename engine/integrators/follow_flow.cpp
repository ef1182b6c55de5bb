#include "engine/integrators/follow_flow.h"

#include "engine/flow/background_flow.h"
#include "engine/threads/for_each_range.h"

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
  for_each_range(particles.count(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      particles.velocity.add(i, gain * particles.position[i]);
      particles.angular_velocity.add(i, spin);
    }
  });
  system.box.set_velocity_gradient(gradient);
}

}  // namespace peclet::engine
