// Lubrication of the form mari, for single pairs. reference_forces_test.cpp compares whole packings with the
// independent evaluator.
#include "engine/terms/strained_lubrication.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/flow/background_flow.h"
#include "engine/kernels/pair_pass.h"
#include "tests/engine/pair_loads.h"

namespace peclet::engine {
namespace {

constexpr double fluid_eta = 0.1, regularisation = 1e-3;
constexpr auto mari = LubricationParameters::Form::mari;

LubricatedGap mari_gap(double sum_of_radii) {
  return lubricated_gap({.inner_gap = regularisation, .form = mari, .outer_distance = 0.2}, sum_of_radii);
}

PairResistance mari_resistance(double first, double second, const PairGeometry& pair) {
  return pair_resistance(resistance_constants(fluid_eta, first, second, mari), mari_gap(pair.sum_of_radii),
                         pair);
}

// Returns any velocity gradient without trace.
Matrix3 any_gradient(Draws& draws) {
  Matrix3 gradient = {draws.vector(), draws.vector(), draws.vector()};
  gradient.column[2].z = -gradient.column[0].x - gradient.column[1].y;
  return gradient;
}

FlowFrame frame_of(const Matrix3& gradient) {
  return {.varies = false, .spin = spin_of(gradient), .strain = strain_of(gradient)};
}

const PairVariationOf<double> nothing;

template <class Claim>
void for_every_near_pair(Claim&& claim) {
  Draws draws(41);
  for (const double ratio : size_ratios) {
    for (const double gap : {-0.01, 0.0, 5e-4, 1e-3, 0.01, 0.05, 0.1}) {
      const PairGeometry pair = pair_at(1, ratio, gap, draws.direction());
      claim(pair, ratio, mari_resistance(1, ratio, pair), draws);
    }
  }
}

// Expected: Monti et al. (2021) A.6 and A.7 for two equal spheres, at d = max(xi, 0) + eps.
TEST(StrainedLubrication, EqualSpheresHaveThePublishedCoefficients) {
  constexpr double a = 1.3;
  for (const double gap : {-0.02, 0.0, 0.02}) {
    const PairGeometry pair = pair_at(a, a, gap, {1, 0, 0});
    const PairResistance R = mari_resistance(a, a, pair);
    const double d = std::max(gap, 0.0) + regularisation, six = 6 * std::numbers::pi * fluid_eta;
    const double L = std::log(1 / d);
    EXPECT_NEAR(R.squeeze / (six * a / (4 * d)), 1, 1e-12) << gap;
    EXPECT_NEAR(R.shear / (six * a * L / 6), 1, 1e-12) << gap;
    EXPECT_NEAR(R.pump_first / (-six * a * a * L / 6), 1, 1e-12) << gap;
    EXPECT_NEAR(R.twist_first / (six * a * a * a * L * 4 / 15), 1, 1e-12) << gap;
    EXPECT_NEAR(R.twist_cross / (six * a * a * a * L / 15), 1, 1e-12) << gap;
  }
}

// Published X_G, Y_G and Y_H over their resistances: A.7, b = a_j / a_i, S = a_i + a_j.
TEST(StrainedLubrication, LengthsAreThePublishedRatios) {
  for (const double b : size_ratios) {
    const double a = 0.8, S = a * (1 + b), q = 1 / b;
    const double x_a = 2 * a * b * b / std::pow(1 + b, 3);
    const double y_a = 4 * a / 15 * b * (2 + b + 2 * b * b) / std::pow(1 + b, 3);
    const double y_b_ii = -2 * a * a / 15 * b * (4 + b) / std::pow(1 + b, 2);
    const double y_b_jj = 2 * a * a / 15 * b * b * (4 * b + 1) / std::pow(1 + b, 2);  // -b^2 Y_B_ii(1/b)
    const double x_g_ii = 2 * a * a * b * b / std::pow(1 + b, 3);
    const double x_g_ji = 2 * S * S * q * q / std::pow(1 + q, 5);
    const double y_g_ii = a * a / 15 * b * (4 - b + 7 * b * b) / std::pow(1 + b, 3);
    const double y_g_ji = S * S / 15 * q * (4 - q + 7 * q * q) / std::pow(1 + q, 5);
    const auto y_h_own = [&](double c) { return 2 * a * a * a / 15 * c * (2 - c) / std::pow(1 + c, 2); };
    const auto y_h_other = [&](double c) {
      return S * S * S / 15 * c * c * (1 + 7 * c) / std::pow(1 + c, 5);
    };
    const StrainLengths length = strain_lengths(a, a * b);
    EXPECT_NEAR(length.squeeze_first, x_g_ii / x_a, 1e-13);
    EXPECT_NEAR(length.squeeze_second, x_g_ji / x_a, 1e-12);
    EXPECT_NEAR(length.shear_first, 2 * y_g_ii / y_a, 1e-12);
    EXPECT_NEAR(length.shear_second, 2 * y_g_ji / y_a, 1e-12);
    EXPECT_NEAR(length.turn_first[0], -2 * y_h_own(b) / y_b_ii, 1e-12);
    EXPECT_NEAR(length.turn_first[1], -2 * y_h_other(q) / y_b_ii, 1e-12);
    // Y_B_ji = -Y_B_jj.
    EXPECT_NEAR(length.turn_second[0], 2 * y_h_other(b) / y_b_jj, 1e-12);
    EXPECT_NEAR(length.turn_second[1], 2 * std::pow(b, 3) * y_h_own(q) / y_b_jj, 1e-12);
  }
}

TEST(StrainedLubrication, ResistanceIsSymmetricPositiveSemidefiniteAndOfRankFive) {
  for_every_near_pair([](const PairGeometry& pair, double ratio, const PairResistance& resistance, Draws&) {
    SCOPED_TRACE(ratio);
    expect_rank_five(grand_resistance(resistance, pair));
  });
}

// The pair noise from theta and chi, column by column, satisfies B B' = R.
TEST(StrainedLubrication, NoiseIsARootOfTheResistance) {
  for_every_near_pair([](const PairGeometry& pair, double ratio, const PairResistance& resistance, Draws&) {
    const ResistanceConstants k = resistance_constants(fluid_eta, 1, ratio, mari);
    const ResistanceModes modes = resistance_modes(mari_gap(pair.sum_of_radii), pair.distance, pair);
    const ResistanceRoots roots = resistance_roots(root_constants(k), resistance.squeeze, modes);
    Eigen::Matrix<double, 12, 6> B;
    for (Eigen::Index c = 0; c < 6; ++c) {
      const Eigen::Vector<double, 6> unit = Eigen::Vector<double, 6>::Unit(c);
      B.col(c) = components(
          pair_noise_load(1.0, roots, pair, from_eigen(unit.head<3>()), from_eigen(unit.tail<3>())));
    }
    const Matrix12 R = grand_resistance(resistance, pair);
    EXPECT_LE(largest_entry(B * B.transpose() - R), 1e-13 * largest_entry(R)) << ratio;
  });
}

// In a rotating frame the flow and both spheres rotate with it.
TEST(StrainedLubrication, IsTheSameInEveryTurningFrame) {
  for_every_near_pair([](const PairGeometry& pair, double ratio, const PairResistance& R, Draws& draws) {
    const StrainLengths length = strain_lengths(1, ratio);
    FlowFrame flow = frame_of(any_gradient(draws));
    PairMotion motion = random_motion(draws);
    const PairLoad before = strained_lubrication_load(R, flow, length, pair, motion, nothing);
    const Vector3 turn = 3.0 * draws.direction();
    flow.spin += turn;
    motion.velocity += cross(turn, pair.separation);
    motion.spin_first += turn;
    motion.spin_second += turn;
    const PairLoad after = strained_lubrication_load(R, flow, length, pair, motion, nothing);
    EXPECT_LT(difference(before, after), 1e-12 * size_of_load(before));
  });
}

// A varying part of the flow with a uniform gradient acts as a uniform flow.
TEST(StrainedLubrication, OfAUniformGradientDoesNotAskHowItIsGiven) {
  for_every_near_pair([](const PairGeometry& pair, double ratio, const PairResistance& R, Draws& draws) {
    const StrainLengths length = strain_lengths(1, ratio);
    const Matrix3 part = any_gradient(draws), rest = any_gradient(draws);
    const PairMotion motion = random_motion(draws);
    FlowFrame flow = frame_of(part);
    flow.varies = true;
    const PairVariationOf<double> variation = {rest * pair.separation, spin_of(rest), spin_of(rest),
                                               strain_of(rest), strain_of(rest)};
    const PairLoad varying = strained_lubrication_load(R, flow, length, pair, motion, variation);
    const PairLoad uniform =
        strained_lubrication_load(R, frame_of(part + rest), length, pair, motion, nothing);
    EXPECT_LT(difference(varying, uniform), 1e-11 * size_of_load(uniform));
  });
}

// Seen from the other sphere, the normal, the relative velocity and the force change sign.
TEST(StrainedLubrication, ForcesAreEqualAndOppositeWhereStrainsDiffer) {
  Draws draws(42);
  for (const double ratio : size_ratios) {
    const Vector3 n = draws.direction();
    const PairGeometry here = pair_at(1, ratio, 0.01, n), there = pair_at(ratio, 1, 0.01, -n);
    const PairMotion motion = random_motion(draws);
    FlowFrame flow = frame_of(any_gradient(draws));
    flow.varies = true;
    const PairVariationOf<double> varying = {draws.vector(), draws.vector(), draws.vector(),
                                             strain_of(any_gradient(draws)), strain_of(any_gradient(draws))};
    const PairLoad first = strained_lubrication_load(mari_resistance(1, ratio, here), flow,
                                                     strain_lengths(1, ratio), here, motion, varying);
    const PairLoad second = strained_lubrication_load(
        mari_resistance(ratio, 1, there), flow, strain_lengths(ratio, 1), there, from_the_other(motion),
        PairVariationOf<double>{-varying.velocity, varying.spin_second, varying.spin_first,
                                varying.strain_second, varying.strain_first});
    SCOPED_TRACE(ratio);
    expect_opposite(first, second, 1e-12);
  }
}

// A pair carried by the flow resists its strain: where the flow separates the spheres, they attract.
TEST(StrainedLubrication, SpheresThatMoveWithTheFlowResistItsStrain) {
  const Matrix3 shear = simple_shear(0.7);
  for (const double side : {-1.0, 1.0}) {
    const PairGeometry pair = pair_at(1, 1.4, 0.01, {std::sqrt(0.5), side * std::sqrt(0.5), 0});
    const PairMotion carried = {shear * pair.separation, spin_of(shear), spin_of(shear)};
    const PairLoad load = strained_lubrication_load(mari_resistance(1, 1.4, pair), frame_of(shear),
                                                    strain_lengths(1, 1.4), pair, carried, nothing);
    EXPECT_GT(side * dot(load.force, pair.normal), 0);
    EXPECT_GT(symmetric_dyad(pair.separation, load.force).xy, 0);
  }
}

// The range is a surface distance, equal for all sizes.
TEST(StrainedLubrication, EndsAtTheOuterDistanceOfAllSizes) {
  Physics physics;
  physics.viscosity = fluid_eta;
  physics.lubrication =
      LubricationParameters{.inner_gap = regularisation, .form = mari, .outer_distance = 0.2};
  for (const auto& radii : {std::pair{1.0, 1.0}, {1.0, 1.4}, {5.0, 7.0}}) {
    const double first = radii.first, second = radii.second;
    const PairKind kind = make_pair_kind(physics, first, second);
    const auto force_at = [&](double h) {
      const PairGeometry pair = pair_at(first, second, 2 * h / (first + second), {1, 0, 0});
      PairSpringsOf<double> springs;
      return loads_of_terms<Terms{.lubrication = true, .strained = true}>(pair_parameters(physics, 0), kind,
                                                                          pair, {{1, 0, 0}, {}, {}}, springs)
          .lubrication.force.x;
    };
    const double b = second / first, d = 0.4 / (first + second) + regularisation;
    const double expected = 6 * std::numbers::pi * fluid_eta * first * 2 * b * b / std::pow(1 + b, 3) / d;
    EXPECT_NEAR(force_at(0.2 * (1 - 1e-9)) / expected, 1, 1e-7);
    EXPECT_EQ(force_at(0.2 * (1 + 1e-9)), 0);
    EXPECT_EQ(kind.range, first + second + 0.2);
  }
}

}  // namespace
}  // namespace peclet::engine
