#include <gtest/gtest.h>
#include <omp.h>

#include <bit>
#include <numbers>

#include "tests/bench/engine/catalogue.h"
#include "tests/bench/engine/operations.h"
#include "tests/bench/engine/tiling.h"
#include "tests/contract/refusal.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/every_image.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

TEST(Tiling, LeavesEveryParticleTheForcesThatItHas) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .damping = true});
  System small = dense_suspension(physics, 150, 3);
  small.box = PeriodicCell(small.box.lengths(), simple_shear(physics.flow.rate()));
  small.box.deform(simple_shear(1.3));
  small.box.change_basis(flips(1));
  rebuild_neighbours(small);
  const NeighbourList unbuilt = small.list;
  System large = tiled(small, 3);
  large.list = unbuilt;
  large.list.build(large.particles, large.box);
  ASSERT_EQ(large.particles.count(), 27 * 150u);
  const Evaluation of_small = evaluated(physics, small), of_large = evaluated(physics, large);
  VectorField force(large.particles.count()), torque(large.particles.count());
  for (std::size_t i = 0; i < large.particles.count(); ++i) {
    force.set(i, of_small.force[i % 150]);
    torque.set(i, of_small.torque[i % 150]);
    EXPECT_EQ(large.particles.id[i], i);
  }
  constexpr double fewer_digits = 1e-9;  // coordinates three cells away have fewer decimals
  expect_near(components(force), components(of_large.force), "force", fewer_digits);
  expect_near(components(torque), components(of_large.torque), "torque", fewer_digits);
  std::vector<double> stress = components(of_small.sums);
  for (double& component : stress) component *= 27;
  expect_near(stress, components(of_large.sums), "stress", fewer_digits);
  EXPECT_EQ(27 * of_small.sums.contacts, of_large.sums.contacts);
}

// The formulas of each near pair need a distance and ln(1/xi), and at least one quotient each for the
// normal and for 1/xi. Noise needs two more roots, of the squeeze mode and of the logarithm.
TEST(Operations, OfEachNearPairAreOneLogarithmAndTheRootsOfItsFormulas) {
  for (const bool noise : {false, true}) {
    const Physics physics = physics_with({.lubrication = true, .noise = noise, .contact = true});
    const System system = dense_suspension(physics, 200, 5);
    const std::size_t near = count_near(system, 1 + 0.5 * physics.lubrication->outer_gap);
    const std::optional<Operations> done = count_operations(physics, system, timestep);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->logarithms, near);
    EXPECT_EQ(done->roots, (noise ? 3 : 1) * near);
    EXPECT_EQ(done->exponentials, 0u);
    EXPECT_GE(done->quotients, 2 * near);
  }
}

TEST(Operations, AreNotMadeUpForTermsThatAreNotCounted) {
  const Physics physics = physics_with({.conservative = true});
  EXPECT_FALSE(count_operations(physics, dense_suspension(physics, 50, 5), timestep));
}

Scene only_scene(const char* name) { return chosen_groups({name}).at(0).contestants.at(0).scene; }

TEST(Catalogue, GivesGroupsWholeAndContestantsAlone) {
  const std::vector<Group> whole = chosen_groups({"reference"}), one = chosen_groups({"friction"});
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].contestants.size(), 3u);
  ASSERT_EQ(one.size(), 1u);
  ASSERT_EQ(one[0].contestants.size(), 1u);
  EXPECT_EQ(one[0].contestants[0].scene.physics.contact->friction, 0.5);
  EXPECT_GT(chosen_groups({}).size(), 8u);
}

TEST(Catalogue, TakesImplicitStepsOnlyWhereTheirNameSaysSo) {
  std::size_t implicit = 0;
  for (const Group& group : chosen_groups({})) {
    for (const Contestant& each : group.contestants) {
      const bool named = each.name.starts_with("implicit");
      EXPECT_EQ(each.scene.method == Method::implicit_steps, named) << each.name;
      implicit += named ? 1 : 0;
    }
  }
  const auto processors = static_cast<unsigned>(omp_get_num_procs());
  EXPECT_EQ(implicit, 9u + static_cast<unsigned>(std::bit_width(processors)));  // on 1, 2, 4 ... threads
}

// These cases used most time before they were optimised.
TEST(Catalogue, HasImplicitStepsOfFrictionNoiseAndSpheresOfSeveralSizes) {
  const auto scene = &only_scene;
  EXPECT_EQ(scene("implicit-friction").physics.contact->friction, 1);
  EXPECT_EQ(scene("implicit-four-sizes").particles.species.size(), 4u);
  const Physics noisy = scene("implicit-peclet-1").physics;
  // Pe = 6 pi eta a^3 rate / kT with eta = 0.1 and a = 1.
  EXPECT_NEAR(6 * std::numbers::pi * 0.1 * noisy.flow.rate() / noisy.thermal_energy, 1, 1e-12);
  EXPECT_EQ(scene("implicit-65536").particles.count, 65536u);
}

TEST(Catalogue, GivesImplicitStepsTheirOwnDefaults) {
  // The schema's default is 0.3 of the smallest radius, and 0.05 with explicit steps.
  EXPECT_EQ(only_scene("implicit").guard.largest_displacement, 0.3);
  EXPECT_EQ(only_scene("frictionless").guard.largest_displacement, 0.05);
}

TEST(Catalogue, SaysWhatItHasWhenAskedForSomethingElse) {
  const std::string message = refusal_by([] { chosen_groups({"frictionless", "fast"}); });
  EXPECT_TRUE(contains(message, "fast"));
  EXPECT_TRUE(contains(message, "frictionless, friction, brownian"));
}

// A term of strength zero is left out before a kernel is chosen.
TEST(Catalogue, ATermOfNoStrengthIsATermThatIsAbsent) {
  std::size_t groups = 0;
  for (const Group& group : chosen_groups({})) {
    if (!group.name.starts_with("term-")) continue;
    ++groups;
    const auto terms = [&](std::size_t k) { return required_terms(group.contestants[k].scene.physics); };
    ASSERT_EQ(group.contestants.size(), 3u);
    EXPECT_EQ(terms(0), terms(1)) << group.name;
    EXPECT_NE(terms(0), terms(2)) << group.name;
  }
  EXPECT_EQ(groups, 5u);
}

}  // namespace
}  // namespace peclet::engine
