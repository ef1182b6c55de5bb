// Mixtures of colloids and grains, size distributions and densities of a scene.
#include "engine/scene/composition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/integrators/derived_groups.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/packing.h"
#include "tests/contract/refusal.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

Json mixture(double alpha, const char* added, double base, std::size_t count = 4000) {
  Json document = Json::parse(R"({
    "particles": {"density": 0.1, "mixture": {
      "colloids": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}],
      "grains": [{"radius": 5, "volume_share": 1}, {"radius": 7, "volume_share": 1}]}},
    "addition": {},
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.009},
    "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})");
  document["particles"]["count"] = count;
  document["particles"]["mixture"]["alpha"] = alpha;
  document["addition"] = {{"added", added}, {"base_volume_fraction", base}};
  return document;
}

Scene read(Json document, const Json& patch = Json::object()) {
  document.merge_patch(patch);
  return read_scene(document, "scene.json");
}

// Returns a scene with these particles instead of the mixture.
Scene with_particles(const char* particles) {
  return read(mixture(0, "grains", 0.5),
              {{"addition", nullptr},
               {"volume_fraction", 0.4},
               {"particles", together({{{"mixture", nullptr}}, Json::parse(particles)})}});
}

// Published: grains added to colloids at 0.55, and colloids to grains.
TEST(Mixture, HasThePublishedVolumeFractions) {
  const double published[] = {0.550, 0.576, 0.604, 0.636, 0.671, 0.710};
  for (int k = 0; k <= 5; ++k) {
    EXPECT_NEAR(read(mixture(0.1 * k, "grains", 0.55)).volume_fraction, published[k], 5e-4) << k;
    EXPECT_NEAR(read(mixture(1 - 0.1 * k, "colloids", 0.55)).volume_fraction, published[k], 5e-4) << k;
  }
}

// An addition conserves liquid (1 - phi) over the group already there, phi (1 - alpha) or phi alpha.
TEST(Mixture, AdditionKeepsLiquidAndTheOtherGroup) {
  for (const double base : {0.3, 0.55, 0.62}) {
    for (const double alpha : {0.01, 0.3, 0.6}) {
      const double grains_added = read(mixture(alpha, "grains", base)).volume_fraction;
      EXPECT_NEAR((1 - grains_added) / (grains_added * (1 - alpha)), (1 - base) / base, 1e-12);
      const double colloids_added = read(mixture(1 - alpha, "colloids", base)).volume_fraction;
      EXPECT_NEAR((1 - colloids_added) / (colloids_added * (1 - alpha)), (1 - base) / base, 1e-12);
    }
  }
}

TEST(Mixture, AtAGivenVolumeFractionAlphaAloneVaries) {
  Json document = mixture(0.7, "grains", 0.5);
  document.erase("addition");
  document["volume_fraction"] = 0.78;  // denser than spheres of one size
  EXPECT_EQ(read(document).volume_fraction, 0.78);
}

TEST(Mixture, GroupsHaveTheirPartsOfTheVolume) {
  const Particles particles = read(mixture(0.4, "grains", 0.5)).particles;
  ASSERT_EQ(particles.species.size(), 4U);
  EXPECT_EQ(particles.mixture->colloid_species, 2U);
  const double expected[] = {0.3, 0.3, 0.2, 0.2};
  for (std::size_t s = 0; s < 4; ++s) EXPECT_NEAR(particles.species[s].share, expected[s], 1e-15);
}

// Equal numbers of radii 5 and 7 have volumes 125 to 343.
TEST(Mixture, AGroupMayHaveSharesOfTheNumber) {
  const Json patch = Json::parse(R"({"particles": {"mixture": {
      "grains": [{"radius": 5, "number_share": 2}, {"radius": 7, "number_share": 2}]}}})");
  const Particles particles = read(mixture(0.4, "grains", 0.5), patch).particles;
  EXPECT_NEAR(particles.species[2].share, 0.4 * 125 / 468, 1e-15);
  EXPECT_NEAR(particles.species[3].share, 0.4 * 343 / 468, 1e-15);
  EXPECT_NEAR(particles.species[0].share, 0.3, 1e-15);
}

