#include "tests/bench/engine/tiling.h"

namespace peclet::engine {

System tiled(const System& system, int times) {
  const ParticleState& small = system.particles;
  const PeriodicCell& box = system.box;
  System result;
  result.step = system.step;
  result.clock = system.clock;
  result.box = box.enlarged(times);

  const auto copies =
      static_cast<std::size_t>(times) * static_cast<std::size_t>(times) * static_cast<std::size_t>(times);
  const std::size_t count = copies * small.count();
  ParticleState& large = result.particles;
  large.position = large.velocity = large.angular_velocity = VectorField(count);
  large.image.resize(count);
  std::size_t i = 0;
  LatticeShift shift;
  for (shift.z = 0; shift.z < times; ++shift.z) {
    for (shift.y = 0; shift.y < times; ++shift.y) {
      for (shift.x = 0; shift.x < times; ++shift.x) {
        const Vector3 displacement = box.displacement(shift);
        const Vector3 velocity = box.velocity(shift);
        for (std::size_t k = 0; k < small.count(); ++k, ++i) {
          large.radius.push_back(small.radius[k]);
          large.mass.push_back(small.mass[k]);
          large.inertia.push_back(small.inertia[k]);
          large.size_class.push_back(small.size_class[k]);
          large.id.push_back(static_cast<std::uint32_t>(i));
          large.position.set(i, small.position[k] + displacement);
          large.velocity.set(i, small.velocity[k] + velocity);
          large.angular_velocity.set(i, small.angular_velocity[k]);
        }
      }
    }
  }
  return result;
}

}  // namespace peclet::engine
