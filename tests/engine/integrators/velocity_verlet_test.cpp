#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "engine/terms/drag.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/every_image.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

// Returns spheres at rest in a cube.
System in_cube(const Physics& physics, const std::vector<double>& radius) {
  return spheres_in({20, 20, 20}, physics, radius);
}

// Two unequal spheres released at an overlap of 0.01: overlap 0.01 cos(w t), w^2 = k_n (1/m_i + 1/m_j).
struct Release {
  double position, velocity;  // errors at 0.7 / w
};

Release error_of_release(int steps) {
  Physics physics;
  physics.viscosity = 1e-15;
  physics.contact = ContactParameters{.normal_stiffness = 1e4};
  System system = in_cube(physics, {1, 1.4});
  system.particles.position.set(0, {10, 10, 10});
  system.particles.position.set(1, {12.39, 10, 10});
  const double w = std::sqrt(1e4 * (1 / system.particles.mass[0] + 1 / system.particles.mass[1]));
  VelocityVerlet integrator = explicit_steps(physics, system, 0.7 / w / steps);
  start_and_advance(integrator, system, steps);
  const ParticleState& p = system.particles;
  const double overlap = 2.4 - (p.position[1].x - p.position[0].x);
  return {std::abs(overlap - 0.01 * std::cos(0.7)),
          std::abs(p.velocity[1].x - p.velocity[0].x - 0.01 * w * std::sin(0.7))};
}

TEST(VelocityVerlet, IsOfSecondOrderForAContact) {
  Release coarse = error_of_release(10);
  EXPECT_LT(coarse.position, 1e-5);
  for (const int steps : {20, 40, 80}) {
    const Release fine = error_of_release(steps);
    EXPECT_NEAR(std::log2(coarse.position / fine.position), 2, 0.02) << steps;
    EXPECT_NEAR(std::log2(coarse.velocity / fine.velocity), 2, 0.02) << steps;
    coarse = fine;
  }
}

// Velocities relax to the flow as exp(-zeta t / m), spins to half the vorticity as exp(-zeta_r t / I).
TEST(VelocityVerlet, SpheresRelaxToTheStreamingFlow) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.flow = steady_shear(0.7);
  System system = in_cube(physics, {1.4});
  system.particles.position.set(0, {5, 12, 5});
  system.particles.velocity.set(0, {8.4, 0, 3});
  system.particles.angular_velocity.set(0, {2, 0, -0.35});
  const double m = 0.1 * 4 * pi / 3 * std::pow(1.4, 3), rate = 6 * pi * 0.1 * 1.4 / m;
  const double spin_rate = 8 * pi * 0.1 * std::pow(1.4, 3) / (0.4 * m * 1.4 * 1.4);
  constexpr int steps = 4000;
  VelocityVerlet integrator = explicit_steps(physics, system, 1 / rate / steps);
  start_and_advance(integrator, system, steps);
  const ParticleState& p = system.particles;
  EXPECT_NEAR(p.velocity[0].z, 3 * std::exp(-1.0), 1e-3);
  EXPECT_NEAR(p.velocity[0].x - 0.7 * p.position[0].y, 0, 1e-12);
  EXPECT_NEAR(p.angular_velocity[0].x, 2 * std::exp(-spin_rate / rate), 1e-3);
  EXPECT_NEAR(p.angular_velocity[0].z, -0.35, 1e-12);
}

// Returns the relative error of the velocity at t = 1 / l of two unit spheres at a gap of 0.01. They move
// slowly apart along their line of centres, or independently without lubrication: V ~ exp(-l t),
// l = (zeta + 2 X_A) / m. X_A = 6 pi eta (1 / (4 xi) + 9/40 ln(1 / xi)), see Li, Royer & Ness (2023).
double error_of_slowing(bool lubrication, int steps) {
  Physics physics;
  physics.viscosity = 0.1;
  if (lubrication) physics.lubrication = LubricationParameters{};
  System system = in_cube(physics, {1, 1});
  constexpr double speed = 1e-9, gap = 0.01;
  system.particles.position.set(0, {10, 10, 10});
  system.particles.position.set(1, {12 + gap, 10, 10});
  system.particles.velocity.set(0, {-speed, 0, 0});
  system.particles.velocity.set(1, {speed, 0, 0});
  const double drag = 6 * pi * 0.1, squeeze = drag * (0.25 / gap - 9.0 / 40 * std::log(gap));
  const double rate = (drag + (lubrication ? 2 * squeeze : 0)) / system.particles.mass[0];
  VelocityVerlet integrator = explicit_steps(physics, system, 1 / rate / steps);
  start_and_advance(integrator, system, steps);
  return std::abs(system.particles.velocity[1].x / speed * std::exp(1.0) - 1);
}

