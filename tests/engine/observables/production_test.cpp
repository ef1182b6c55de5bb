// Blocks of the production window and their samples.
#include "engine/observables/production.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/engine/dense_suspension.h"

namespace peclet::engine {
namespace {

TEST(Production, EveryStepGoesIntoExactlyOneOfEvenBlocks) {
  for (const std::uint64_t steps : {32U, 33U, 63U, 1000U, 12345U}) {
    Production production(steps);
    for (std::uint64_t index = 0; index < steps; ++index) {
      PairSums sums;
      sums.contacts = static_cast<double>(index);
      production.add_step(index, sums, {}, 0);
    }
    std::uint64_t all = 0;
    double contacts = 0;
    for (const BlockSums& block : production.blocks()) {
      EXPECT_GE(block.steps, steps / 32);
      EXPECT_LE(block.steps, steps / 32 + 1);
      EXPECT_EQ(block.steps, block.planned);
      all += block.steps;
      contacts += block.contacts;
    }
    EXPECT_EQ(all, steps);
    EXPECT_EQ(contacts, 0.5 * static_cast<double>(steps) * static_cast<double>(steps - 1));
  }
}

TEST(StatisticalInefficiency, IsOneWithoutCorrelation) {
  EXPECT_EQ(statistical_inefficiency(std::vector<double>(32, 4.2)), 1);
  std::vector<double> alternating(32, 1.0);
  for (std::size_t k = 1; k < 32; k += 2) alternating[k] = -1;
  EXPECT_EQ(statistical_inefficiency(alternating), 1);
}

// 1, 1, -1, -1, ...: at lag one 16 of the 31 products are +1 and 15 are -1, over 32; at lag two all are -1.
TEST(StatisticalInefficiency, SumsTheCorrelationUpToItsFirstZero) {
  std::vector<double> series(32, 1.0);
  for (std::size_t k = 0; k < 32; ++k) series[k] = k % 4 < 2 ? 1 : -1;
  EXPECT_NEAR(statistical_inefficiency(series), 1 + 2.0 / 32, 1e-14);
}

// The mean of a long AR(1) series has (1 + phi) / (1 - phi) times the variance for independent values. With
// 2^16 values the standard deviation of the estimate is below 0.1 of 3; five occur once in a million seeds.
TEST(StatisticalInefficiency, OfAnAutoregressiveSeriesIsItsFormula) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  for (const double phi : {0.0, 0.3, 0.5}) {
    std::vector<double> series(1 << 16);
    double value = normal(generator) / std::sqrt(1 - phi * phi);
    for (double& entry : series) entry = value = phi * value + normal(generator);
    EXPECT_NEAR(statistical_inefficiency(series), (1 + phi) / (1 - phi), 0.5 / 3 * (1 + phi) / (1 - phi))
        << phi;
  }
}

TEST(BlockedMean, OfOneNumberHas32BlocksOfAListFourAndOfALongOneNone) {
  BlockedMean scalar, list({64}), large({65}), single({1});
  for (std::size_t block = 0; block < 32; ++block) {
    const auto value = static_cast<double>(block);
    scalar.add(block, 0, 2 * value);
    scalar.weigh(block, 2);
    for (const auto& [mean, entry] : {std::pair(&list, 63U), {&large, 64U}, {&single, 0U}}) {
      mean->add(block, entry, value);
      mean->weigh(block, 1);
    }
  }
  EXPECT_EQ(scalar.value(), 15.5);
  EXPECT_EQ(list.value()[63], 15.5);
  EXPECT_EQ(large.value()[64], 15.5);
  ASSERT_EQ(scalar.blocks().size(), 32u);
  EXPECT_EQ(scalar.blocks()[7], 7);
  ASSERT_EQ(list.blocks().size(), 4u);
  EXPECT_EQ(list.blocks()[1][63], (8 + 15) / 2.0);
  EXPECT_EQ(list.blocks()[1][0], 0);
  EXPECT_TRUE(large.blocks().is_null());
  EXPECT_EQ(single.value(), Json::array({15.5}));
  EXPECT_EQ(single.blocks().size(), 4u);
}

TEST(BlockedMean, OfNothingIsNull) {
  BlockedMean mean({2});
  EXPECT_TRUE(mean.value().is_null());
  mean.weigh(31, 1);
  EXPECT_EQ(mean.value(), Json({0.0, 0.0}));
  EXPECT_EQ(mean.blocks(), Json({nullptr, nullptr, nullptr, {0.0, 0.0}}));
}

// Two spheres of radii 1 and 1.4 at surface distance h along x; the shells are 0.05 and 0.07 thick.
SymmetricTensor structural_stress_at(double h, double skin = 0.1) {
  Physics physics = physics_with({.contact = true});
  physics.thermal_energy = 0.3;
  System system;
  system.particles = make_particles({1, 1.4}, 0.1);
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, {5 + 2.4 + h, 5, 5});
  system.box = PeriodicCell({10, 10, 10}, Matrix3{});
  const std::vector<PairKind> kinds = make_pair_kinds(physics, {1, 1.4});
  system.list = NeighbourList(range_table(kinds, 2), skin);
  system.list.build(system.particles, system.box);
  return structural_brownian_stress(system, kinds, physics.thermal_energy);
}

// -(kT / V) (a / Delta) n n from each side whose shell contains the other's surface, a / Delta = 20.
TEST(StructuralBrownianStress, CountsEachSideOfAPairWithinItsOwnShell) {
  EXPECT_NEAR(structural_stress_at(-0.01).xx, -0.3 / 1000 * 20 * 2, 1e-15);
  EXPECT_NEAR(structural_stress_at(0.04).xx, -0.3 / 1000 * 20 * 2, 1e-15);
  EXPECT_NEAR(structural_stress_at(0.06).xx, -0.3 / 1000 * 20, 1e-15);  // in the larger sphere's shell alone
  EXPECT_EQ(structural_stress_at(0.08).xx, 0);
  EXPECT_EQ(structural_stress_at(0.04).yy, 0);
}

// The list includes the range of the shells, which exceeds that of the forces.
TEST(StructuralBrownianStress, SeesTheWholeShellOfTheLargerSphere) {
  EXPECT_NEAR(structural_stress_at(0.069, /*skin=*/0).xx, -0.3 / 1000 * 20, 1e-15);
}

TEST(KineticTemperatures, AreThoseOfMotionRelativeToTheStreamingFlow) {
  System system;
  system.particles = make_particles({1, 1.4}, 0.1);
  system.box = PeriodicCell({10, 10, 10}, simple_shear(0.7));
  system.particles.position.set(1, {0, 3, 0});
  system.particles.velocity.set(0, {1, 2, 2});        // squared: 9
  system.particles.velocity.set(1, {0.7 * 3, 0, 0});  // at rest in the flow
  system.particles.angular_velocity.set(0, {0, 0, -0.35});
  system.particles.angular_velocity.set(1, {0, 3, 4 - 0.35});  // squared: 25
  const double m0 = 0.1 * 4 * std::numbers::pi / 3, m1 = m0 * 1.4 * 1.4 * 1.4;
  const KineticTemperatures t = kinetic_temperatures(system, steady_shear(0.7));
  EXPECT_NEAR(t.translational, m0 * 9 / 6, 1e-14);
  EXPECT_NEAR(t.rotational, 0.4 * m1 * 1.96 * 25 / 6, 1e-14);
}

}  // namespace
}  // namespace peclet::engine
