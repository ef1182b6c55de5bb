// Seeds are fixed, so each claim is reproducible. A statistic may deviate by five standard errors of an ideal
// generator: one of the hundred comparisons would fail for a fraction of 6e-5 of the seeds.
#include "engine/terms/keyed_random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numbers>

#include "engine/terms/fill_normals.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/bits.h"

namespace peclet::engine {
namespace {

constexpr double allowed = 5;  // standard errors

std::array<double, 6> components(const NormalPair& pair) {
  return {pair.first.x, pair.first.y, pair.first.z, pair.second.x, pair.second.y, pair.second.z};
}

struct Moments {
  double count = 0, first = 0, second = 0, third = 0, fourth = 0;

  void add(double x) { ++count, first += x, second += x * x, third += x * x * x, fourth += x * x * x * x; }
};

// Expected: E x = 0, E x^2 = 1, E x^3 = 0, E x^4 = 3, with variances 1, 2, 15, 96 per draw.
void expect_normal(const Moments& m, const std::string& what) {
  EXPECT_NEAR(m.first / m.count, 0, allowed * std::sqrt(1 / m.count)) << what;
  EXPECT_NEAR(m.second / m.count, 1, allowed * std::sqrt(2 / m.count)) << what;
  EXPECT_NEAR(m.third / m.count, 0, allowed * std::sqrt(15 / m.count)) << what;
  EXPECT_NEAR(m.fourth / m.count, 3, allowed * std::sqrt(96 / m.count)) << what;
}

TEST(KeyedRandom, NormalsHaveTheMomentsOfTheNormalDistribution) {
  const KeyedRandom random(1, Purpose::one_body_noise);
  std::array<Moments, 6> moments;
  for (std::uint64_t step = 0; step < 500; ++step) {
    for (std::uint32_t particle = 0; particle < 500; ++particle) {
      const auto normals = components(random.normals(step, particle));
      for (std::size_t k = 0; k < 6; ++k) moments[k].add(normals[k]);
    }
  }
  for (std::size_t k = 0; k < 6; ++k) expect_normal(moments[k], "component " + std::to_string(k));
}

TEST(KeyedRandom, TailsAreThoseOfTheNormalDistribution) {
  const KeyedRandom random(2, Purpose::pair_noise);
  constexpr double draws = 3e5 * 6;
  std::array<double, 3> beyond{};
  for (std::uint32_t particle = 0; particle < 300000; ++particle) {
    for (const double x : components(random.normals(0, particle, particle + 1, {}))) {
      for (int k = 0; k < 3; ++k) beyond[static_cast<std::size_t>(k)] += std::abs(x) > 2 + k ? 1 : 0;
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double expected = draws * std::erfc((2 + k) / std::sqrt(2.0));
    EXPECT_NEAR(beyond[static_cast<std::size_t>(k)], expected, allowed * std::sqrt(expected)) << 2 + k;
  }
}

// Compares all six numbers of a key with each other, and each with its counterpart of the neighbouring key.
TEST(KeyedRandom, NeighbouringKeysAreIndependent) {
  const KeyedRandom here(3, Purpose::pair_noise), next_seed(4, Purpose::pair_noise),
      other_purpose(3, Purpose::one_body_noise);
  const auto particle = [](const KeyedRandom& random, std::uint64_t step, std::uint32_t i) {
    return components(random.normals(step, i));
  };
  const auto image = [&](std::uint64_t step, std::uint32_t i, std::int32_t x) {
    return components(here.normals(step, i, i + 1, {x, 0, 0}));
  };
  const std::array<std::function<std::array<double, 6>(std::uint64_t, std::uint32_t)>, 7> neighbours = {
      [&](auto step, auto i) { return particle(here, step + 1, i); },
      [&](auto step, auto i) { return particle(here, step, i + 1); },
      [&](auto step, auto i) { return particle(next_seed, step, i); },
      [&](auto step, auto i) { return particle(other_purpose, step, i); },
      [&](auto step, auto i) { return image(step, i, 0); },
      [&](auto step, auto i) { return image(step, i, 1); },
      [&](auto step, auto i) { return image(step, i, -1); }};
  std::array<std::array<double, 6>, 7> products{};
  std::array<std::array<double, 6>, 6> within{};
  constexpr double keys = 200.0 * 200.0;
  for (std::uint64_t step = 0; step < 200; ++step) {
    for (std::uint32_t i = 0; i < 200; ++i) {
      const auto x = particle(here, step, i);
      for (std::size_t n = 0; n < 7; ++n) {
        const auto y = neighbours[n](step, i);
        for (std::size_t k = 0; k < 6; ++k) products[n][k] += x[k] * y[k];
      }
      for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t l = 0; l < k; ++l) within[k][l] += x[k] * x[l];
      }
    }
  }
  for (std::size_t n = 0; n < 7; ++n) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(products[n][k] / keys, 0, allowed / std::sqrt(keys)) << n << ' ' << k;
      for (std::size_t l = 0; l < k; ++l) {
        EXPECT_NEAR(within[k][l] / keys, 0, allowed / std::sqrt(keys));
      }
    }
  }
}

