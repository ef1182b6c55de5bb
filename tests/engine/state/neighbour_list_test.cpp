#include "engine/state/neighbour_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>
#include <tuple>

#include "tests/engine/state/listed_pairs.h"

namespace peclet::engine {
namespace {

struct Case {
  std::size_t count;
  std::vector<double> sizes;
  Vector3 edges;
};

// Boxes of one cell to many, cubic and not; one size, sizes of ratio seven, and many similar sizes.
const Case cases[] = {{2, {1}, {2.2, 2.3, 2.1}},
                      {2, {1}, {4, 4, 4}},
                      {10, {1, 1.4}, {5, 5, 5}},
                      {40, {1, 1.4}, {6.1, 9.3, 7.7}},
                      {200, {1, 1.4}, {15, 15, 15}},
                      {150, {1, 1.4, 5, 7}, {16, 20, 25}},
                      {300, {1, 3}, {40, 12, 9}},
                      {250, {0.1, 0.3}, {2, 2, 2}},
                      {240, {1, 1.1, 1.3, 1.31, 1.8, 2, 2.9, 3}, {17, 15, 16}}};

TEST(NeighbourList, HoldsEveryPairInEveryImageAndNoOther) {
  Draws draws(11);
  std::size_t pairs = 0;
  for (const Case& each : cases) {
    for (const double tilt : {-0.5, -0.31, 0.0, 0.17, 0.4999, 0.5}) {
      const PeriodicCell box(each.edges, simple_shear(1), tilt * each.edges.x);
      const ParticleState particles = scattered(each.count, each.sizes, box, draws);
      for (const double skin : {0.0, 0.15}) {
        const NeighbourList list = list_of(particles, box, skin);
        EXPECT_EQ(listed(list), near_with_skin(particles, box, skin))
            << each.count << " spheres, tilt " << tilt << ", skin " << skin;
        pairs += list.pairs().size();
      }
    }
  }
  EXPECT_GT(pairs, 10000u);
}

// Cells of any shape and handedness, compared with all images of up to six lattice vectors along each.
TEST(NeighbourList, HoldsEveryPairOfACellOfAnyShape) {
  Draws draws(21);
  std::size_t pairs = 0;
  for (int n = 0; n < 12; ++n) {
    Matrix3 edges = 7 * identity() + Matrix3{draws.vector(3), draws.vector(3), draws.vector(3)};
    if (n % 2 == 1) std::swap(edges.column[0], edges.column[2]);
    const PeriodicCell box = PeriodicCell::with_edges(edges, Matrix3{});
    ParticleState particles = make_particles(std::vector<double>(25, 1.0), 1);
    for (std::size_t i = 0; i < particles.count(); ++i) particles.position.set(i, draws.vector(9));
    constexpr double skin = 0.1, reach = 2 * outer * (1 + skin);
    std::vector<std::tuple<std::uint32_t, std::uint32_t, double>> expected, found;
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
      for (std::uint32_t j = i + 1; j < particles.count(); ++j) {
        for (int k = 0; k < 13 * 13 * 13; ++k) {
          const int x = k / 169 - 6, y = k / 13 % 13 - 6, z = k % 13 - 6;
          const Vector3 whole = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          const double distance = norm(particles.position[j] + edges * whole - particles.position[i]);
          if (distance < reach) expected.emplace_back(i, j, distance);
        }
      }
    }
    const NeighbourList list = list_of(particles, box, skin);
    for (const Pair& pair : list.pairs()) {
      const auto [i, j] = std::minmax(pair.first, pair.second);
      const Vector3 image = box.displacement(list.images()[pair.image]);
      found.emplace_back(i, j,
                         norm(particles.position[pair.second] + image - particles.position[pair.first]));
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t p = 0; p < found.size(); ++p) {
      EXPECT_EQ(std::get<0>(found[p]), std::get<0>(expected[p]));
      EXPECT_EQ(std::get<1>(found[p]), std::get<1>(expected[p]));
      EXPECT_NEAR(std::get<2>(found[p]), std::get<2>(expected[p]), 1e-12);
    }
    pairs += found.size();
  }
  EXPECT_GT(pairs, 500u);
}

TEST(NeighbourList, KnowsTheSizesOfEachPair) {
  Draws draws(12);
  const PeriodicCell box({9, 9, 9}, Matrix3{}, 1);
  const ParticleState particles = scattered(60, {1, 1.4, 2}, box, draws);
  const NeighbourList list = list_of(particles, box, 0.1);
  const std::vector<double> sizes = {1, 1.4, 2};
  ASSERT_FALSE(list.pairs().empty());
  for (const Pair& pair : list.pairs()) {
    EXPECT_EQ(sizes[pair.kind / 3], particles.radius[pair.first]);
    EXPECT_EQ(sizes[pair.kind % 3], particles.radius[pair.second]);
  }
}

// In a cube of edge four radii a sphere touches two images of another at once.
TEST(NeighbourList, TwoSpheresMayMeetUnderSeveralImages) {
  const PeriodicCell box({4, 4, 4}, Matrix3{});
  ParticleState particles = make_particles({1, 1}, 1);
  particles.position.set(1, {2, 0, 0});
  const std::vector<SeenPair> expected = {{0, 1, {-1, 0, 0}, {}}, {0, 1, {0, 0, 0}, {}}};
  EXPECT_EQ(listed(list_of(particles, box, 0.05)), expected);
}

// Checks what the pair loop relies on.
void expect_arranged(const NeighbourList& list) {
  std::uint32_t next = 0, next_run = 0, next_particle = 0, crossings = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> outgoing, incoming;
  for (const ParticleBlock& block : list.blocks()) {
    EXPECT_EQ(block.begin, next_particle);
    EXPECT_EQ(block.runs_begin, next_run);
    const auto at_home = [&](std::uint32_t i) { return i >= block.begin && i < block.end; };
    for (std::uint32_t r = block.runs_begin; r < block.runs_end; ++r) {
      const PairRun& run = list.runs()[r];
      EXPECT_EQ(run.begin, next);
      const bool crosses = run.crossing != within_block;
      EXPECT_TRUE(!crosses || run.crossing == crossings);
      bool imaged = false;
      for (std::uint32_t p = run.begin; p < run.end; ++p) {
        const Pair& pair = list.pairs()[p];
        EXPECT_EQ(pair.kind, run.kind);
        EXPECT_EQ(at_home(pair.first), !run.first_is_away);
        EXPECT_EQ(at_home(pair.second), !crosses || run.first_is_away);
        imaged = imaged || pair.image != 0;
        if (!crosses) continue;
        const std::uint32_t away = run.first_is_away ? pair.first : pair.second;
        EXPECT_LT(away, block.begin);  // in an earlier block
        outgoing.emplace(away, crossings++);
      }
      EXPECT_EQ(imaged, run.imaged);
      next = run.end;
    }
    for (std::uint32_t k = block.incoming_begin; k < block.incoming_end; ++k) {
      EXPECT_TRUE(at_home(list.incoming()[k].particle));
      EXPECT_TRUE(incoming.emplace(list.incoming()[k].particle, list.incoming()[k].crossing).second);
    }
    next_run = block.runs_end;
    next_particle = block.end;
  }
  EXPECT_EQ(next, list.pairs().size());
  EXPECT_EQ(next_run, list.runs().size());
  EXPECT_EQ(crossings, list.crossings());
  EXPECT_EQ(incoming, outgoing);
  EXPECT_EQ(list.images().front(), LatticeShift{});
}

TEST(NeighbourList, IsArrangedInBlocksAndRunsOfOneKind) {
  Draws draws(13);
  const PeriodicCell box({7, 7, 7}, Matrix3{});
  const ParticleState particles = scattered(50, {1, 1.4}, box, draws);
  const NeighbourList list = list_of(particles, box, 0.05);
  EXPECT_EQ(list.blocks().size(), 1u);
  expect_arranged(list);
}

// Particles in any order: most pairs cross between blocks, and some are found from the second particle.
TEST(NeighbourList, HoldsEveryPairOfSeveralBlocksOnAnyNumberOfThreads) {
  Draws draws(16);
  const PeriodicCell box({22, 21, 23}, simple_shear(1), 4);
  ParticleState particles = scattered(2 * most_particles_per_block + 100, {0.5, 0.7}, box, draws);
  std::reverse(particles.id.begin(), particles.id.begin() + 1000);
  NeighbourList one(ranges_of(particles.radius), 0.05), two = one;
  one.build(particles, box);
  EXPECT_EQ(one.blocks().size(), 4u);
  EXPECT_GT(one.crossings(), 1000u);
  expect_arranged(one);
  std::vector<SeenPair> expected = near_with_skin(particles, box, 0.05);
  for (SeenPair& pair : expected) {
    if (particles.id[pair.first] > particles.id[pair.second]) {
      std::swap(pair.first, pair.second);
      pair.image = LatticeShift{} - pair.image;
    }
  }
  std::sort(expected.begin(), expected.end(), by_name);
  EXPECT_EQ(listed(one), expected);
  two.build(particles, box, 2);
  ASSERT_EQ(one.pairs().size(), two.pairs().size());
  EXPECT_EQ(std::memcmp(one.pairs().data(), two.pairs().data(), one.pairs().size() * sizeof(Pair)), 0);
}

TEST(NeighbourList, RefusesAParticleThatInteractsWithItsOwnImage) {
  const PeriodicCell box({5, 2, 5}, Matrix3{});
  const ParticleState particles = make_particles({1}, 1);
  NeighbourList list(ranges_of(particles.radius), 0.05);
  EXPECT_THROW(list.build(particles, box), std::invalid_argument);
}

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
  NeighbourList list = list_of(particles, box, 0.15);
  int checks = 0;
  for (int step = 0; step < 400; ++step) {
    move(particles, box, 0.0025, 0.008, draws);
    if (!list.holds(particles, box)) {
      list.build(particles, box);
      continue;
    }
    ++checks;
    std::set<std::tuple<std::uint32_t, std::uint32_t, LatticeShift>> names;
    for (const SeenPair& pair : listed(list)) names.emplace(pair.first, pair.second, pair.image);
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
    const NeighbourList list = list_of(particles, box, skin);
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
  const NeighbourList list = list_of(particles, box, 0.15);
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
    ASSERT_EQ(listed(list), near_with_skin(particles, box, skin)) << step;
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
    const Pair &a = again.pairs()[p], &b = list.pairs()[p];
    EXPECT_TRUE(a.first == b.first && a.second == b.second && a.image == b.image && a.kind == b.kind) << p;
  }
  EXPECT_EQ(again.images(), list.images());
  EXPECT_EQ(again.listed().displacement_gradient, list.listed().displacement_gradient);
  EXPECT_EQ(again.allowed_displacement(box), list.allowed_displacement(box));
  EXPECT_EQ(again.largest_displacement(particles, box), list.largest_displacement(particles, box));
  EXPECT_EQ(again.can_narrow(particles, box), list.can_narrow(particles, box));
}

}  // namespace
}  // namespace peclet::engine
