// The place of the steepest rise.
#include "runner/jamming/steepest.h"

#include <gtest/gtest.h>

#include <cmath>

namespace peclet::runner {
namespace {

// A smooth step of height 100 at `middle`, and a fixed error.
std::vector<LawPoint> step(double middle, double spacing, double error) {
  std::vector<LawPoint> points;
  for (int i = 0; i <= 20; ++i) {
    const double phi = 0.5 + spacing * i;
    points.push_back({phi, 20 + 50 * (1 + std::tanh((phi - middle) / 0.004)), error, 8});
  }
  return points;
}

TEST(JammingSteepest, IsTheMiddleOfTheStepWithTheErrorOfTheGrid) {
  const SteepestAnswer answer = find_steepest(step(0.5275, 0.005, 0.01), std::nullopt);
  ASSERT_TRUE(answer.steepest) << answer.obstacle;
  EXPECT_NEAR(answer.steepest->fraction.value, 0.5275, 1e-12);
  EXPECT_NEAR(answer.steepest->width, 0.005, 1e-12);
  EXPECT_NEAR(answer.steepest->fraction.standard_error, 0.005 / std::sqrt(12.0), 1e-9);
  EXPECT_FALSE(answer.steepest->to_jammed);
}

// Half-way between two intervals both have the same slope, and a draw is in the other one half of the time:
// the mean square is spacing^2 / 2, give or take five times its own error, sqrt(0.25 / 2000).
TEST(JammingSteepest, ErrorsOfTheValuesMakeItWider) {
  const SteepestAnswer answer = find_steepest(step(0.53, 0.005, 2), std::nullopt);
  ASSERT_TRUE(answer.steepest);
  const double squares = std::pow(answer.steepest->fraction.standard_error / 0.005, 2) - 1.0 / 12;
  EXPECT_NEAR(squares, 0.5, 5 * std::sqrt(0.25 / 2000));
  const SteepestAnswer again = find_steepest(step(0.53, 0.005, 2), std::nullopt);
  EXPECT_EQ(again.steepest->fraction.standard_error, answer.steepest->fraction.standard_error);
}

TEST(JammingSteepest, ARiseUpToTheLastPointIsBoundedByWhatIsJammed) {
  std::vector<LawPoint> points;
  for (const double phi : {0.5, 0.55, 0.6}) points.push_back({phi, std::pow(1 - phi / 0.64, -2), 0.1, 8});
  const SteepestAnswer open = find_steepest(points, std::nullopt);
  EXPECT_FALSE(open.steepest);
  EXPECT_EQ(open.obstacle, "the viscosity rises most steeply up to the last point");
  const SteepestAnswer bracket = find_steepest(points, 0.66);
  ASSERT_TRUE(bracket.steepest);
  EXPECT_TRUE(bracket.steepest->to_jammed);
  EXPECT_NEAR(bracket.steepest->fraction.value, 0.63, 1e-12);
  EXPECT_NEAR(bracket.steepest->fraction.standard_error, 0.06 / std::sqrt(12.0), 1e-12);
  EXPECT_EQ(find_steepest({points[0], points[1]}, 0.66).obstacle, "2 of the 3 points that it needs");
}

}  // namespace
}  // namespace peclet::runner
