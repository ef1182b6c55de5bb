#include "engine/integrators/step_origin.h"

#include "engine/threads/for_each_range.h"

namespace peclet::engine {
namespace {

// Springs, cell and clock, and the rows of places and motion.
void copy_state(const System& from, System& to, int threads) {
  for_each_range(from.particles.position.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      to.particles.position.row(i) = from.particles.position.row(i);
      to.particles.velocity.row(i) = from.particles.velocity.row(i);
      to.particles.angular_velocity.row(i) = from.particles.angular_velocity.row(i);
    }
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

// A rebuild arranges the particles anew.
void StepOrigin::return_to(System& system, int threads) const {
  const bool has_list = marked_.list.builds() > 0;
  if (has_list && marked_.list.builds() != system.list.builds()) {
    system.particles = marked_.particles;
    system.list = marked_.list;
  }
  copy_state(marked_, system, threads);
}

}  // namespace peclet::engine
