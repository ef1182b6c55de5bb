// Volume fraction, velocity and its variance by y, for spheres with known slabs and velocities.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/observables/velocity_variance.h"
#include "tests/engine/draws.h"
#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

double sphere(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

// Returns profiles of the box of edge 10 in bins 2 wide, of volume 200.
Json profiles_of(const System& system, int bins = 5, double shear_rate = 0) {
  const auto observable = observable_of(scene_with("profiles", {{"bins", bins}}, shear_rate), system, 256);
  observable->sample(system, 0);
  return mean_of(*observable)["profiles"];
}

// A sphere of radius 1 lies in one bin. For one of radius 2 the middle slab from -1 to 1 has the volume pi
// (a^2 2 - 2 / 3); the rest is in two equal caps.
TEST(Profiles, GiveEachBinItsSlabOfASphere) {
  System system = loose_spheres(2);
  system.particles.position.set(0, {3, 1, 3});
  system.particles.position.set(1, {7, 5, 7});
  const Json phi = profiles_of(system)["volume_fraction"];
  const double middle = std::numbers::pi * (8 - 2.0 / 3), cap = (sphere(2) - middle) / 2;
  const double expected[] = {sphere(1), cap, middle, cap, 0};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(phi[k].get<double>(), expected[k] / 200, 1e-14) << k;
}

TEST(Profiles, GoOnAtTheOtherSideOfTheBox) {
  System system = loose_spheres(1);
  system.particles.position.set(0, {3, 0, 3});
  const Json phi = profiles_of(system)["volume_fraction"];
  EXPECT_NEAR(phi[0].get<double>(), sphere(1) / 2 / 200, 1e-14);
  EXPECT_NEAR(phi[4].get<double>(), sphere(1) / 2 / 200, 1e-14);
  EXPECT_EQ(phi[2], 0);
}

TEST(Profiles, OfSpheresAnywhereAddUpToTheirVolume) {
  System system = loose_spheres(40);
  Draws draws(6);
  place_anywhere(system, draws);
  for (const int bins : {1, 5, 7, 100}) {
    double sum = 0;
    const Json phi = profiles_of(system, bins)["volume_fraction"];
    for (const Json& share : phi) sum += share.get<double>() / bins;
    EXPECT_NEAR(sum, 20 * (sphere(1) + sphere(2)) / 1000, 1e-13) << bins;
  }
}

// Layers of equal spheres two apart, at any height in the bins: every bin has the volume of one layer.
TEST(Profiles, OfAUniformLatticeAreUniform) {
  for (const double offset : {0.0, 0.3, 1.7}) {
    System system = equal_spheres(25);
    for (std::size_t i = 0; i < 25; ++i) {
      const std::size_t column = i % 5, layer = i / 5;
      system.particles.position.set(
          i, {2.0 * static_cast<double>(column), offset + 2.0 * static_cast<double>(layer), 5});
    }
    const Json phi = profiles_of(system)["volume_fraction"];
    for (const Json& share : phi) {
      EXPECT_NEAR(share.get<double>(), 5 * sphere(1) / 200, 1e-14) << offset;
    }
  }
}

// Returns the volume of a sphere at `height`, with its images, between two heights, by many thin discs.
double discs_between(double low, double high, double height, double radius) {
  constexpr int discs = 20000;
  const double thickness = 2 * radius / discs;
  double volume = 0;
  for (int k = 0; k < discs; ++k) {
    const double z = (k + 0.5) * thickness - radius, y = height + z;
    for (const double image : {y - edge, y, y + edge}) {
      if (image >= low && image < high) volume += std::numbers::pi * (radius * radius - z * z) * thickness;
    }
  }
  return volume;
}

TEST(Profiles, HaveTheSpheresOfEachRadiusApart) {
  System system = loose_spheres(40);
  Draws draws(7);
  place_anywhere(system, draws);
  const Json found = profiles_of(system);
  const Json& by_radius = found["volume_fraction_by_radius"];
  ASSERT_EQ(by_radius.size(), 2u);
  for (std::size_t k = 0; k < 5; ++k) {
    const double low = 2 * static_cast<double>(k);
    double expected[] = {0, 0};  // of radius 1, of radius 2
    for (std::size_t i = 0; i < 40; ++i) {
      const double a = system.particles.radius[i];
      expected[a == 1 ? 0 : 1] += discs_between(low, low + 2, system.particles.position[i].y, a) / 200;
    }
    for (std::size_t s = 0; s < 2; ++s) {
      EXPECT_NEAR(by_radius[s][k].get<double>(), expected[s], 1e-4) << s << ' ' << k;
    }
    EXPECT_NEAR(by_radius[0][k].get<double>() + by_radius[1][k].get<double>(),
                found["volume_fraction"][k].get<double>(), 1e-14);
  }
}

// The small sphere lies in the first bin in the first quarter, and in the last bin in the last quarter.
TEST(Profiles, OfEachRadiusHaveTheQuartersOfTheWindow) {
  const double small = sphere(1) / 200;
  System system = loose_spheres(2);
  system.particles.position.set(1, {7, 5, 7});
  const auto observable = observable_of(scene_with("profiles", {{"bins", 5}}), system, 256);
  for (const auto& [block, height] : {std::pair(0, 1.0), std::pair(7, 1.0), std::pair(31, 9.0)}) {
    system.particles.position.set(0, {3, height, 3});
    observable->sample(system, static_cast<std::size_t>(block));
  }
  const Json blocks = blocks_of(*observable);
  const Json& quarters = blocks["profiles"]["volume_fraction_by_radius"];
  ASSERT_EQ(quarters.size(), 4u);
  EXPECT_NEAR(quarters[0][0][0].get<double>(), small, 1e-5 * small);
  EXPECT_EQ(quarters[0][0][4], 0);
  EXPECT_EQ(quarters[1], (Json{nullptr, nullptr}));  // no sample
  EXPECT_NEAR(quarters[3][0][4].get<double>(), small, 1e-5 * small);
  EXPECT_EQ(quarters[3][0][0], 0);
  EXPECT_EQ(quarters[3][1], quarters[0][1]);
  const Json mean = mean_of(*observable)["profiles"]["volume_fraction_by_radius"];
  EXPECT_NEAR(mean[0][0].get<double>(), 2 * small / 3, 1e-14);
}

// Relative to the flow the smaller sphere moves with 3, the larger one with -1; their volumes are 1 : 8.
TEST(Profiles, HaveTheVelocityRelativeToTheFlowByVolume) {
  constexpr double rate = 0.3;
  System system = loose_spheres(2, rate);
  system.particles.position.set(0, {3, 5, 3});
  system.particles.position.set(1, {7, 5, 7});
  for (std::size_t i = 0; i < 2; ++i) {
    system.particles.velocity.set(i, {rate * 5 + (system.particles.radius[i] == 1 ? 3 : -1), 7, 8});
  }
  const Json velocity = profiles_of(system, 1, rate)["velocity"];
  EXPECT_NEAR(velocity["flux"][0].get<double>() / velocity["volume_fraction"][0].get<double>(),
              (3 * 1 - 1 * 8) / 9.0, 1e-13);
}

// Slabs are a fifth wide: shear shifts their means and hardly changes the variance.
TEST(VelocityVariance, IsThatOfEachBinWithoutTheMeanFlow) {
  constexpr std::size_t bins = 3;
  VelocityVariance variance(12, 1, bins);  // bins 4 wide
  Draws draws(1);
  const double wanted[] = {1.0, 4.0, 0.25};
  for (int k = 0; k < 60000; ++k) {
    const double y = draws.uniform(0, 12), spread = std::sqrt(12 * wanted[static_cast<std::size_t>(y / 4)]);
    const auto scatter = [&] { return spread * draws.uniform(-0.5, 0.5); };
    variance.add({0, y - 12, 0}, {10 * std::sin(y) + scatter(), 3 + scatter(), 0});
  }
  const Json found = variance.value();
  for (std::size_t bin = 0; bin < bins; ++bin) {
    // Within a slab the flow 10 sin y varies by at most 2, a variance of at most 1/3.
    EXPECT_NEAR(found[1][bin].get<double>(), wanted[bin], 0.05 * wanted[bin]) << bin;
    EXPECT_GE(found[0][bin].get<double>(), 0.95 * wanted[bin]) << bin;
    EXPECT_LE(found[0][bin].get<double>(), 1.05 * wanted[bin] + 1.0 / 3) << bin;
    EXPECT_EQ(found[2][bin], 0) << bin;
  }
}

// Two samples of each slab, 1 and 3: the variance is 2, not the mean squared deviation from their mean, 1.
TEST(VelocityVariance, HasNoBiasOfFewSamples) {
  VelocityVariance variance(2, 1, 1);
  for (int slab = 0; slab < 10; ++slab) {
    for (const double u : {1.0, 3.0}) variance.add({0, 0.2 * slab + 0.1, 0}, {u + 100 * slab, 0, 0});
  }
  EXPECT_NEAR(variance.value()[0][0].get<double>(), 2, 1e-9);
}

TEST(VelocityVariance, OfABinThatNoSlabKnowsIsNull) {
  VelocityVariance variance(4, 1, 2);
  variance.add({0, 0.1, 0}, {1, 0, 0});
  variance.add({0, 0.1, 0}, {1, 0, 0});
  variance.add({0, 2.1, 0}, {1, 0, 0});
  EXPECT_EQ(variance.value()[0], (Json{0.0, nullptr}));
}

}  // namespace
}  // namespace peclet::engine
