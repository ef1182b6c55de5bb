// Fluctuation-dissipation for a pair, exactly: B B^T = R, with B the loads of unit random vectors.
#include <gtest/gtest.h>

#include "engine/terms/pair_resistance.h"
#include "tests/engine/two_spheres.h"

namespace peclet::engine {
namespace {

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
