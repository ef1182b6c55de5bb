// The fabric tensor of configurations with known directions, and of realisations.
#include <gtest/gtest.h>

#include "tests/engine/observables/loose_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

using Components = std::vector<double>;

void expect_components(const Json& found, const Components& expected) {
  ASSERT_EQ(found.size(), 6u) << found;
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(found[c].get<double>(), expected[c], 1e-12) << c;
}

// Returns spheres of radii 1 and 2 at surface distance `distance` along `way`.
System dumbbell(const Vector3& way, double distance) {
  System system = loose_spheres(2);
  const Vector3 first{9, 9.5, 1};
  system.particles.position.set(0, first);
  system.particles.position.set(1, first + ((3 + distance) / norm(way)) * way);
  wrap_into_cell(system.particles, system.box);
  return system;
}

Json fabric_of(const System& system) {
  const auto observable = observable_of(scene_with("fabric"), system, 256);
  observable->sample(system, 0);
  return mean_of(*observable).at("fabric");
}

TEST(Fabric, OfTwoTouchingSpheresIsTheSquareOfTheirAxis) {
  const Json fabric = fabric_of(dumbbell({1, 0, 0}, -0.01));
  expect_components(fabric["contacts"], {1, 0, 0, 0, 0, 0});
  EXPECT_EQ(fabric["near"], fabric["contacts"]);
}

// n = (2, -1, 2) / 3, through faces of the box, and as seen from the other sphere.
TEST(Fabric, OfATurnedDumbbellIsTurnedWithIt) {
  for (const double sign : {1.0, -1.0}) {
    const Json fabric = fabric_of(dumbbell(sign * Vector3{2, -1, 2}, -0.01));
    expect_components(fabric["contacts"], {4. / 9, 1. / 9, 4. / 9, -2. / 9, 4. / 9, -2. / 9});
  }
}

// xi = 2 h / (a_i + a_j) = 0.05 is h = 0.075.
TEST(Fabric, HasPairsUpToTheGivenGap) {
  for (const double distance : {0.0749, 0.0751}) {
    const Json fabric = fabric_of(dumbbell({0, 1, 0}, distance));
    EXPECT_TRUE(fabric["contacts"].is_null());
    if (distance < 0.075) {
      expect_components(fabric["near"], {0, 1, 0, 0, 0, 0});
    } else {
      EXPECT_TRUE(fabric["near"].is_null());
    }
  }
}

// Each sphere of a cubic lattice has neighbours along three axes.
TEST(Fabric, OfAnIsotropicNetworkIsAThirdOfTheUnitTensor) {
  System system = equal_spheres(125, 1.01);
  for (std::size_t i = 0; i < 125; ++i) {
    const auto along = [&](std::size_t stride) { return 2 * static_cast<double>(i / stride % 5); };
    system.particles.position.set(i, {along(1), along(5), along(25)});
  }
  const Json fabric = fabric_of(system);
  for (const char* const pairs : {"contacts", "near"})
    expect_components(fabric[pairs], {1. / 3, 1. / 3, 1. / 3, 0, 0, 0});
}

// The contact is along x in the first quarter and along y in the second; later nothing touches.
TEST(Fabric, HasTheQuartersOfTheWindow) {
  const System along_x = dumbbell({1, 0, 0}, -0.01), along_y = dumbbell({0, 1, 0}, -0.01);
  const auto observable = observable_of(scene_with("fabric"), along_x, 256);
  observable->sample(along_x, 0);
  observable->sample(along_x, 7);
  observable->sample(along_y, 8);
  observable->sample(dumbbell({0, 0, 1}, 0.01), 24);
  const Json blocks = blocks_of(*observable);
  const Json& contacts = blocks["fabric"]["contacts"];
  ASSERT_EQ(contacts.size(), 4u);
  expect_components(contacts[0], {1, 0, 0, 0, 0, 0});
  expect_components(contacts[1], {0, 1, 0, 0, 0, 0});
  EXPECT_TRUE(contacts[2].is_null());  // no sample
  EXPECT_TRUE(contacts[3].is_null());  // no contact
  expect_components(blocks["fabric"]["near"][3], {0, 0, 1, 0, 0, 0});
  const Json fabric = mean_of(*observable).at("fabric");
  expect_components(fabric["contacts"], {2. / 3, 1. / 3, 0, 0, 0, 0});
  expect_components(fabric["near"], {0.5, 0.25, 0.25, 0, 0, 0});
}

// A dumbbell that turns between parts of the window and opens in the last one.
TEST(Fabric, IsFollowedOverTheWindowOfATransient) {
  const Scene scene = scene_with("transient", {{"bins", 4}, {"fabric_gap", 0.05}}, 0.3);
  const System parts[] = {dumbbell({1, 0, 0}, -0.01), dumbbell({1, -1, 0}, -0.01), dumbbell({0, 0, 1}, 0.05),
                          dumbbell({0, 0, 1}, 0.2)};
  const auto observable = observable_of(scene, parts[0], 4000);
  for (std::size_t step = 0; step < 4000; ++step) {
    observable->take_flux({});
    observable->sample(parts[step / 1000], 0);
  }
  const Json fabric = mean_of(*observable).at("transient").at("fabric");
  const auto in_part = [&](const char* pairs, std::size_t part) {
    Json components;
    for (const Json& row : fabric[pairs]) components.push_back(row[part]);
    return components;
  };
  const Json none(6, nullptr);
  expect_components(in_part("contacts", 0), {1, 0, 0, 0, 0, 0});
  expect_components(in_part("contacts", 1), {0.5, 0.5, 0, -0.5, 0, 0});
  EXPECT_EQ(in_part("contacts", 2), none);
  expect_components(in_part("near", 1), {0.5, 0.5, 0, -0.5, 0, 0});
  expect_components(in_part("near", 2), {0, 0, 1, 0, 0, 0});
  EXPECT_EQ(in_part("near", 3), none);
}

TEST(Fabric, IsNoPartOfATransientWithoutAGap) {
  const Json transient = result_of({{"observables", {"transient"}}}).at("mean").at("transient");
  EXPECT_FALSE(transient.contains("fabric"));
}

Json result_on(int threads, const Json& patch) {
  JobSpecification job = job_of(small_scene(patch));
  job.threads = threads;
  return run_job(job, {}).value();
}

// Shear presses pairs together along (1, -1, 0). The bits agree on any number of threads.
TEST(Fabric, OfAShearedSuspensionLiesAlongTheAxisOfCompression) {
  for (const double thermal_energy : {0.0, 0.02}) {
    const Json patch = {{"fluid", {{"thermal_energy", thermal_energy}}},
                        {"observables", {"fabric", "transient"}},
                        {"fabric", {{"interval", 0.002}}},
                        {"transient", {{"bins", 5}, {"fabric_gap", 0.1}}}};
    const Json mean = result_on(1, patch).at("mean");
    for (const char* const pairs : {"contacts", "near"}) {
      const Json& fabric = mean.at("fabric").at(pairs);
      EXPECT_NEAR(fabric[0].get<double>() + fabric[1].get<double>() + fabric[2].get<double>(), 1, 1e-12);
      EXPECT_LT(fabric[3].get<double>(), -0.02) << pairs << ' ' << thermal_energy;
    }
    EXPECT_EQ(result_on(3, patch).at("mean"), mean);
  }
}

}  // namespace
}  // namespace peclet::engine
