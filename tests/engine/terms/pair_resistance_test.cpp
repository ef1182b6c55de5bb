// The resistance of a pair; and fluctuation-dissipation exactly: B B^T = R, with B the loads of unit random
// vectors.
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
      SCOPED_TRACE(testing::Message() << ratio << ' ' << gap);
      expect_rank_five(grand_resistance(resistance_of(fluid_viscosity, 1, ratio, pair), pair));
    }
  }
}

constexpr double eta = 0.1;

using NoiseLoad = PairLoad (*)(double, const ResistanceRoots&, const PairGeometry&, const Vector3&,
                               const Vector3&);

// Returns the covariance of (F_i, F_j, T_i, T_j) for theta and chi with independent unit components.
Matrix12 covariance(NoiseLoad noise, double amplitude, const ResistanceRoots& root,
                    const PairGeometry& pair) {
  Eigen::Matrix<double, 12, 6> loads;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 unit = from_eigen(Eigen::Vector3d::Unit(k));
    loads.col(k) = components(noise(amplitude, root, pair, unit, {}));
    loads.col(3 + k) = components(noise(amplitude, root, pair, {}, unit));
  }
  return loads * loads.transpose();
}

// Returns the noise of eq. 24 as printed, with a plus before the second torque's root.
PairLoad wrong_sign(double amplitude, const ResistanceRoots& root, const PairGeometry& pair,
                    const Vector3& theta, const Vector3& chi) {
  PairLoad load = pair_noise_load(amplitude, root, pair, theta, chi);
  const PairLoad without_chi = pair_noise_load(amplitude, root, pair, theta, {});
  load.torque_second = without_chi.torque_second - (load.torque_second - without_chi.torque_second);
  return load;
}

TEST(PairNoise, CovarianceIsTheResistanceForUnequalSizes) {
  Draws draws(41);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const PairGeometry pair = pair_at(1.3, 1.3 * ratio, gap, draws.direction());
      const PairResistance R = resistance_of(eta, 1.3, 1.3 * ratio, pair);
      const Matrix12 expected = grand_resistance(R, pair);
      const ResistanceRoots root = roots_of(eta, 1.3, 1.3 * ratio, pair);
      EXPECT_LT(largest_entry(covariance(pair_noise_load, 1, root, pair) - expected),
                1e-13 * largest_entry(expected))
          << ratio << ' ' << gap;
    }
  }
}

// The block of torques by itself, since squeezing would hide it in the comparison above. The wrong sign makes
// Y_C12 too large by 4.0, 3.9, 2.3 and 2.0 at size ratios 1, 1.4, 5 and 7, by the published formulas.
TEST(PairNoise, TheWrongSignInTheSecondTorqueIsFarFromTheResistance) {
  const struct { double ratio, too_large_by; } known[] = {{1, 4.0}, {1.4, 3.9}, {5, 2.3}, {7, 2.0}};
  for (const auto& each : known) {
    for (const double gap : {1e-3, 0.05, 0.5}) {
      const PairGeometry pair = pair_at(1, each.ratio, gap, {1, 0, 0});
      const PairResistance R = resistance_of(eta, 1, each.ratio, pair);
      const ResistanceRoots root = roots_of(eta, 1, each.ratio, pair);
      const Eigen::Index first = 7, second = 10;  // y components of both torques
      EXPECT_NEAR(covariance(pair_noise_load, 1, root, pair)(first, second) / R.twist_cross, 1, 1e-12);
      EXPECT_NEAR(covariance(wrong_sign, 1, root, pair)(first, second) / R.twist_cross, each.too_large_by,
                  0.06);
    }
  }
}

TEST(PairNoise, GrowsWithTheAmplitude) {
  const PairGeometry pair = pair_at(1, 1.4, 0.01, {0, 0, 1});
  const ResistanceRoots root = roots_of(eta, 1, 1.4, pair);
  const PairLoad one = pair_noise_load(1, root, pair, {1, 2, 3}, {4, 5, 6});
  const PairLoad three = pair_noise_load(3, root, pair, {1, 2, 3}, {4, 5, 6});
  EXPECT_NEAR(norm(three.force - 3 * one.force), 0, 1e-13 * norm(three.force));
  EXPECT_NEAR(norm(three.torque_second - 3 * one.torque_second), 0, 1e-13 * norm(three.torque_second));
}

TEST(PairNoise, TorquesOfThePairBalance) {
  Draws draws(42);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const PairGeometry pair = pair_at(1, ratio, gap, draws.direction());
      const PairLoad load =
          pair_noise_load(2, roots_of(eta, 1, ratio, pair), pair, draws.vector(), draws.vector());
      const Vector3 net = load.torque_first + load.torque_second - cross(pair.separation, load.force);
      EXPECT_LT(norm(net), 1e-12 * (norm(load.torque_first) + norm(load.torque_second) + norm(load.force)));
    }
  }
}

}  // namespace
}  // namespace peclet::engine
