// Contacts and their mobilisation, in chains with springs of known length.
#include <gtest/gtest.h>

#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

// Returns spheres of radii 1 and 2 in turn at these places, with a list of near pairs and springs of zero.
System placed(const Scene& scene, const std::vector<Vector3>& places,
              SpringKinds kinds = SpringKinds::tangential) {
  System system = loose_spheres(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) system.particles.position.set(i, places[i]);
  build_list(system, scene.physics);
  system.springs = SpringField(kinds, system.list.pairs().size());
  return system;
}

// Returns a chain 0 - 1 - 2. The first two overlap by 0.1; the last has its centre at x.
System chain(const Scene& scene, double x, SpringKinds kinds = SpringKinds::tangential) {
  return placed(scene, {{1, 1, 1}, {3.9, 1, 1}, {x, 1, 1}}, kinds);
}

// Gives all contacts springs of this length.
void stretch(System& system, double length) {
  for (std::size_t p = 0; p < system.springs.size(); ++p) system.springs.set(p, {{0, length, 0}, {}});
}

// A chain 0 - 1 - 2 with overlaps of 0.1 and 0.2, and particle 3 alone; mu = 0.5, k_n = 1e4, k_t = 2/7 k_n.
// The longest spring is mu F_n / k_t = 1.75 overlaps.
TEST(ContactNetwork, CountsContactsAndTheirMobilisation) {
  const Scene scene = scene_with("contact_network");
  System system = placed(scene, {{1, 1, 1}, {3.9, 1, 1}, {6.7, 1, 1}, {5, 6, 6}});
  for (std::size_t p = 0; p < system.list.pairs().size(); ++p) {
    const Pair& pair = system.list.pairs()[p];
    const bool first = pair.first == 0 || pair.second == 0;
    system.springs.set(p, {{0, first ? 0.175 : 0.0875, 0}, {}});  // all of 0.175, a quarter of 0.35
  }
  const auto observable = observable_of(scene, system, 256);
  observable->sample(system, 0);
  const Json mean = mean_of(*observable);
  EXPECT_NEAR(mean["mobilised_friction"].get<double>(), (1 + 0.25) / 2, 1e-12);
  EXPECT_EQ(mean["sliding_contacts"], 0.5);
  EXPECT_EQ(mean["contact_network"]["contacts"], Json({0.25, 0.5, 0.25, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  const Json& mobilisation = mean["contact_network"]["mobilisation"];
  EXPECT_EQ(mobilisation[5].get<double>() + mobilisation[4].get<double>(), 0.5);  // 0.25 up to rounding
  EXPECT_EQ(mobilisation[19], 0.5);
}

// F_n = 1000 and 2000, critical load 1200: for the second contact k_t s = 250 of 0.5 * 800.
TEST(ContactNetwork, LeavesContactsBelowTheCriticalLoadWithoutFriction) {
  Scene scene = scene_with("contact_network");
  scene.physics.contact->critical_load = 1200;
  System system = chain(scene, 6.7);
  stretch(system, 0.0875);
  const auto observable = observable_of(scene, system, 256);
  observable->sample(system, 0);
  const Json mean = mean_of(*observable);
  EXPECT_EQ(mean["frictional_contacts"], 0.5);
  EXPECT_NEAR(mean["mobilised_friction"].get<double>(), 0.625, 1e-12);
  EXPECT_EQ(mean["sliding_contacts"], 0);
  EXPECT_EQ(blocks_of(*observable)["frictional_contacts"][0], 0.5);
}

// k_t s = 250 of 500, plus gamma_t v_t = 100 where the surfaces move; the excess over 500 is cut.
TEST(ContactNetwork, CountsWhatDashpotsPush) {
  Scene scene = scene_with("contact_network");
  scene.physics.contact->tangential_damping = 100;
  System system = chain(scene, 6.8);
  stretch(system, 0.0875);
  for (const auto& [velocity, mobilised] : {std::pair{1.0, 0.7}, {10.0, 1.0}}) {
    system.particles.velocity.set(2, {0, velocity, 0});
    const auto observable = observable_of(scene, system, 256);
    observable->sample(system, 0);
    EXPECT_NEAR(mean_of(*observable)["mobilised_friction"].get<double>(), (0.5 + mobilised) / 2, 1e-12);
  }
}

// Two contacts have equal springs; the one whose state says so slides.
TEST(ContactNetwork, CountsContactsThatRememberThatTheySlide) {
  Scene scene = scene_with("contact_network");
  scene.physics.contact->kinetic_friction = 0.3;
  System system = chain(scene, 6.8, SpringKinds::tangential_that_slide);
  ASSERT_EQ(system.list.pairs().size(), 2u);
  system.springs.set(0, {{0, 0.105, 0}, {}, 1});
  system.springs.set(1, {{0, 0.105, 0}, {}, 0});
  const auto observable = observable_of(scene, system, 256);
  observable->sample(system, 0);
  const Json mean = mean_of(*observable);
  EXPECT_EQ(mean["sliding_contacts"], 0.5);
}

// Springs have half of their largest length in the first quarter of the window, and all of it later.
TEST(ContactNetwork, HasBlocks) {
  const Scene scene = scene_with("contact_network");
  System system = placed(scene, {{1, 1, 1}, {3.9, 1, 1}});
  const auto observable = observable_of(scene, system, 256);
  for (std::size_t block = 0; block < 32; ++block) {
    stretch(system, block < 8 ? 0.0875 : 0.175);  // longest: 1.75 overlaps
    if (block != 31) observable->sample(system, block);
  }
  const Json blocks = blocks_of(*observable);
  ASSERT_EQ(blocks["mobilised_friction"].size(), 32u);
  EXPECT_NEAR(blocks["mobilised_friction"][7].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(blocks["mobilised_friction"][8].get<double>(), 1, 1e-12);
  EXPECT_TRUE(blocks["mobilised_friction"][31].is_null());  // no sample
  EXPECT_EQ(blocks["sliding_contacts"][7], 0);
  EXPECT_EQ(blocks["sliding_contacts"][8], 1);
  ASSERT_EQ(blocks["contact_network"]["mobilisation"].size(), 4u);
  const Json& first = blocks["contact_network"]["mobilisation"][0];
  EXPECT_EQ(first[9].get<double>() + first[10].get<double>(), 1);  // 0.5 up to rounding
  EXPECT_EQ(blocks["contact_network"]["mobilisation"][3][19], 1);
  EXPECT_EQ(blocks["contact_network"]["contacts"][0][1], 1);
  EXPECT_NEAR(mean_of(*observable)["mobilised_friction"].get<double>(), (8 * 0.5 + 23) / 31, 1e-12);
}

}  // namespace
}  // namespace peclet::engine
