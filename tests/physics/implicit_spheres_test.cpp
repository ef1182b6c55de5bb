// Single spheres under implicit steps. Velocities decay by r = 1 / (1 + x) a step, x = zeta dt / m, and noise
// gives them the variance (kT / m) / (1 + x / 2). Displacements are dt V, so that
//   <x_n^2> = (kT / m) dt^2 / (1 + x / 2) [n + 2 sum over k < n of (n - k) r^k].
// The slope is 2 (kT / zeta) dt, that of diffusion, at any step.
//
// False failures with fresh seeds: 3 N independent numbers give a variance with relative error
// sqrt(2 / (3 N)). Five of these errors are passed with probability 6e-7, in 9 comparisons.
#include <gtest/gtest.h>

#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

class ImplicitSpheres : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepsOverDecayTimes, ImplicitSpheres, testing::Values(0.1, 1.0, 10.0),
                         [](const auto& it) {
                           return "Tenths" + std::to_string(std::lround(10 * it.param));
                         });

TEST_P(ImplicitSpheres, DiffuseAsTheNoiseSays) {
  constexpr std::size_t count = 4000;
  constexpr double thermal_energy = 0.01;
  const double x = GetParam();
  // m = zeta = 1
  Laboratory laboratory =
      single_spheres(count, thermal_energy, /*timestep=*/x, /*skin=*/8, /*solver_tolerance=*/1e-3);
  const ParticleState& all = laboratory.system().particles;
  const auto steps = static_cast<int>(std::ceil(20 / x));
  for (int k = 0; k < steps; ++k) laboratory.step();

  const std::vector<Vector3> origin = unwrapped_places(laboratory);
  double velocities = 0, spins = 0;
  for (int k = 0; k < steps; ++k) laboratory.step();
  for (std::size_t i = 0; i < count; ++i) {
    velocities += dot(all.velocity[i], all.velocity[i]) / (3 * count);
    spins += all.inertia[i] * dot(all.angular_velocity[i], all.angular_velocity[i]) / (3 * count);
  }
  const std::vector<Vector3> now = unwrapped_places(laboratory);
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    squares += dot(now[i] - origin[i], now[i] - origin[i]) / (3 * count);
  }
  const double r = 1 / (1 + x), n = steps;
  double sum = n;
  for (int k = 1; k < steps; ++k) sum += 2 * (n - k) * std::pow(r, k);
  const double variance = thermal_energy / (1 + x / 2);
  const double error = 5 * std::sqrt(2.0 / (3 * count));
  EXPECT_NEAR(velocities / variance, 1, error);
  EXPECT_NEAR(spins * (1 + natural_spin_rate * x / 2) / thermal_energy, 1, error);
  EXPECT_NEAR(squares / (variance * x * x * sum), 1, error);
}

}  // namespace
}  // namespace peclet::engine
