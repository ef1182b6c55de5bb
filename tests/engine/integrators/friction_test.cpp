// Kinetic friction below static friction, and contacts with a tangential dashpot, in explicit and implicit
// steps.
#include <gtest/gtest.h>

#include "tests/engine/few_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

enum class Steps { verlet, midpoint, noisy };
const auto every_kind_of_steps = testing::Values(Steps::verlet, Steps::midpoint, Steps::noisy);
const auto name_of_steps = [](const auto& kind) {
  return kind.param == Steps::verlet ? "explicit" : kind.param == Steps::midpoint ? "implicit" : "noisy";
};

class KineticFrictionOf : public testing::TestWithParam<Steps> {
 protected:
  static constexpr double step = 1e-3, slip = 0.55, stiffness = 300, still = 0.4, kinetic = 0.25;
  static constexpr double load = 10;  // k_n delta

  static std::unique_ptr<Integrator> integrator(Physics physics, const System& system) {
    if (GetParam() == Steps::verlet)
      return std::make_unique<VelocityVerlet>(explicit_steps(physics, system, step));
    physics.thermal_energy = GetParam() == Steps::noisy ? 1e-30 : 0;
    return implicit_steps(physics, system.particles, step, 1e-3, 1, 1);
  }
};
INSTANTIATE_TEST_SUITE_P(EveryKind, KineticFrictionOf, every_kind_of_steps, name_of_steps);

// Heavy spheres in contact pass each other at constant velocity, then in reverse. The spring grows by dt v_t
// a step, breaks away and slides. The load is constant within one per cent.
TEST_P(KineticFrictionOf, BreaksAwaySlidesAndSticksAgain) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.contact = ContactParameters{.normal_stiffness = 1e3,
                                      .friction = still,
                                      .kinetic_friction = kinetic,
                                      .tangential_stiffness = stiffness};
  System system = spheres_in({20, 20, 20}, physics, {1, 1.4}, 1e6);
  system.particles.position.set(0, {10, 10, 10});
  system.particles.position.set(1, {12.39, 10, 10});
  const std::unique_ptr<Integrator> steps = integrator(physics, system);
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

std::string bytes_after_60_steps(const Json& patch) {
  Simulation simulation = started(scene_from(patch), 3);
  simulation.advance(60);
  return bytes_of(simulation);
}

TEST(KineticFriction, ThatIsTheStaticOneHasTheSameBits) {
  for (Json patch : {Json::object(), implicit_and_light}) {
    const std::string without = bytes_after_60_steps(patch);
    patch["contact"]["kinetic_friction"] = 0.5;
    EXPECT_EQ(bytes_after_60_steps(patch), without);
  }
}

// Returns the slip of two touching spheres that spin alike, relative to its initial value. With s' = -(l_i
// Omega_i + l_j Omega_j) x n = -2 l Omega across n, I Omega' = l F and F = k_t s + gamma_t s', the slip v = 2
// l Omega obeys v' = -2 l^2 / I (k_t s + gamma_t v): an oscillator of w^2 = 2 l^2 k_t / I, damped at the rate
// b = l^2 gamma_t / I.
double slip_after(double time, double rate, double squared_frequency) {
  const double w = std::sqrt(squared_frequency - rate * rate);
  return std::exp(-rate * time) * (std::cos(w * time) - rate / w * std::sin(w * time));
}

class DampedContactOf : public testing::TestWithParam<Steps> {};
INSTANTIATE_TEST_SUITE_P(EveryKind, DampedContactOf, every_kind_of_steps, name_of_steps);

TEST_P(DampedContactOf, OscillatesAsSpheresThatTurnAlikeDo) {
  constexpr double stiffness = 300, damping = 1.5, lever = 0.995, step = 1e-4;
  Physics physics;
  physics.viscosity = 1e-9;
  physics.thermal_energy = GetParam() == Steps::noisy ? 1e-30 : 0;
  physics.contact = ContactParameters{.normal_stiffness = 1e3,
                                      .friction = 1e3,
                                      .tangential_stiffness = stiffness,
                                      .tangential_damping = damping};
  System system = spheres_in({20, 20, 20}, physics, {1, 1}, 1);
  // Masses so large that the spheres neither part nor orbit; the inertia is that of density 1.
  for (const std::size_t i : {0UL, 1UL}) system.particles.mass[i] = 1e9;
  system.particles.position.set(0, {9, 10, 10});
  system.particles.position.set(1, {9 + 2 * lever, 10, 10});
  for (const std::size_t i : {0UL, 1UL}) system.particles.angular_velocity.set(i, {0, 0, 1e-3});
  const auto steps = steps_of_method(GetParam() != Steps::verlet, physics, system, step, 1e-6);
  steps->start(system);
  const double inertia = system.particles.inertia[0];
  const double rate = lever * lever * damping / inertia,
               squared_frequency = 2 * lever * lever * stiffness / inertia;
  for (int k = 1; k <= 4000; ++k) {
    steps->advance(system);
    if (k % 500 != 0) continue;
    EXPECT_NEAR(system.particles.angular_velocity[0].z / 1e-3, slip_after(k * step, rate, squared_frequency),
                0.01)
        << k;
  }
}

}  // namespace
}  // namespace peclet::engine
