#include "engine/terms/lubrication.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/pair_loads.h"

namespace peclet::engine {
namespace {

constexpr double viscosity = 0.1;

template <class Claim>
void for_every_pair(Claim&& claim) {
  Draws draws(31);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const PairGeometry pair = pair_at(1, ratio, gap, draws.direction());
      claim(pair, resistance_of(viscosity, 1, ratio, pair), draws);
    }
  }
}

TEST(Lubrication, RigidMotionOfThePairFeelsNothing) {
  for_every_pair([](const PairGeometry& pair, const PairResistance& R, Draws& draws) {
    const Vector3 spin = draws.direction();
    const PairLoad rigid = lubrication_load(R, pair, {cross(spin, pair.separation), spin, spin});
    const PairLoad sliding = lubrication_load(R, pair, {cross(spin, pair.separation), {}, {}});
    EXPECT_LT(size_of_load(rigid), 1e-13 * size_of_load(sliding));
  });
}

// T_i + T_j = r x F_i: there is no net torque on the pair.
TEST(Lubrication, TorquesOfThePairBalance) {
  for_every_pair([](const PairGeometry& pair, const PairResistance& R, Draws& draws) {
    const PairLoad load = lubrication_load(R, pair, random_motion(draws));
    const Vector3 net = load.torque_first + load.torque_second - cross(pair.separation, load.force);
    EXPECT_LT(norm(net), 1e-12 * size_of_load(load));
  });
}

TEST(Lubrication, DissipatesEveryMotion) {
  for_every_pair([](const PairGeometry& pair, const PairResistance& R, Draws& draws) {
    for (int trial = 0; trial < 20; ++trial) {
      const PairMotion motion = random_motion(draws);
      EXPECT_GT(dissipated(lubrication_load(R, pair, motion), motion), 0);
    }
  });
}

// Seen from the other sphere, the normal, the relative velocity and the force change sign.
TEST(Lubrication, ForcesAreEqualAndOppositeForUnequalRadii) {
  Draws draws(32);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const Vector3 n = draws.direction();
      const PairGeometry here = pair_at(1, ratio, gap, n), there = pair_at(ratio, 1, gap, -n);
      const PairMotion motion = random_motion(draws);
      const PairLoad first = lubrication_load(resistance_of(viscosity, 1, ratio, here), here, motion);
      const PairLoad second =
          lubrication_load(resistance_of(viscosity, ratio, 1, there), there, from_the_other(motion));
      expect_opposite(first, second, 1e-13);
    }
  }
}

// Maps x to z, y to x and z to y.
Vector3 turned(const Vector3& v) { return {v.y, v.z, v.x}; }

TEST(Lubrication, TurnsWithTheFrame) {
  for_every_pair([](const PairGeometry& pair, const PairResistance& R, Draws& draws) {
    const PairMotion motion = random_motion(draws);
    const PairLoad load = lubrication_load(R, pair, motion);
    const PairGeometry turned_pair = {turned(pair.separation), turned(pair.normal), pair.distance,
                                      pair.sum_of_radii};
    const PairLoad after = lubrication_load(
        R, turned_pair, {turned(motion.velocity), turned(motion.spin_first), turned(motion.spin_second)});
    const PairLoad expected = {turned(load.force), turned(load.torque_first), turned(load.torque_second)};
    EXPECT_LT(difference(after, expected), 1e-13 * size_of_load(load));
  });
}

TEST(Lubrication, ResistsApproachAndSeparationAlike) {
  const PairGeometry pair = pair_at(1, 1, 0.01, {0, 1, 0});
  const PairResistance R = resistance_of(viscosity, 1, 1, pair);
  EXPECT_LT(lubrication_load(R, pair, {{0, -1, 0}, {}, {}}).force.y, 0);  // j approaches: i is pushed away
  EXPECT_GT(lubrication_load(R, pair, {{0, 1, 0}, {}, {}}).force.y, 0);   // j recedes: i is drawn along
}

// Shear carries two spheres towards each other in the quadrant n_x n_y < 0.
TEST(Lubrication, ApproachInTheCompressiveQuadrantGivesPositiveShearStress) {
  constexpr double rate = 0.7;
  const Vector3 n = {std::sqrt(0.5), -std::sqrt(0.5), 0};
  const PairGeometry pair = pair_at(1, 1.4, 0.01, n);
  const Vector3 spin = {0, 0, -0.5 * rate};
  const PairLoad load = lubrication_load(resistance_of(viscosity, 1, 1.4, pair), pair,
                                         {{rate * pair.separation.y, 0, 0}, spin, spin});
  EXPECT_GT(symmetric_dyad(pair.separation, load.force).xy, 0);
}

// The published model cuts lubrication off without an offset. From 5.67 and 0.50 (outer gap 0.05), or 0.66
// and 0.12 (0.5), it drops to zero; units of 6 pi eta a.
TEST(Lubrication, EndsWithTheKnownJumpsAtTheOuterGap) {
  const struct { double outer_gap, squeeze, shear; } published[] = {{0.05, 5.67, 0.50}, {0.5, 0.66, 0.12}};
  for (const auto& each : published) {
    Physics physics;
    physics.viscosity = viscosity;
    physics.lubrication = LubricationParameters{.inner_gap = 1e-3, .outer_gap = each.outer_gap};
    const PairKind kind = make_pair_kinds(physics, {1.0}).front();
    const auto force_at = [&](double gap, const Vector3& velocity) {
      const PairGeometry pair = pair_at(1, 1, gap, {1, 0, 0});
      PairSpringsOf<double> springs;
      const auto loads = loads_of_terms<Terms{.lubrication = true}>(pair_parameters(physics, 0), kind, pair,
                                                                    {velocity, {}, {}}, springs);
      return (1 / (6 * std::numbers::pi * viscosity)) * loads.lubrication.force;
    };
    const double inside = each.outer_gap * (1 - 1e-9), outside = each.outer_gap * (1 + 1e-9);
    EXPECT_NEAR(force_at(inside, {1, 0, 0}).x, each.squeeze, 0.005);
    EXPECT_NEAR(force_at(inside, {0, 1, 0}).y, each.shear, 0.005);
    EXPECT_EQ(norm(force_at(outside, {1, 1, 1})), 0);
  }
}

}  // namespace
}  // namespace peclet::engine