// In a small box a sphere meets several images of another, each of which needs independent noise.
TEST(KeyedRandom, EveryImageOfAPairHasItsOwnNoise) {
  const KeyedRandom random(3, Purpose::pair_noise);
  std::map<double, LatticeShift> seen;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const auto [same, is_new] =
            seen.try_emplace(random.normals(7, 1, 2, {x, y, z}).first.x, LatticeShift{x, y, z});
        EXPECT_TRUE(is_new) << x << ' ' << y << ' ' << z << " has the noise of " << same->second.x << ' '
                            << same->second.y << ' ' << same->second.z;
      }
    }
  }
}

TEST(KeyedRandom, EveryPartOfTheKeyCounts) {
  const auto x = [](std::uint64_t of_seed, Purpose purpose, std::uint64_t step, std::uint32_t i,
                    std::uint32_t j, const LatticeShift& image) {
    return KeyedRandom(of_seed, purpose).normals(step, i, j, image).first.x;
  };
  constexpr auto pair = Purpose::pair_noise;
  const double reference = x(3, pair, 7, 1, 2, {0, 1, 0});
  EXPECT_EQ(reference, x(3, pair, 7, 1, 2, {0, 1, 0}));
  const double others[] = {x(4, pair, 7, 1, 2, {0, 1, 0}),
                           x(3, Purpose::one_body_noise, 7, 1, 2, {0, 1, 0}),
                           x(3, Purpose::initial_velocity, 7, 1, 2, {0, 1, 0}),
                           x(3, Purpose::packing, 7, 1, 2, {0, 1, 0}),
                           x(3, pair, 8, 1, 2, {0, 1, 0}),
                           x(3, pair, 7, 0, 2, {0, 1, 0}),
                           x(3, pair, 7, 1, 3, {0, 1, 0}),
                           x(3, pair, 7, 2, 1, {0, 1, 0}),
                           x(3, pair, 7, 1, 2, {0, -1, 0}),
                           x(3, pair, 7, 1, 2, {1, 0, 0}),
                           x(3, pair, 7, 1, 2, {0, 0, 1}),
                           x(3, pair, 7, 1, 2, {0, 0, 0}),
                           x(3, pair, 1ull << 40, 1, 2, {0, 1, 0}),
                           x(3ull + (1ull << 40), pair, 7, 1, 2, {0, 1, 0})};
  for (const double other : others) EXPECT_NE(reference, other);
}

// Mean 1/2, variance 1/12; the fourth central moment 1/80 gives the square a variance of 1/180.
TEST(KeyedRandom, UniformsFillTheUnitCubeEvenly) {
  const KeyedRandom random(5, Purpose::packing);
  constexpr std::uint32_t count = 200000;
  double sum = 0, square = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3 u = random.uniforms(0, i);
    for (const double x : {u.x, u.y, u.z}) {
      ASSERT_GT(x, 0);
      ASSERT_LT(x, 1);
      sum += x;
      square += (x - 0.5) * (x - 0.5);
    }
  }
  constexpr double all = 3.0 * count;
  EXPECT_NEAR(sum / all, 0.5, allowed * std::sqrt(1 / (12 * all)));
  EXPECT_NEAR(square / all, 1.0 / 12, allowed * std::sqrt(1 / (180 * all)));
}

// The two factors of the variance, E r^2 = 2 and E cos^2 = 1/2, as sums over all representable uniforms. The
// midpoint rule is off by ln 2 times their spacing for E r^2, 3.3e-7.
TEST(BoxMuller, VarianceIsExactToAMillionth) {
  constexpr std::uint32_t points = 1U << 21;
  double radius_squared = 0, cosine_squared = 0, sine_squared = 0, product = 0, mean = 0;
  for (std::uint32_t k = 0; k < points; ++k) {
    radius_squared += -2.0 * static_cast<double>(logarithm_of_uniform(k));
    float cosine = 0, sine = 0;
    circle(k, cosine, sine);
    cosine_squared += static_cast<double>(cosine) * static_cast<double>(cosine);
    sine_squared += static_cast<double>(sine) * static_cast<double>(sine);
    product += static_cast<double>(cosine) * static_cast<double>(sine);
    mean += static_cast<double>(cosine) + static_cast<double>(sine);
  }
  EXPECT_NEAR(radius_squared / points, 2, 1e-6);
  EXPECT_NEAR(cosine_squared / points, 0.5, 5e-7);
  EXPECT_NEAR(sine_squared / points, 0.5, 5e-7);
  EXPECT_NEAR(product / points, 0, 1e-6);
  EXPECT_NEAR(mean / points, 0, 1e-6);
}

