#include "engine/start/relaxation.h"

#include <algorithm>
#include <utility>

#include "engine/integrators/midpoint.h"
#include "engine/stability/stability.h"

namespace peclet::engine {

void relax(System& system, const Scene& scene, int threads, const std::function<void()>& made_step) {
  constexpr int most_steps = 200;
  const double timestep = automatic_implicit_timestep(scene);
  const double far = 0.05 * *std::min_element(system.particles.radius.begin(), system.particles.radius.end());
  Physics still = scene.physics;
  still.flow = {};
  still.thermal_energy = 0;
  if (still.contact) {
    still.contact->friction = 0;
    still.contact->rolling_stiffness = 0;
  }
  const PeriodicCell sheared = system.box;
  system.box.set_velocity_gradient({});
  double step = timestep;
  for (int made = 0; made < most_steps; ++made) {
    System trial = system;
    trial.particles.velocity = VectorField(trial.particles.count(), threads);
    trial.particles.angular_velocity = VectorField(trial.particles.count(), threads);
    Midpoint integrator(still, trial.particles, step, scene.solver_tolerance, 0, threads);
    integrator.start(trial);
    const StepReport report = integrator.advance(trial);
    made_step();
    if (!(report.largest_displacement <= far) || !report.sums.finite) {
      step /= 4;
      continue;
    }
    system = std::move(trial);
    if (step == timestep) {
      break;
    }
    step = std::min(2 * step, timestep);
  }
  system.step = 0;
  system.clock = {};
  system.box = sheared;
}

}  // namespace peclet::engine
