#include "engine/terms/pair_resistance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>

#include "tests/engine/two_spheres.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

constexpr double fluid_viscosity = 0.1;
constexpr Vector3 along_x = {1, 0, 0};

PairResistance at_gap(double first, double second, double gap) {
  return resistance_of(fluid_viscosity, first, second, pair_at(first, second, gap, along_x));
}

// Li, Royer & Ness (2023): the squeeze mode of equal spheres at the inner gap, and the values of squeeze and
// shear at the cut-offs, in units of 6 pi eta a.
TEST(PairResistance, HasThePublishedMagnitudesForEqualSpheres) {
  const double unit = 6 * pi * fluid_viscosity;
  EXPECT_NEAR(at_gap(1, 1, 1e-3).squeeze / unit, 251.55, 0.005);
  EXPECT_NEAR(at_gap(1, 1, 0.05).squeeze / unit, 5.67, 0.005);
  EXPECT_NEAR(at_gap(1, 1, 0.05).shear / unit, 0.50, 0.005);
  EXPECT_NEAR(at_gap(1, 1, 0.5).squeeze / unit, 0.66, 0.005);
  EXPECT_NEAR(at_gap(1, 1, 0.5).shear / unit, 0.12, 0.005);
}

// Leading terms of two equal spheres in Jeffrey & Onishi (1984). X^A: 1/4, 9/40; Y^A: 1/6; Y^B: 1/4
// (of 4 pi eta a^2); Y^C: 1/5 and 1/20 (of 8 pi eta a^3). The levers q and q^2 are the program's own.
TEST(PairResistance, EqualSpheresHaveTheKnownLeadingTerms) {
  constexpr double a = 1.3, gap = 0.02;
  const double L = std::log(1 / gap), q = 1 + gap / 2, pi_eta = pi * fluid_viscosity;
  const PairResistance R = at_gap(a, a, gap);
  EXPECT_NEAR(R.squeeze / (6 * pi_eta * a), 1 / (4 * gap) + 9.0 / 40 * L, 1e-12);
  EXPECT_NEAR(R.shear / (6 * pi_eta * a), L / 6, 1e-13);
  EXPECT_NEAR(R.pump_first / (-4 * pi_eta * a * a), q * L / 4, 1e-13);
  EXPECT_NEAR(R.pump_second / (-4 * pi_eta * a * a), q * L / 4, 1e-13);
  EXPECT_NEAR(R.twist_first / (8 * pi_eta * a * a * a), q * q * L / 5, 1e-13);
  EXPECT_NEAR(R.twist_second / (8 * pi_eta * a * a * a), q * q * L / 5, 1e-13);
  EXPECT_NEAR(R.twist_cross / (8 * pi_eta * a * a * a), q * q * L / 20, 1e-13);
}

// A sphere approaching a wall at surface distance h feels 6 pi eta a^2 U / h (Taylor); two equal spheres feel
// 3/2 pi eta a^2 U / h.
TEST(PairResistance, SqueezeHasTheClassicalLimits) {
  constexpr double wall = 1e6, h = 2e-3, wall_gap = 2 * h / (1 + wall);
  const double at_wall = resistance_constants(fluid_viscosity, 1, wall).squeeze_inverse / wall_gap;
  EXPECT_NEAR(at_wall / (6 * pi * fluid_viscosity / h), 1, 1e-5);
  const double at_sphere = resistance_constants(fluid_viscosity, 1, 1).squeeze_inverse / h;
  EXPECT_NEAR(at_sphere / (1.5 * pi * fluid_viscosity / h), 1, 1e-12);
}

TEST(PairResistance, ExchangingTheSpheresExchangesTheirModes) {
  for (const double ratio : size_ratios) {
    const PairResistance one = at_gap(1.2, 1.2 * ratio, 0.03), other = at_gap(1.2 * ratio, 1.2, 0.03);
    EXPECT_NEAR(one.squeeze / other.squeeze, 1, 1e-13);
    EXPECT_NEAR(one.shear / other.shear, 1, 1e-13);
    EXPECT_NEAR(one.pump_first / other.pump_second, 1, 1e-13);
    EXPECT_NEAR(one.pump_second / other.pump_first, 1, 1e-13);
    EXPECT_NEAR(one.twist_first / other.twist_second, 1, 1e-13);
    EXPECT_NEAR(one.twist_cross / other.twist_cross, 1, 1e-13);
  }
}

// Below the inner gap and in overlap the coefficients are constant; the lever q = r / (a_i + a_j) is not.
TEST(PairResistance, StaysConstantBelowTheInnerGapButForTheLever) {
  const PairResistance edge = at_gap(1, 1.4, inner_gap);
  for (const double gap : {5e-4, 0.0, -0.02}) {
    const PairResistance R = at_gap(1, 1.4, gap);
    const double lever = (1 + gap / 2) / (1 + inner_gap / 2);
    EXPECT_NEAR(R.squeeze / edge.squeeze, 1, 1e-10);
    EXPECT_NEAR(R.shear / edge.shear, 1, 1e-10);
    EXPECT_NEAR(R.pump_first / edge.pump_first, lever, 1e-10);
    EXPECT_NEAR(R.twist_cross / edge.twist_cross, lever * lever, 1e-10);
  }
}

TEST(PairResistance, FallsWithTheGapBeyondTheInnerOne) {
  double squeeze = std::numeric_limits<double>::infinity(), shear = squeeze;
  for (const double gap : {1.001e-3, 0.01, 0.05, 0.2, 0.5}) {
    const PairResistance R = at_gap(1, 3, gap);
    EXPECT_LT(R.squeeze, squeeze);
    EXPECT_LT(R.shear, shear);
    squeeze = R.squeeze, shear = R.shear;
  }
}

// Six rigid motions of the pair and the shared spin about its axis dissipate nothing. Of twelve modes
// squeezing, two of shearing and two of twisting remain.
TEST(PairResistance, IsSymmetricPositiveSemidefiniteAndOfRankFive) {
  Draws draws(21);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const PairGeometry pair = pair_at(1, ratio, gap, draws.direction());
      const Matrix12 R = grand_resistance(resistance_of(fluid_viscosity, 1, ratio, pair), pair);
      const double scale = largest_entry(R);
      EXPECT_LE(largest_entry(R - R.transpose()), 1e-14 * scale);
      const Vector12 eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix12>(R).eigenvalues();
      EXPECT_GT(eigenvalues[0], -1e-14 * scale) << ratio << ' ' << gap;
      EXPECT_LT(eigenvalues[6], 1e-14 * scale) << ratio << ' ' << gap;
      EXPECT_GT(eigenvalues[7], 1e-6 * scale) << ratio << ' ' << gap;
    }
  }
}

}  // namespace
}  // namespace peclet::engine
