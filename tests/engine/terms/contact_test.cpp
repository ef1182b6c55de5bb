#include "engine/terms/contact.h"

#include <gtest/gtest.h>

#include "engine/terms/conservative.h"
#include "tests/engine/two_spheres.h"

namespace peclet::engine {
namespace {

// Returns dE/dr by central differences: the force on i along n, opposite to that on j.
template <class Energy>
double slope(Energy&& energy, double r) {
  const double step = 1e-6;
  return (energy(r + step) - energy(r - step)) / (2 * step);
}

TEST(Contact, ForceIsTheGradientOfTheElasticEnergy) {
  constexpr double stiffness = 1e4, sum = 2.4;
  Draws draws(51);
  const auto energy = [&](double r) { return 0.5 * stiffness * (sum - r) * (sum - r); };
  for (const double gap : {-0.05, -0.01, -1e-4}) {
    const PairGeometry pair = pair_at(1, 1.4, gap, draws.direction());
    const Vector3 force = contact_normal_force(stiffness, pair);
    EXPECT_NEAR(dot(force, pair.normal), slope(energy, pair.distance), 1e-6 * norm(force));
    EXPECT_NEAR(norm(across(force, pair.normal)), 0, 1e-12 * norm(force));
    EXPECT_LT(dot(force, pair.normal), 0);  // i is pushed away from j
    EXPECT_NEAR(contact_energy(stiffness, pair.overlap()), energy(pair.distance),
                1e-9 * energy(pair.distance));
  }
  EXPECT_EQ(contact_energy(stiffness, -0.01), 0);
}

TEST(Contact, DampingOpposesTheNormalVelocityAlone) {
  const PairGeometry pair = pair_at(1, 1.4, -0.01, {0, 1, 0});
  const Vector3 approach = contact_damping_force(2, pair, {{5, -3, 7}, {}, {}});
  EXPECT_EQ(approach.x, 0);
  EXPECT_EQ(approach.y, -6);
  EXPECT_EQ(approach.z, 0);
  const PairMotion motion = {{5, -3, 7}, {}, {}};
  EXPECT_GT(dissipated({approach, {}, {}}, motion), 0);
}

TEST(Repulsion, ForceIsTheGradientOfTheExponentialAlsoInOverlap) {
  constexpr double strength = 1.7, length = 0.024, sum = 2.4;
  const RepulsionOfPair law = of_pair(RepulsionParameters{strength, length / sum, 20}, 1, 1.4);
  Draws draws(52);
  const auto energy = [&](double r) { return strength * std::exp(-(r - sum) / length); };
  for (const double gap : {-0.01, 0.0, 0.02, 0.1}) {
    const PairGeometry pair = pair_at(1, 1.4, gap, draws.direction());
    const Vector3 force = conservative_force(law, pair);
    EXPECT_NEAR(dot(force, pair.normal), slope(energy, pair.distance), 1e-6 * norm(force));
    EXPECT_NEAR(norm(across(force, pair.normal)), 0, 1e-12 * norm(force));
    EXPECT_LT(dot(force, pair.normal), 0);
  }
}

// The energy of a pair at contact, where the force is strength over length.
TEST(Repulsion, StrengthIsTheEnergyAtContact) {
  const RepulsionOfPair law = of_pair(RepulsionParameters{1.7, 0.01, 20}, 1, 1);
  EXPECT_NEAR(norm(conservative_force(law, pair_at(1, 1, 0, {1, 0, 0}))), 1.7 / 0.02, 1e-9);
  EXPECT_EQ(law.energy(0), 1.7);
}

TEST(Contact, CompressiveQuadrantGivesPositiveShearStress) {
  const Vector3 n = {std::sqrt(0.5), -std::sqrt(0.5), 0};
  const PairGeometry touching = pair_at(1, 1.4, -0.01, n), near = pair_at(1, 1.4, 0.01, n);
  EXPECT_GT(symmetric_dyad(touching.separation, contact_normal_force(1e4, touching)).xy, 0);
  const RepulsionOfPair repulsion = of_pair(RepulsionParameters{1, 0.01, 20}, 1, 1.4);
  EXPECT_GT(symmetric_dyad(near.separation, conservative_force(repulsion, near)).xy, 0);
}

// Compression is positive pressure: the trace of r F is negative.
TEST(Contact, PushesTheBoxApart) {
  const PairGeometry pair = pair_at(1, 1, -0.01, {0.6, 0, 0.8});
  const SymmetricTensor s = symmetric_dyad(pair.separation, contact_normal_force(1e4, pair));
  EXPECT_LT(s.xx + s.yy + s.zz, 0);
}

}  // namespace
}  // namespace peclet::engine
