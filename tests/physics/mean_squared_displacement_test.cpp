// Single spheres with thermal velocities spread along each axis as (eq. 31 of Li, Royer & Ness 2023)
//   <x^2> = (2 kT m / zeta^2)(zeta t / m - 1 + exp(-zeta t / m)).
//
// False failures with fresh seeds: 3 N independent displacements give a variance with relative error
// sqrt(2 / (3 N)), normal to good accuracy. Five errors are passed with probability 6e-7, in 17 comparisons.
#include <gtest/gtest.h>

#include "tests/physics/estimates.h"
#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

constexpr double largest_deviation = 5;

// Returns the mean squared displacement along one axis.
double mean_square(const Laboratory& laboratory, const std::vector<Vector3>& origin) {
  const std::vector<Vector3> now = unwrapped_places(laboratory);
  double sum = 0;
  for (std::size_t i = 0; i < origin.size(); ++i) {
    const Vector3 way = now[i] - origin[i];
    sum += dot(way, way);
  }
  return sum / (3 * static_cast<double>(origin.size()));
}

// Returns <x^2> in natural units (m = zeta = 1).
double expected_mean_square(double thermal_energy, double time) {
  return 2 * thermal_energy * (time - 1 + std::exp(-time));
}

void expect_spreading(std::size_t count, double thermal_energy, double timestep, double skin,
                      const std::vector<double>& times) {
  Laboratory laboratory = single_spheres(count, thermal_energy, timestep, skin);
  const std::vector<Vector3> origin = unwrapped_places(laboratory);
  const double relative_error = std::sqrt(2 / (3 * static_cast<double>(count)));
  std::uint64_t step = 0;
  for (const double time : times) {
    for (const auto last = static_cast<std::uint64_t>(std::llround(time / timestep)); step < last; ++step) {
      laboratory.step();
    }
    const double ratio = mean_square(laboratory, origin) /
                         expected_mean_square(thermal_energy, timestep * static_cast<double>(step));
    EXPECT_NEAR(ratio, 1, largest_deviation * relative_error) << "at " << time << " decay times";
  }
}

// The step biases the first of these times by zeta dt / m = 1e-3 of it, a ninth of the error bar.
TEST(MeanSquaredDisplacement, IsBallisticBeforeTheVelocityDecays) {
  expect_spreading(/*count=*/8000, /*thermal_energy=*/0.5, /*timestep=*/1e-3, /*skin=*/8,
                   {0.03, 0.1, 0.2, 0.5});
}

TEST(MeanSquaredDisplacement, CrossesOverToDiffusion) {
  expect_spreading(/*count=*/8000, /*thermal_energy=*/0.5, /*timestep=*/5e-3, /*skin=*/8, {1, 2, 4, 8, 16});
}

// The last displacements, 400 along each axis, exceed the cell edge of 232, so image counters are tested.
TEST(MeanSquaredDisplacement, IsDiffusiveAcrossCells) {
  expect_spreading(/*count=*/1500, /*thermal_energy=*/200, /*timestep=*/2e-2, /*skin=*/30,
                   {20, 50, 100, 200, 400});
}

// The position after n steps is a sum of half-step velocities, whose covariance decays as
// (1 - zeta dt / m)^n. In the steady state the sum is exactly, with x = zeta dt / m and r = 1 - x,
//   (2 kT m / zeta^2)[n x - (1 - x)(1 - r^n) / (1 - x / 2)].
// The slope is the exact one at any stable step. Rotations, not measured here, diverge beyond x = 0.6.
class LargeSteps : public testing::TestWithParam<double> {};

TEST_P(LargeSteps, LeaveTheDiffusionCoefficientAlone) {
  const std::size_t count = 1500;
  const double thermal_energy = 0.1, x = GetParam();
  Laboratory laboratory = single_spheres(count, thermal_energy, x, /*skin=*/8);
  for (int step = 0; step < 20 / x; ++step) laboratory.step();
  std::vector<double> ratios;  // consecutive, independent windows over the formula
  const auto window = static_cast<int>(20 / x);
  const double expected =
      2 * thermal_energy * (window * x - (1 - x) * (1 - std::pow(1 - x, window)) / (1 - 0.5 * x));
  for (int k = 0; k < 40; ++k) {
    const std::vector<Vector3> origin = unwrapped_places(laboratory);
    for (int step = 0; step < window; ++step) laboratory.step();
    ratios.push_back(mean_square(laboratory, origin) / expected);
  }
  // Windows of twenty decay times are nearly independent: the variance has 3 N * 40 independent terms.
  const double error = std::sqrt(2 / (3.0 * count * static_cast<double>(ratios.size())));
  EXPECT_NEAR(estimate(ratios).mean, 1, largest_deviation * error);
}

INSTANTIATE_TEST_SUITE_P(TenthToNineTenthsOfTheLimit, LargeSteps, testing::Values(0.06, 0.3, 0.54),
                         [](const auto& it) {
                           return "Hundredths" + std::to_string(std::lround(100 * it.param));
                         });

}  // namespace
}  // namespace peclet::engine
