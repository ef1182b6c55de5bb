// Counts of pairs by distance and direction, for uniform points and single pairs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contract/errors.h"
#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

std::unique_ptr<Observable> observable_with_slab(const System& system, double range, double bin,
                                                 double slab) {
  return observable_of(scene_with("pair_distribution", {{"range", range}, {"bin", bin}, {"slab", slab}}),
                       system, 256);
}

// Uniform points have the ideal counts. Each bin's count is Poisson to good accuracy (twice that of unordered
// pairs, of variance 2 per ordered pair). Fresh seeds exceed 6 standard errors in 3240 bins with probability
// 1e-5.
TEST(PairDistribution, OfUniformPointsIsIdeal) {
  System system = loose_spheres(200);
  const auto observable = observable_with_slab(system, 4, 0.1, 0.5);
  Draws draws(3);
  for (int sample = 0; sample < 200; ++sample) {
    place_anywhere(system, draws);
    observable->sample(system, 0);
  }
  const Json mean = mean_of(*observable)["pair_distribution"];
  for (std::size_t k = 0; k < 40; ++k) {
    const double ideal = mean["radial"]["ideal"][k].get<double>();
    EXPECT_NEAR(mean["radial"]["counts"][k].get<double>(), ideal, 6 * std::sqrt(2 * ideal)) << k;
  }
  const double ideal = mean["slice"]["ideal"].get<double>();
  EXPECT_NEAR(ideal, 200.0 * 200 * 199 / 1000 * 0.01 * 1, 1e-6);
  for (const Json& row : mean["slice"]["counts"]) {
    for (const Json& count : row) EXPECT_NEAR(count.get<double>(), ideal, 6 * std::sqrt(ideal));
  }
}

// For a pair, the range extends beyond half of the box, up to 1 / sqrt(2) of it.
TEST(PairDistribution, OfAPairInASmallBoxIsIdealUpToTheCornerOfItsFaces) {
  System system = loose_spheres(2);
  const auto observable = observable_with_slab(system, 7, 0.25, 0.1);
  Draws draws(4);
  constexpr int samples = 100'000;
  for (int sample = 0; sample < samples; ++sample) {
    place_anywhere(system, draws);
    observable->sample(system, 0);
  }
  const Json radial = mean_of(*observable)["pair_distribution"]["radial"];
  for (std::size_t k = 4; k < 28; ++k) {
    const double ideal = radial["ideal"][k].get<double>();
    EXPECT_NEAR(radial["counts"][k].get<double>(), ideal, 5 * std::sqrt(2 * ideal)) << k;
  }
}

TEST(PairDistribution, CountsAPairFromBothEnds) {
  System system = loose_spheres(2);
  const auto observable = observable_with_slab(system, 4, 1, 0.5);
  system.particles.position.set(0, {9.5, 1, 0.2});
  system.particles.position.set(1, {1, 9.3, 9.8});  // across three faces: (1.5, -1.7, -0.4) from the first
  observable->sample(system, 0);
  const Json mean = mean_of(*observable)["pair_distribution"];
  EXPECT_EQ(mean["radial"]["counts"], Json({0, 0, 2, 0}));
  // Seen from the second sphere it is (-1.5, 1.7, 0.4).
  EXPECT_EQ(mean["slice"]["counts"], Json({{0, 0, 0, 0, 0, 0, 0, 0},
                                           {0, 0, 1, 0, 0, 0, 0, 0},
                                           {0, 0, 0, 0, 0, 0, 0, 0},
                                           {0, 0, 0, 0, 0, 0, 0, 0}}));
  EXPECT_EQ(mean["slice"]["x"][2], -1.5);
  EXPECT_EQ(mean["slice"]["y"][1], 1.5);
}

TEST(PairDistribution, RefusesARangeWhoseImagesAreNotUnique) {
  const System system = loose_spheres(2);
  for (const auto& [shear_rate, range] : {std::pair{0.3, 6}, std::pair{0.0, 8}}) {
    const Scene scene = scene_with("pair_distribution", {{"range", range}}, shear_rate);
    EXPECT_THROW(observable_of(scene, system, 256), InputError);
  }
}

TEST(PairDistribution, HasTheQuartersOfTheWindowUnlessTheyAreLong) {
  System system = loose_spheres(2);
  const auto blocks_with = [&](double bin) {
    const auto observable = observable_with_slab(system, 4, bin, 0.5);
    system.particles.position.set(0, {1, 1, 1});
    system.particles.position.set(1, {3.5, 1, 1});
    for (const std::size_t block : {0U, 7U, 24U}) observable->sample(system, block);
    return blocks_of(*observable);
  };
  const Json radial = blocks_with(1)["pair_distribution"]["radial"];
  EXPECT_EQ(radial["counts"], Json({{0, 0, 4, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 2, 0}}));
  // N (N - 1) / V times the volume of the shell and the number of samples.
  const double shell = 4 * std::numbers::pi / 3 * (27 - 8);
  EXPECT_NEAR(radial["ideal"][0][2].get<double>(), 2 * 2.0 / 1000 * shell, 1e-4 * shell);
  EXPECT_EQ(radial["ideal"][1][2], 0);
  EXPECT_TRUE(blocks_with(0.05).empty());  // 80 bins
}

}  // namespace
}  // namespace peclet::engine
