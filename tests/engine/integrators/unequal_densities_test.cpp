// A density for each size: velocities and spins relax at the rates zeta / m = 4.5 eta / (rho a^2) and
// zeta_r / I = 15 eta / (rho a^2) of each sphere.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrators/midpoint.h"
#include "engine/integrators/velocity_verlet.h"
#include "engine/kernels/pair_kinds.h"

namespace peclet::engine {
namespace {

constexpr double eta = 0.1, speed = 0.02, spin = 0.03;
const std::vector<double> radius = {1, 1.4}, density = {0.4, 0.05};

double rate_of(std::size_t i) { return 4.5 * eta / (density[i] * radius[i] * radius[i]); }
double spin_rate_of(std::size_t i) { return 15 * eta / (density[i] * radius[i] * radius[i]); }

// Returns two spheres out of range of each other.
System two_spheres() {
  System system;
  system.particles = make_particles(radius, density);
  system.box = PeriodicCell({40, 40, 40}, Matrix3{});
  for (std::size_t i = 0; i < 2; ++i) {
    system.particles.position.set(i, {10, 10 + 20 * static_cast<double>(i), 10});
    system.particles.velocity.set(i, {0, speed, 0});
    system.particles.angular_velocity.set(i, {0, 0, spin});
  }
  const Physics physics;
  system.list = NeighbourList(range_table(make_pair_kinds(physics, radius), 2), 0.1);
  return system;
}

Physics drag_alone() {
  Physics physics;
  physics.viscosity = eta;
  return physics;
}

TEST(UnequalDensities, MassAndMomentOfInertiaAreOfEachSphere) {
  const ParticleState particles = two_spheres().particles;
  EXPECT_NEAR(particles.mass[0], 0.4 * 4.18879020, 1e-8);
  EXPECT_NEAR(particles.mass[1], 0.05 * 4.18879020 * 2.744, 1e-8);
  EXPECT_NEAR(particles.inertia[1], 0.4 * 0.05 * 4.18879020 * 2.744 * 1.96, 1e-8);
}

TEST(UnequalDensities, ExplicitStepsRelaxAtTheRateOfEachSphere) {
  const Physics physics = drag_alone();
  System system = two_spheres();
  constexpr double step = 1e-4;
  constexpr int steps = 2000;
  VelocityVerlet integrator(ForceField(physics, system.particles, step, 1, 1), system.particles, step);
  integrator.start(system);
  for (int k = 0; k < steps; ++k) integrator.advance(system);
  for (std::size_t i = 0; i < 2; ++i) {
    // Drag acts on the velocities of half a step before. The first-order errors are lambda^2 dt t / 2
    // relative, and lambda dt of the first step.
    const auto expect_decay = [&](double left, double rate) {
      const double time = step * steps, exact = std::exp(-rate * time);
      EXPECT_NEAR(left, exact, (0.5 * rate * time + 1) * rate * step * exact) << i;
    };
    expect_decay(system.particles.velocity[i].y / speed, rate_of(i));
    expect_decay(system.particles.angular_velocity[i].z / spin, spin_rate_of(i));
  }
}

// Implicit steps solve m (V - V_n) = -dt zeta V.
TEST(UnequalDensities, ImplicitStepsRelaxAtTheRateOfEachSphere) {
  const Physics physics = drag_alone();
  System system = two_spheres();
  constexpr double step = 0.3, tight = 1e-6;
  Midpoint integrator(physics, system.particles, step, tight, 1, 1);
  integrator.start(system);
  for (int k = 0; k < 3; ++k) integrator.advance(system);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(system.particles.velocity[i].y / speed * std::pow(1 + rate_of(i) * step, 3), 1, 1e-4) << i;
    EXPECT_NEAR(system.particles.angular_velocity[i].z / spin * std::pow(1 + spin_rate_of(i) * step, 3), 1,
                1e-4)
        << i;
  }
}

}  // namespace
}  // namespace peclet::engine
