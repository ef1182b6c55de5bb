// The lifetime of a neighbour list, and its restoration from reference positions.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/state/neighbour_list.h"
#include "tests/engine/state/listed_pairs.h"

namespace peclet::engine {
namespace {

// Moves particles with the flow plus a random displacement of up to `step` in each component.
void move(ParticleState& particles, PeriodicCell& box, double strain, double step, Draws& draws) {
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 x = particles.position[i];
    particles.position.set(i, x + Vector3{strain * x.y, 0, 0} + draws.vector(step));
  }
  box.deform(simple_shear(box.strain() + strain));
}

class NeighbourListOfSizes : public testing::TestWithParam<std::vector<double>> {};
INSTANTIATE_TEST_SUITE_P(AlikeAndEightfold, NeighbourListOfSizes,
                         testing::Values(std::vector<double>{1, 1.4}, std::vector<double>{0.5, 4}));

TEST_P(NeighbourListOfSizes, MissesNoInteractingPairForAsLongAsItHolds) {
  Draws draws(14);
  PeriodicCell box({12, 11, 10}, simple_shear(1), -5);
  ParticleState particles = scattered(150, GetParam(), box, draws);
  NeighbourList list(ranges_of(particles.radius), 0.15);
  list.build(particles, box);
  int checks = 0;
  for (int step = 0; step < 400; ++step) {
    move(particles, box, 0.0025, 0.008, draws);
    if (!list.holds(particles, box)) {
      list.build(particles, box);
      continue;
    }
    ++checks;
    const std::vector<SeenPair> held = listed(list);
    const std::set<std::tuple<std::uint32_t, std::uint32_t, LatticeShift>> names = [&] {
      std::set<std::tuple<std::uint32_t, std::uint32_t, LatticeShift>> all;
      for (const SeenPair& pair : held) all.emplace(pair.first, pair.second, pair.image);
      return all;
    }();
    for (const SeenPair& pair : near(particles, box, outer)) {
      ASSERT_TRUE(names.count({pair.first, pair.second, pair.image})) << "step " << step;
    }
  }
  EXPECT_GT(list.builds(), 10u);
  EXPECT_GT(checks, 200);
}

// Two of the largest spheres, just outside the list, approach as fast as the criterion assumes. It must fail
// when they come into range, not before. Without strain each moves by half the skin times the range. With
// strain the separation lies along the direction of largest compression.
TEST(NeighbourList, IsRebuiltOnlyWhenAPairCouldBeMissing) {
  constexpr double skin = 0.15, range = 2 * outer;
  for (const double strain : {0.0, 0.02, -0.05, 0.1}) {
    PeriodicCell box({20, 20, 20}, simple_shear(1));
    ParticleState particles = make_particles({1, 1}, 1);
    // F = [[1, g], [0, 1]] compresses most, by s, along the eigenvector (g, s^2 - 1) of F^T F.
    const double s = std::sqrt(1 + 0.25 * strain * strain) - 0.5 * std::abs(strain);
    const Vector3 along = strain == 0 ? Vector3{0.6, 0, 0.8} : Vector3{strain, s * s - 1, 0};
    const Vector3 compressed = (1 / norm(along)) * along;
    particles.position.set(1, (range * (1 + skin) + 1e-9) * compressed);
    NeighbourList list(ranges_of(particles.radius), skin);
    list.build(particles, box);
    ASSERT_TRUE(list.pairs().empty());
    box.deform(simple_shear(strain));
    const Vector3 carried = particles.position[1] + Vector3{strain * particles.position[1].y, 0, 0};
    ASSERT_NEAR(norm(carried), s * range * (1 + skin), 1e-8) << strain;
    const Vector3 direction = (1 / norm(carried)) * carried;
    const double distance = 0.5 * (norm(carried) - range);  // of each sphere until they are in range
    const auto approach = [&](double each) {
      particles.position.set(0, each * direction);
      particles.position.set(1, carried - each * direction);
      return list.holds(particles, box);
    };
    EXPECT_TRUE(approach(distance - 1e-6)) << strain;
    EXPECT_FALSE(approach(distance + 1e-6)) << strain;
  }
}

// Strain alone uses up the skin, for a particle at rest in the flow, when s (1 + skin) = 1.
TEST(NeighbourList, StrainAloneUsesUpTheSkin) {
  PeriodicCell box({20, 20, 20}, simple_shear(1));
  ParticleState particles = make_particles({1, 1}, 1);
  particles.position.set(1, {0, 10, 0});
  NeighbourList list(ranges_of(particles.radius), 0.15);
  list.build(particles, box);
  const double stretch = 1 / 1.15;
  const double largest = 1 / stretch - stretch;  // from s(strain) = stretch
  const auto carried_to = [&](double strain) {
    box.deform(simple_shear(strain));
    particles.position.set(1, {strain * 10, 10, 0});
    return list.holds(particles, box);
  };
  EXPECT_TRUE(carried_to(0.999 * largest));
  EXPECT_FALSE(carried_to(1.001 * largest));
}

// Planar extension by e compresses by 1 / e, from any extension at which the list was built.
TEST(NeighbourList, ExtensionAloneUsesUpTheSkin) {
  for (const double before : {1.0, 1.6}) {
    PeriodicCell box({20, 20, 20}, Matrix3{});
    ParticleState particles = make_particles({1, 1}, 1);
    NeighbourList list(ranges_of(particles.radius), 0.15);
    const auto carry_to = [&](double e) {
      box.deform({Vector3{e - 1, 0, 0}, Vector3{0, 1 / e - 1, 0}, Vector3{}});
      particles.position.set(1, {3 * e, 9 / e, 0});
    };
    carry_to(before);
    list.build(particles, box);
    carry_to(before * 1.149);
    EXPECT_TRUE(list.holds(particles, box)) << before;
    EXPECT_NEAR(list.largest_displacement(particles, box), 0, 1e-13) << before;
    carry_to(before * 1.151);
    EXPECT_FALSE(list.holds(particles, box)) << before;
  }
}

// Lists narrowed from candidates equal those of a full search while the candidates are valid. Candidates are
// valid until a pair outside them could come within range.
TEST_P(NeighbourListOfSizes, ListsCandidatesAsItWouldListAll) {
  constexpr double skin = 0.05;
  Draws draws(16);
  PeriodicCell box({12, 11, 10}, simple_shear(1), -5);
  ParticleState particles = scattered(150, GetParam(), box, draws);
  NeighbourList list(ranges_of(particles.radius), skin, 0.4);
  EXPECT_FALSE(list.can_narrow(particles, box));
  list.build(particles, box);
  int narrowed = 0;
  for (int step = 0; step < 400; ++step) {
    move(particles, box, 0.0025, 0.008, draws);
    if (!list.can_narrow(particles, box)) {
      list.build(particles, box);
      continue;
    }
    list.narrow(particles, box);
    ++narrowed;
    const std::vector<SeenPair> expected = near_with_skin(particles, box, skin), found = listed(list);
    ASSERT_EQ(found.size(), expected.size()) << step;
    for (std::size_t p = 0; p < found.size(); ++p) {
      ASSERT_TRUE(found[p].first == expected[p].first && found[p].second == expected[p].second &&
                  found[p].image == expected[p].image)
          << step;
    }
    EXPECT_EQ(list.largest_displacement(particles, box), 0);
  }
  EXPECT_EQ(list.builds(), 401u);
  EXPECT_GT(narrowed, 300);
  EXPECT_LT(narrowed, 400);
}

class NeighbourListWithCandidates : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(NoneAndSome, NeighbourListWithCandidates, testing::Values(0, 0.4));

TEST_P(NeighbourListWithCandidates, IsTheSameAgainFromItsMoments) {
  Draws draws(15);
  PeriodicCell box({9, 8, 10}, simple_shear(1), 3);
  ParticleState particles = scattered(80, {1, 1.4}, box, draws);
  NeighbourList list(ranges_of(particles.radius), 0.15, GetParam());
  list.build(particles, box);
  if (GetParam() > 0) {
    move(particles, box, 0.03, 0.06, draws);
    ASSERT_TRUE(list.can_narrow(particles, box));
    list.narrow(particles, box);
  }
  move(particles, box, 0.01, 0.02, draws);
  NeighbourList again(ranges_of(particles.radius), 0.15, GetParam());
  again.rebuild_from(list.moment_of_candidates(), list.listed(), particles, box);
  ASSERT_EQ(again.pairs().size(), list.pairs().size());
  for (std::size_t p = 0; p < list.pairs().size(); ++p) {
    EXPECT_EQ(again.pairs()[p].first, list.pairs()[p].first);
    EXPECT_EQ(again.pairs()[p].second, list.pairs()[p].second);
    EXPECT_EQ(again.pairs()[p].image, list.pairs()[p].image);
    EXPECT_EQ(again.pairs()[p].kind, list.pairs()[p].kind);
  }
  EXPECT_EQ(again.images(), list.images());
  EXPECT_EQ(again.listed().displacement_gradient, list.listed().displacement_gradient);
  EXPECT_EQ(again.allowed_displacement(box), list.allowed_displacement(box));
  EXPECT_EQ(again.largest_displacement(particles, box), list.largest_displacement(particles, box));
  EXPECT_EQ(again.can_narrow(particles, box), list.can_narrow(particles, box));
}

}  // namespace
}  // namespace peclet::engine