TEST(Mixture, AGroupWithoutVolumeHasNoSpheres) {
  const Scene colloids = read(mixture(0, "grains", 0.5)), grains = read(mixture(1, "colloids", 0.5));
  ASSERT_EQ(colloids.particles.species.size(), 2U);
  EXPECT_EQ(colloids.particles.species[1].radius, 1.4);
  ASSERT_EQ(grains.particles.species.size(), 2U);
  EXPECT_EQ(grains.particles.species[0].radius, 5);
  for (const Scene& scene : {colloids, grains}) {
    const std::vector<std::size_t> numbers = species_numbers(scene.particles);
    EXPECT_EQ(numbers[0] + numbers[1], 4000U);
    EXPECT_EQ(scene.particles.reference_radius, 1);
  }
  EXPECT_EQ(*derived_groups(colloids).alpha, 0);
  EXPECT_NEAR(*derived_groups(grains).alpha, 1, 1e-15);
}

TEST(Mixture, TheRadiusOfReferenceIsThatOfAGroupOrTheirMean) {
  const auto radius = [](const char* name) {
    return read(mixture(0.4, "grains", 0.5), {{"particles", {{"mixture", {{"reference", name}}}}}})
        .particles.reference_radius;
  };
  EXPECT_EQ(radius("colloids"), 1);
  EXPECT_EQ(radius("grains"), 5);
  EXPECT_NEAR(radius("mean"), 0.6 * 1 + 0.4 * 5, 1e-15);
  EXPECT_EQ(read(mixture(0.4, "grains", 0.5), {{"particles", {{"reference_radius", 3}}}})
                .particles.reference_radius,
            3);
}

// By hand: shares over a^3 are 0.45, 0.16399, 0.0004 and 0.00014577, so 4000 spheres have 0.95 of the largest
// size. Rounding it to 1 takes 17.6 from the volume of the others: 307.9 / 125 = 2.46. The other 3997 are
// 2.744 : 1.
TEST(Mixture, GrainsAreRoundedFromTheLargestOn) {
  const Scene scene = read(mixture(0.1, "grains", 0.55));
  EXPECT_EQ(species_numbers(scene.particles), (std::vector<std::size_t>{2929, 1068, 2, 1}));
  // (2 * 125 + 343) / (593 + 2929 + 1068 * 2.744) = 593 / 6452.6
  EXPECT_NEAR(*derived_groups(scene).alpha, 0.091901, 1e-6);
  // 250 / 6452.6 over 0.05, less 1
  EXPECT_NEAR(*derived_groups(scene).largest_share_error, 0.225118, 1e-5);
}

TEST(Mixture, AlphaIsMetToHalfOfTheSmallestGrain) {
  for (const std::size_t count : {1000U, 3001U, 20000U}) {
    for (double alpha = 0.02; alpha < 1; alpha += 0.049) {
      const Scene scene = read(mixture(alpha, "grains", 0.01, count));
      const std::vector<std::size_t> numbers = species_numbers(scene.particles);
      EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), std::size_t{0}), count);
      // Volume before rounding; one colloid more or less changes it little.
      const double per_volume = (1 - alpha) * (0.5 + 0.5 / 2.744) + alpha * (0.5 / 125 + 0.5 / 343);
      const double volume = static_cast<double>(count) / per_volume;
      const double grains = 125 * static_cast<double>(numbers[2]) + 343 * static_cast<double>(numbers[3]);
      EXPECT_LE(std::abs(grains - alpha * volume), 62.5 + 1e-6) << count << ' ' << alpha;
    }
  }
}

