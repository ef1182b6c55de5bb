// A contact with a tangential dashpot, in explicit and implicit steps.
#include <gtest/gtest.h>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"

namespace peclet::engine {
namespace {

// Returns the slip of two touching spheres that spin alike, relative to its initial value. With s' = -(l_i
// Omega_i + l_j Omega_j) x n = -2 l Omega across n, I Omega' = l F and F = k_t s + gamma_t s', the slip v = 2
// l Omega obeys v' = -2 l^2 / I (k_t s + gamma_t v): an oscillator of w^2 = 2 l^2 k_t / I, damped at the rate
// b = l^2 gamma_t / I.
double slip_after(double time, double rate, double squared_frequency) {
  const double w = std::sqrt(squared_frequency - rate * rate);
  return std::exp(-rate * time) * (std::cos(w * time) - rate / w * std::sin(w * time));
}

enum class DampedSteps { verlet, midpoint, noisy };

class DampedContactOf : public testing::TestWithParam<DampedSteps> {};
INSTANTIATE_TEST_SUITE_P(EveryKind, DampedContactOf,
                         testing::Values(DampedSteps::verlet, DampedSteps::midpoint, DampedSteps::noisy),
                         [](const auto& kind) {
                           return kind.param == DampedSteps::verlet     ? "explicit"
                                  : kind.param == DampedSteps::midpoint ? "implicit"
                                                                        : "noisy";
                         });

TEST_P(DampedContactOf, OscillatesAsSpheresThatTurnAlikeDo) {
  constexpr double stiffness = 300, damping = 1.5, lever = 0.995, step = 1e-4;
  Physics physics;
  physics.viscosity = 1e-9;
  physics.thermal_energy = GetParam() == DampedSteps::noisy ? 1e-30 : 0;
  physics.contact = ContactParameters{.normal_stiffness = 1e3,
                                      .friction = 1e3,
                                      .tangential_stiffness = stiffness,
                                      .tangential_damping = damping};
  System system;
  system.particles = make_particles({1, 1}, 1);
  system.box = PeriodicCell({20, 20, 20}, Matrix3{});
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1}), 1), 0.1);
  // Masses so large that the spheres neither part nor orbit; the inertia is that of density 1.
  for (const std::size_t i : {0UL, 1UL}) system.particles.mass[i] = 1e9;
  system.particles.position.set(0, {9, 10, 10});
  system.particles.position.set(1, {9 + 2 * lever, 10, 10});
  for (const std::size_t i : {0UL, 1UL}) system.particles.angular_velocity.set(i, {0, 0, 1e-3});
  std::unique_ptr<Integrator> steps;
  if (GetParam() == DampedSteps::verlet) {
    steps = std::make_unique<VelocityVerlet>(ForceField(physics, system.particles, step, 1, 1),
                                             system.particles, step);
  } else {
    steps = implicit_steps(physics, system.particles, step, 1e-6, 1, 1);
  }
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