// Resistances act on the velocities of half a step before: U(n + 1/2) = (1 - l dt) U(n - 1/2).
TEST(VelocityVerlet, IsOfFirstOrderForDragAndLubrication) {
  for (const bool lubrication : {false, true}) {
    double coarse = error_of_slowing(lubrication, 40);
    EXPECT_LT(coarse, 0.05);
    for (const int steps : {80, 160, 320}) {
      const double fine = error_of_slowing(lubrication, steps);
      EXPECT_NEAR(std::log2(coarse / fine), 1, 0.05) << steps;
      coarse = fine;
    }
  }
}

// Returns the largest amplitude after many steps, relative to the first. Two equal spheres in a box just
// shorter than four radii touch on both sides: an oscillator of w^2 = 2 k_n (1/m + 1/m), damped at zeta / m.
double amplitude_after(double stiffness, double viscosity, double timestep) {
  Physics physics;
  physics.viscosity = viscosity;
  physics.contact = ContactParameters{.normal_stiffness = stiffness};
  System system = spheres_in({3.9, 10, 10}, physics, {1, 1});
  constexpr double first = 1e-9;
  system.particles.position.set(0, {1, 5, 5});
  system.particles.position.set(1, {1 + 1.95 + first, 5, 5});
  VelocityVerlet integrator = explicit_steps(physics, system, timestep);
  integrator.start(system);
  double amplitude = 0;
  for (int step = 0; step < 2000; ++step) {
    integrator.advance(system);
    const ParticleState& p = system.particles;
    const double way = p.position[1].x - p.position[0].x;
    amplitude = std::abs(way - 3.9 * std::round(way / 3.9 - 0.5) - 1.95);
    if (amplitude > 1e-3) break;
  }
  return amplitude / first;
}

TEST(VelocityVerlet, IsStableExactlyUpToItsLimit) {
  const double m = 0.1 * 4 * pi / 3;
  for (const double stiffness : {1e4, 1e2}) {
    for (const double viscosity : {1e-3, 0.1, 3.0}) {
      const double w2 = 2 * stiffness * 2 / m, l = 6 * pi * viscosity / m;
      const double limit = 4 / (l + std::sqrt(l * l + 4 * w2));  // from w^2 dt^2 + 2 l dt = 4
      ASSERT_NEAR(w2 * limit * limit + 2 * l * limit, 4, 1e-12);
      EXPECT_LT(amplitude_after(stiffness, viscosity, 0.99 * limit), 50) << stiffness << ' ' << viscosity;
      EXPECT_GT(amplitude_after(stiffness, viscosity, 1.01 * limit), 1e3) << stiffness << ' ' << viscosity;
    }
  }
}

// One contact without lubrication: relative motion has w^2 = k_n (1/m + 1/m) and the drag's rate l. Its
// stability limit is w^2 dt^2 + 2 l dt = 4.
TEST(VelocityVerlet, SharesOfStabilityWeighTheStiffnessOfAContact) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.contact = ContactParameters{.normal_stiffness = 1e4};
  const double m = 0.1 * 4 * pi / 3, w2 = 1e4 * 2 / m, l = 6 * pi * 0.1 / m;
  const double limit = 4 / (l + std::sqrt(l * l + 4 * w2));
  ASSERT_GT(w2 * limit * limit, 40 * 2 * l * limit);  // the stiffness dominates
  System system = in_cube(physics, {1, 1});
  system.particles.position.set(0, {10, 10, 10});
  system.particles.position.set(1, {11.99, 10, 10});
  for (const double part : {0.5, 1.0}) {
    VelocityVerlet integrator = explicit_steps(physics, system, part * limit);
    integrator.start(system);
    const double step = part * limit, share = (w2 * step * step + 2 * l * step) / 4;
    EXPECT_NEAR(integrator.stability_share(system) / share, 1, 0.02) << part;
  }
}

TEST(VelocityVerlet, StrainAfterNStepsIsNTimesRateAndStep) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.flow = steady_shear(0.7);
  System system = in_cube(physics, {1});
  VelocityVerlet integrator = explicit_steps(physics, system, 0.01);
  integrator.start(system);
  EXPECT_EQ(system.box.strain(), 0);
  for (int n = 1; n <= 5; ++n) {
    integrator.advance(system);
    EXPECT_NEAR(system.box.strain(), n * 0.7 * 0.01, 1e-15) << n;
    EXPECT_NEAR(system.box.tilt(), 20 * n * 0.7 * 0.01, 1e-12) << n;
  }
}

