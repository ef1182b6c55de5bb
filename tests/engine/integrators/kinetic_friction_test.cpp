// Kinetic friction below static friction, in explicit and implicit steps.
#include <gtest/gtest.h>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

enum class Steps { verlet, midpoint, noisy };

class KineticFrictionOf : public testing::TestWithParam<Steps> {
 protected:
  static constexpr double step = 1e-3, slip = 0.55, stiffness = 300, still = 0.4, kinetic = 0.25;
  static constexpr double load = 10;  // k_n delta

  static std::unique_ptr<Integrator> integrator(Physics physics, const ParticleState& particles) {
    if (GetParam() == Steps::verlet) {
      return std::make_unique<VelocityVerlet>(ForceField(physics, particles, step, 1, 1), particles, step);
    }
    physics.thermal_energy = GetParam() == Steps::noisy ? 1e-30 : 0;
    return implicit_steps(physics, particles, step, 1e-3, 1, 1);
  }
};
INSTANTIATE_TEST_SUITE_P(EveryKind, KineticFrictionOf,
                         testing::Values(Steps::verlet, Steps::midpoint, Steps::noisy), [](const auto& kind) {
                           return kind.param == Steps::verlet     ? "explicit"
                                  : kind.param == Steps::midpoint ? "implicit"
                                                                  : "noisy";
                         });

// Heavy spheres in contact pass each other at constant velocity, then in reverse. The spring grows by dt v_t
// a step, breaks away and slides. The load is constant within one per cent.
TEST_P(KineticFrictionOf, BreaksAwaySlidesAndSticksAgain) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.contact = ContactParameters{.normal_stiffness = 1e3,
                                      .friction = still,
                                      .kinetic_friction = kinetic,
                                      .tangential_stiffness = stiffness};
  System system;
  system.particles = make_particles({1, 1.4}, 1e6);
  system.box = PeriodicCell({20, 20, 20}, Matrix3{});
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1, 1.4}), 2), 0.1);
  system.particles.position.set(0, {10, 10, 10});
  system.particles.position.set(1, {12.39, 10, 10});
  const std::unique_ptr<Integrator> steps = integrator(physics, system.particles);
  steps->start(system);
  const auto move = [&](double velocity, int count) {
    const std::size_t second = system.particles.id[0] == 1 ? 0 : 1;
    system.particles.velocity.set(second, {0, 0, velocity});
    for (int k = 0; k < count; ++k) steps->advance(system);
    EXPECT_NEAR(system.particles.velocity[second].z / velocity, 1, 1e-3);
    const auto held = held_contacts(system.list, system.particles, system.springs);
    EXPECT_EQ(held.size(), 1u);
    return held.front().springs;
  };
  const auto expect_springs = [](const ContactSprings& found, double length, bool slides) {
    EXPECT_NEAR(found.tangential.z / length, 1, 0.02);
    EXPECT_EQ(found.slides, slides ? 1 : 0);
  };
  const double stretch = slip * step, sliding = kinetic * load / stiffness;
  expect_springs(move(slip, 24), 24 * stretch, false);  // 0.0132 < 0.4 * 10 / 300
  expect_springs(move(slip, 1), sliding, true);
  expect_springs(move(slip, 20), sliding, true);
  expect_springs(move(-slip, 1), sliding - stretch, false);
  expect_springs(move(-slip, 36), sliding - 37 * stretch, false);  // 0.0120 in reverse
  expect_springs(move(-slip, 10), -sliding, true);
}

std::string bytes_of_run(const Json& patch, std::uint64_t steps) {
  const Scene scene = read_scene(small_scene(patch), "scene.json");
  Simulation simulation(scene, make_schedule(scene, "scene.json"), 3, 1, "scene.json");
  simulation.start();
  simulation.advance(steps);
  ArchiveWriter archive;
  simulation.save(archive);
  return archive.bytes();
}

TEST(KineticFriction, ThatIsTheStaticOneHasTheSameBits) {
  const Json explicit_steps = Json::object();
  const Json implicit_steps = {{"integrator", {{"method", "implicit"}}}, {"particles", {{"density", 0.01}}}};
  for (Json patch : {explicit_steps, implicit_steps}) {
    const std::string without = bytes_of_run(patch, 60);
    patch["contact"]["kinetic_friction"] = 0.5;
    EXPECT_EQ(bytes_of_run(patch, 60), without);
  }
}

}  // namespace
}  // namespace peclet::engine