TEST(Mixture, PecletNumbersAreOfEachGroup) {
  const Scene scene =
      read(mixture(0.5, "grains", 0.5), {{"fluid", {{"thermal_energy", 0.6 * std::numbers::pi * 0.009}}}});
  const DerivedGroups groups = derived_groups(scene);
  EXPECT_NEAR(*groups.peclet, 1, 1e-12);
  EXPECT_NEAR(*groups.peclet_mean, 27, 1e-10);     // a_cg = 3
  EXPECT_NEAR(*groups.peclet_grains, 125, 1e-10);  // a_g = 5
  EXPECT_EQ(to_json(groups)["volume_fraction"], scene.volume_fraction);
}

// The hash identifies checkpoints, so documents without these keys must be filled in as before.
TEST(Composition, NothingIsFilledIntoScenesWithoutIt) {
  const Json particles = {{"count", 10}, {"density", 0.1}, {"species", {{{"radius", 1}}}}};
  Json document = mixture(0, "grains", 0.5);
  document.erase("addition");
  document["volume_fraction"] = 0.3;
  document["particles"] = particles;
  const Json filled = read_scene(document, "scene.json").document;
  EXPECT_EQ(filled["particles"], particles);
  EXPECT_FALSE(filled.contains("addition"));
}

TEST(Composition, ADistributionSharesWithOtherSizes) {
  const Scene scene = with_particles(R"({"species": [{"volume_share": 3, "distribution":
      {"form": "lognormal", "by": "number", "mean_radius": 1, "relative_width": 0.3}},
      {"radius": 4, "volume_share": 1}]})");
  ASSERT_EQ(scene.particles.species.size(), 17U);
  EXPECT_NEAR(scene.particles.species[16].share, 0.25, 1e-15);
  double volume = 0, number = 0, radius = 0;
  for (std::size_t s = 0; s < 16; ++s) {
    const Species& one = scene.particles.species[s];
    const double own = one.share / std::pow(one.radius, 3);
    volume += one.share;
    number += own;
    radius += own * one.radius;
  }
  EXPECT_NEAR(volume, 0.75, 1e-12);
  EXPECT_NEAR(radius / number, 1, 3e-3);
}

// Derived numbers are those of whole spheres: 10 000 spheres miss up to half a sphere of each of 16 sizes.
TEST(Composition, MeanAndWidthOfWholeSpheresAreTold) {
  const Scene scene = with_particles(R"({"count": 10000, "species": [{"distribution":
      {"form": "uniform", "by": "number", "mean_radius": 2, "relative_width": 0.2}}]})");
  const Json derived = to_json(derived_groups(scene));
  EXPECT_NEAR(derived["mean_radius"].get<double>(), 2, 0.01);
  EXPECT_NEAR(derived["relative_width"].get<double>(), 0.2, 0.002);
}

TEST(Composition, AHistogramHasItsOwnRadii) {
  const auto shares = [](const std::string& by) {
    const std::string particles = R"({"species": [{"distribution": {"form": "histogram", "radii": [1, 1.5, 2],
        "shares": [1, 0, 3], "by": ")" +
                                  by + R"("}}]})";
    return with_particles(particles.c_str()).particles.species;
  };
  for (const char* by : {"number", "volume"}) {
    const std::vector<Species> species = shares(by);
    ASSERT_EQ(species.size(), 2U);
    EXPECT_EQ(species[0].radius, 1);
    EXPECT_EQ(species[1].radius, 2);
  }
  EXPECT_NEAR(shares("volume")[1].share, 0.75, 1e-15);
  EXPECT_NEAR(shares("number")[1].share, 24.0 / 25, 1e-15);
}