// Compared with the standard library in double precision, for all representable uniforms.
TEST(BoxMuller, LogarithmAndCircleAreThoseOfSinglePrecision) {
  for (std::uint32_t k = 0; k < 1U << 21; ++k) {
    const double u = (k + 0.5) / (1U << 21), angle = 2 * std::numbers::pi * k / (1U << 21);
    ASSERT_NEAR(static_cast<double>(logarithm_of_uniform(k)) / std::log(u), 1, 2e-7) << k;
    float cosine = 0, sine = 0;
    circle(k, cosine, sine);
    ASSERT_NEAR(static_cast<double>(cosine), std::cos(angle), 1.5e-7) << k;
    ASSERT_NEAR(static_cast<double>(sine), std::sin(angle), 1.5e-7) << k;
  }
}

TEST(BoxMuller, IsFiniteAtBothEnds) {
  EXPECT_NEAR(static_cast<double>(logarithm_of_uniform(0)), -22 * std::log(2.0), 1e-5);
  EXPECT_LT(logarithm_of_uniform((1U << 21) - 1), 0);
}

// Published known answers of Threefry-2x64-20 for key and counter of zeros and of ones. They enter the
// normals as fields of 21 bits.
TEST(NormalBlock, IsMadeOfTheWordsOfThreefry) {
  std::uint64_t identity[identities_per_block] = {}, low[identities_per_block], high[identities_per_block];
  draw_words({}, identity, identity, low, high);
  EXPECT_EQ(low[0], 0xc2b6e3a8c2c69865U);
  EXPECT_EQ(high[0], 0x6f81ed42f350084dU);
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  std::fill(std::begin(identity), std::end(identity), ones);
  draw_words({.seed = ones, .purpose = 0, .step = ones}, identity, identity, low, high);
  EXPECT_EQ(low[0], 0xe02cb7c4d95d277aU);
  EXPECT_EQ(high[0], 0xd06633d0893b8b68U);
}

// Returns the normals of eight particles for a part of a step.
NormalBlock normals_of_part(std::uint64_t step, std::uint64_t part) {
  const std::uint64_t identity[identities_per_block] = {0, 1, 2, 3, 4, 5, 6, 7};
  NormalBlock block;
  baseline::fill_normals({11, 3, step, part}, identity, nullptr, block);
  return block;
}

// sqrt(dt/2) (z_2p + z_2p+1) = sqrt(dt) z_p, down to the smallest parts. Halves are standard normal, and
// independent of each other and of other parts.
TEST(NormalBlock, HalvesOfAPartRefineItsPath) {
  std::map<std::uint64_t, Moments> moments;
  std::map<std::pair<std::uint64_t, std::uint64_t>, double> products;
  const std::pair<std::uint64_t, std::uint64_t> apart[] = {{2, 3}, {4, 5}, {4, 6}, {5, 7}, {1022, 1023}};
  constexpr std::uint64_t steps = 4000;
  for (std::uint64_t step = 0; step < steps; ++step) {
    std::map<std::uint64_t, NormalBlock> of_part;
    for (const std::uint64_t part : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 511U, 1022U, 1023U}) {
      of_part[part] = normals_of_part(step, part);
    }
    const auto value = [&](std::uint64_t part, int entry) {
      return static_cast<double>(of_part[part].value[entry % 6][entry / 6]);
    };
    for (int entry = 0; entry < 6 * identities_per_block; ++entry) {
      const auto z = [&](std::uint64_t part) { return value(part, entry); };
      for (const std::uint64_t part : {1U, 2U, 3U, 511U}) {
        ASSERT_NEAR(std::sqrt(0.5) * (z(2 * part) + z(2 * part + 1)), z(part), 2e-6) << part;
      }
      for (const std::uint64_t part : {2U, 3U, 5U, 7U, 1023U}) moments[part].add(z(part));
      for (const auto& [a, b] : apart) products[{a, b}] += z(a) * z(b);
    }
  }
  for (const auto& [part, of_part] : moments) expect_normal(of_part, "part " + std::to_string(part));
  constexpr double count = steps * 6 * identities_per_block;
  for (const auto& [parts, sum] : products) {
    EXPECT_NEAR(sum / count, 0, allowed / std::sqrt(count)) << parts.first << ' ' << parts.second;
  }
}

TEST(NormalBlock, HasTheSameBitsOnEveryInstructionSet) {
  for (const InstructionSet set : newer_sets()) {
    for (std::uint64_t step = 0; step < 20000; ++step) {
      std::uint64_t identity[identities_per_block], image[identities_per_block];
      for (std::uint64_t k = 0; k < identities_per_block; ++k) {
        identity[k] = step * 8 + k;
        image[k] = k % 3;
      }
      NormalBlock one, other;
      const NoiseKey key = {7, 3, step, 1 + step % 37};
      baseline::fill_normals(key, identity, image, one);
      fill_normals(set)(key, identity, image, other);
      ASSERT_EQ(bits_of(one), bits_of(other)) << name_of(set) << ' ' << step;
    }
  }
}

}  // namespace
}  // namespace peclet::engine
