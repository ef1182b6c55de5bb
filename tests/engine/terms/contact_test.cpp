// Contacts and conservative laws: the force is the gradient of the energy, the stiffness that of the force.
#include "engine/terms/contact.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/terms/conservative.h"
#include "tests/engine/components.h"
#include "tests/engine/two_spheres.h"

namespace peclet::engine {
namespace {

TEST(Contact, ForceIsTheGradientOfTheElasticEnergy) {
  constexpr double stiffness = 1e4, sum = 2.4;
  Draws draws(51);
  const auto energy = [&](double r) { return 0.5 * stiffness * (sum - r) * (sum - r); };
  for (const double gap : {-0.05, -0.01, -1e-4}) {
    const PairGeometry pair = pair_at(1, 1.4, gap, draws.direction());
    const Vector3 force = contact_normal_force(stiffness, pair);
    const double step = 1e-6, r = pair.distance, slope = (energy(r + step) - energy(r - step)) / (2 * step);
    EXPECT_NEAR(dot(force, pair.normal), slope, 1e-6 * norm(force));
    EXPECT_NEAR(norm(across(force, pair.normal)), 0, 1e-12 * norm(force));
    EXPECT_LT(dot(force, pair.normal), 0);  // i is pushed away from j
    EXPECT_NEAR(contact_energy(stiffness, pair.overlap()), energy(pair.distance),
                1e-9 * energy(pair.distance));
  }
  EXPECT_EQ(contact_energy(stiffness, -0.01), 0);
}

TEST(Contact, DampingOpposesTheNormalVelocityAlone) {
  const PairGeometry pair = pair_at(1, 1.4, -0.01, {0, 1, 0});
  expect_near(contact_damping_force(2, pair, {{5, -3, 7}, {}, {}}), {0, -6, 0}, 0);
  const PairMotion motion = {{5, -3, 7}, {}, {}};
  EXPECT_GT(dissipated({contact_damping_force(2, pair, motion), {}, {}}, motion), 0);
}

// The energy of a pair at contact, where the force is strength over length.
TEST(Repulsion, StrengthIsTheEnergyAtContact) {
  const RepulsionOfPair law = of_pair(RepulsionParameters{1.7, 0.01, 20}, 1, 1);
  expect_near(conservative_force(law, pair_at(1, 1, 0, {1, 0, 0})), {-1.7 / 0.02, 0, 0}, 1e-9);
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

PairGeometry pair_at_surface_distance(double first, double second, double h, const Vector3& normal) {
  return pair_at(first, second, 2 * h / (first + second), normal);
}

template <class Function>
double derivative(Function&& function, double x) {
  const double step = 1e-6;
  return (function(x + step) - function(x - step)) / (2 * step);
}

// Expects the gradients of `energy`, written independently of the law.
template <class Law, class Energy>
void expect_gradients(const Law& law, Energy&& energy, double first, double second) {
  Draws draws(53);
  for (const double h : {-0.02, -0.003, 0.002, 0.01, 0.04, 0.15}) {
    const PairGeometry pair = pair_at_surface_distance(first, second, h, draws.direction());
    const Vector3 force = conservative_force(law, pair);
    const double slope = derivative(energy, h);
    EXPECT_NEAR(law.energy(h), energy(h), 1e-12 * std::abs(energy(h))) << h;
    EXPECT_NEAR(dot(force, pair.normal), slope, 1e-6 * std::abs(slope)) << h;
    EXPECT_NEAR(norm(across(force, pair.normal)), 0, 1e-12 * norm(force)) << h;
    const auto gradient = [&](double x) { return law.slope(x); };
    EXPECT_NEAR(law.stiffness(h), derivative(gradient, h), 1e-5 * std::abs(law.slope(h)) / 0.02) << h;
  }
}

// Returns the largest |V''| at distances from h on, by trial.
template <class Law>
double largest_in(const Law& law, double h) {
  double largest = 0;
  for (double x = h; x < 0.3; x += 1e-5) largest = std::max(largest, std::abs(law.stiffness(x)));
  return largest;
}

TEST(Repulsion, HasTheGradientsOfTheExponential) {
  const RepulsionOfPair law = of_pair(RepulsionParameters{.strength = 1.7, .relative_length = 0.01}, 1, 1.4);
  expect_gradients(
      law, [](double h) { return 1.7 * std::exp(-h / 0.024); }, 1, 1.4);
  EXPECT_DOUBLE_EQ(law.range, 2.4 + 20 * 0.024);
}

// Monti et al. (2021) eq. 6: in overlap the force is that at contact.
TEST(Repulsion, HasTheGradientsOfTheScreenedForm) {
  const RepulsionOfPair law = of_pair(RepulsionParameters{.cutoff_lengths = 10,
                                                          .form = RepulsionParameters::Form::screened,
                                                          .force = 1.3,
                                                          .debye_length = 0.02,
                                                          .reference_radius = 0.5},
                                      1, 1.4);
  const double force = 1.3 * (2.8 / 2.4) / 0.5;
  const auto energy = [&](double h) { return force * (h > 0 ? 0.02 * std::exp(-h / 0.02) : 0.02 - h); };
  expect_gradients(law, energy, 1, 1.4);
  EXPECT_DOUBLE_EQ(law.range, 2.6);
  EXPECT_NEAR(norm(conservative_force(law, pair_at(1, 1.4, -0.01, {1, 0, 0}))), force, 1e-12);
}

// Monti et al. (2021) eq. 7 with a = 2 1.4 / 2.4 for spheres of radii 1 and 1.4.
TEST(Attraction, HasTheGradientsOfItsEnergyWhichEndsAtTheCutoff) {
  const AttractionOfPair law = of_pair(AttractionParameters{.hamaker = 0.6, .cutoff = 0.5}, 1, 1.4);
  const double mean = 2.8 / 2.4, c = 0.6 * mean / 12, width = 0.01 * mean;
  const auto energy = [&](double h) {
    return c / width * (h > 0 ? std::atan(h / width) : h / width) - c / width * std::atan(0.5 / width);
  };
  expect_gradients(law, energy, 1, 1.4);
  EXPECT_DOUBLE_EQ(law.range, 2.9);
  EXPECT_NEAR(law.energy(0.5), 0, 1e-15);
  EXPECT_NEAR(largest_in(law, 0), law.largest_stiffness(0), 1e-4 * law.largest_stiffness(0));
  EXPECT_NEAR(largest_in(law, 0.05), law.largest_stiffness(0.05), 1e-12);
}

TEST(Attraction, PullsSpheresInTouchByTheirRegularisedForce) {
  const AttractionOfPair law = of_pair(AttractionParameters{.hamaker = 0.6, .cutoff = 0.5}, 1, 1);
  const Vector3 force = conservative_force(law, pair_at(1, 1, 0, {1, 0, 0}));
  EXPECT_NEAR(force.x, 0.6 / 12 / 1e-4, 1e-9);        // towards j
  EXPECT_GT(symmetric_dyad({2, 0, 0}, force).xx, 0);  // tension
}

// The positive stiffness is that of the repulsion within its range, and zero beyond.
TEST(ConservativeLaws, GiveTheirStiffnessToMatricesWithinTheirRangeAlone) {
  ConservativeLaws laws;
  laws.repulsion = of_pair(RepulsionParameters{1.7, 0.01, 5}, 1, 1.4);
  const auto stiffness = [&](double h) {
    return positive_stiffness(laws, pair_at_surface_distance(1, 1.4, h, {0, 1, 0}), 3);
  };
  EXPECT_NEAR(stiffness(0.01), 3 * 1.7 / (0.024 * 0.024) * std::exp(-0.01 / 0.024), 1e-9);
  EXPECT_EQ(stiffness(0.1201), 0);
  EXPECT_NEAR(largest_stiffness(laws, 0, 2.4), 1.7 / (0.024 * 0.024), 1e-9);
  EXPECT_EQ(largest_stiffness(laws, 0.1201, 2.4), 0);
}

// Attraction reduces the sum, which stays at zero or above.
TEST(ConservativeLaws, GiveMatricesNoNegativeStiffness) {
  ConservativeLaws laws;
  laws.repulsion = of_pair(RepulsionParameters{1.7, 0.01, 5}, 1, 1);
  laws.attraction = of_pair(AttractionParameters{.hamaker = 0.6, .cutoff = 0.5}, 1, 1);
  const auto stiffness = [&](double h) {
    return positive_stiffness(laws, pair_at_surface_distance(1, 1, h, {0, 1, 0}), 3);
  };
  const double width = 0.01, h = 0.03, squares = h * h + width * width;
  const double both = 1.7 / 4e-4 * std::exp(-h / 0.02) - 2 * 0.05 * h / (squares * squares);
  ASSERT_LT(both, 0);
  EXPECT_EQ(stiffness(h), 0);
  laws.repulsion = of_pair(RepulsionParameters{17, 0.01, 5}, 1, 1);
  EXPECT_NEAR(stiffness(h), 3 * (both + 15.3 / 4e-4 * std::exp(-h / 0.02)), 1e-8);
}

}  // namespace
}  // namespace peclet::engine