TEST(Composition, DensitiesAreOfEachSpecies) {
  const Particles particles = with_particles(R"({"species": [
      {"radius": 1, "volume_share": 1}, {"radius": 2, "volume_share": 1, "density": 0.7}]})")
                                  .particles;
  EXPECT_EQ(density_of(particles, particles.species[0]), 0.1);
  EXPECT_EQ(density_of(particles, particles.species[1]), 0.7);
  EXPECT_NEAR(mass_of(particles, particles.species[1]), 0.7 * 4 / 3 * std::numbers::pi * 8, 1e-12);
  const std::vector<double> radius = species_radii(particles), density = species_densities(particles);
  ASSERT_EQ(density.size(), radius.size());
  for (std::size_t i = 0; i < radius.size(); ++i) EXPECT_EQ(density[i], radius[i] == 1 ? 0.1 : 0.7);
}

// tau_I = rho_i a_i^2 / eta is that of the reference radius. Expected: St = 0.009 * 0.1 / 0.1 for all sizes,
// and tau_I / tau_B = rho_i kT / (eta^2 a_i) of the smallest sphere.
TEST(Composition, EqualInertiaIsThatOfTheRadiusOfReference) {
  const Scene scene = read(mixture(0.4, "grains", 0.5), Json::parse(R"({
      "fluid": {"thermal_energy": 0.01}, "particles": {"density_rule": "equal-inertia"}})"));
  for (const Species& species : scene.particles.species) {
    EXPECT_NEAR(density_of(scene.particles, species) * species.radius * species.radius, 0.1, 1e-15);
  }
  EXPECT_NEAR(*derived_groups(scene).largest_stokes, 0.009, 1e-12);
  EXPECT_NEAR(*derived_groups(scene).largest_inertia_over_brownian, 0.1, 1e-12);
}

TEST(Composition, TheLargestStokesNumberIsOfTheLargestSphere) {
  const Scene scene =
      read(mixture(0.4, "grains", 0.5), Json::parse(R"({"fluid": {"thermal_energy": 0.001}})"));
  EXPECT_NEAR(*derived_groups(scene).stokes, 0.009, 1e-12);
  EXPECT_NEAR(*derived_groups(scene).largest_stokes, 0.009 * 49, 1e-12);
  EXPECT_NEAR(*derived_groups(scene).largest_inertia_over_brownian, 0.01, 1e-12);  // rho kT / (eta^2 a)
}

std::vector<std::string> codes_of(const Scene& scene) {
  std::vector<std::string> codes;
  for (const Warning& warning : scene_warnings(scene)) codes.push_back(warning.code);
  return codes;
}

TEST(Composition, InertiaOfTheLargestSphereIsWarnedOf) {
  using Codes = std::vector<std::string>;
  const Json few = {{"particles", {{"count", 40000}}}};
  const auto with_rate = [&](double rate) {
    Json patch = few;
    patch["flow"]["shear_rate"] = rate;
    return read(mixture(0.4, "grains", 0.5), patch);
  };
  EXPECT_EQ(codes_of(with_rate(0.099 / 49)), Codes{});
  EXPECT_EQ(codes_of(with_rate(0.101 / 49)), Codes{"inertia-shear"});
  EXPECT_EQ(codes_of(with_rate(0.2)), Codes{"inertia-shear"});
  Json patch = few;
  patch["particles"]["density_rule"] = "equal-inertia";
  EXPECT_EQ(codes_of(read(mixture(0.4, "grains", 0.5), patch)), Codes{});
}

TEST(Composition, SharesThatWholeNumbersMissAreWarnedOf) {
  Json patch = {{"flow", {{"shear_rate", 1e-4}}}};
  const std::vector<Warning> warnings = scene_warnings(read(mixture(0.1, "grains", 0.55), patch));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "composition");
  EXPECT_TRUE(
      contains(warnings[0].message,
               "2 of radius 5 have 0.0387 of the volume, 0.0500 was asked for; alpha is 0.0919 for 0.1000"));
  patch["particles"]["count"] = 40000;
  EXPECT_TRUE(scene_warnings(read(mixture(0.1, "grains", 0.55), patch)).empty());
}

}  // namespace
}  // namespace peclet::engine