TEST(VelocityVerlet, ReportsTheLargestDisplacementRelativeToTheFlow) {
  Physics physics;
  physics.viscosity = 1e-15;
  physics.flow = steady_shear(100);
  System system = in_cube(physics, {1, 1});
  system.particles.position.set(0, {5, 15, 5});
  system.particles.velocity.set(0, {1500, 0, 0});  // at rest in the flow
  system.particles.position.set(1, {5, 5, 5});
  system.particles.velocity.set(1, {503, 4, 12});
  VelocityVerlet integrator = explicit_steps(physics, system, 1e-3);
  integrator.start(system);
  EXPECT_NEAR(integrator.advance(system).largest_displacement, 0.013, 1e-9);
}

// Spheres in contact fly apart beyond the list in one step, which reports this and drops the contact.
TEST(VelocityVerlet, AContactThatIsTornOpenInOneStepIsForgotten) {
  const Physics physics = physics_with({.contact = true, .friction = true});
  System system = in_cube(physics, {1, 1});
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, {6.99, 5, 5});
  system.particles.angular_velocity.set(0, {0, 0, 1});  // slip, so there is a spring
  VelocityVerlet integrator = explicit_steps(physics, system, 1e-3);
  integrator.start(system);
  ASSERT_EQ(held_contacts(system.list, system.particles, system.springs).size(), 1u);
  system.particles.velocity.set(1, {300, 0, 0});
  EXPECT_GT(integrator.advance(system).largest_displacement, 0.25);
  EXPECT_TRUE(held_contacts(system.list, system.particles, system.springs).empty());
}

class FlowingSuspension : public testing::Test {
 protected:
  FlowingSuspension() {
    for (std::size_t i = 0; i < 100; ++i) {
      ParticleState& particles = system_.particles;
      particles.velocity.set(i, {physics_.flow.rate() * particles.position[i].y, 0, 0});
    }
    integrator_.start(system_);
  }

  Physics physics_ = physics_with({.lubrication = true, .noise = true, .contact = true, .friction = true});
  System system_ = dense_suspension(physics_, 100, 5);
  VelocityVerlet integrator_ = explicit_steps(physics_, system_, 2e-4);
};

TEST_F(FlowingSuspension, EveryInteractingPairIsInTheListThroughRebuildsAndFlips) {
  const std::vector<double>& radius = system_.particles.radius;
  for (int step = 0; step < 2000; ++step) {
    integrator_.advance(system_);
    ASSERT_TRUE(system_.list.holds(system_.particles, system_.box)) << step;
    if (step % 10 != 0) continue;
    std::set<std::tuple<std::uint32_t, std::uint32_t, LatticeShift>> listed;
    for (const Pair& pair : system_.list.pairs()) {
      listed.emplace(pair.first, pair.second, system_.list.images()[pair.image]);
    }
    for (const SeenPair& pair :
         every_image(system_.particles.position, system_.box.lengths(), system_.box.tilt(),
                     [&](std::uint32_t i, std::uint32_t j) { return 1.025 * (radius[i] + radius[j]); })) {
      ASSERT_TRUE(listed.count({pair.first, pair.second, pair.image})) << step;
    }
  }
  EXPECT_GT(system_.list.builds(), 10u);
  EXPECT_NE(system_.box.basis(), BasisChange{});
}

// At each rebuild the old list was no longer valid at the positions before wrapping.
TEST_F(FlowingSuspension, TheListIsNotRebuiltTooSoon) {
  int rebuilds = 0;
  for (int step = 0; step < 2000; ++step) {
    const System before = system_;
    integrator_.advance(system_);
    if (system_.list.builds() == before.list.builds() || system_.box.basis() != before.box.basis()) continue;
    ParticleState unwrapped = system_.particles;
    for (std::size_t i = 0; i < unwrapped.count(); ++i) {
      const LatticeShift removed = unwrapped.image[i] - before.particles.image[i];
      unwrapped.position.set(i, unwrapped.position[i] + system_.box.displacement(removed));
    }
    ++rebuilds;
    EXPECT_FALSE(before.list.holds(unwrapped, system_.box)) << step;
  }
  EXPECT_GT(rebuilds, 10);
}

}  // namespace
}  // namespace peclet::engine
