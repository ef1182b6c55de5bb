#include "engine/realisation/packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/state/neighbour_list.h"

namespace peclet::engine {
namespace {

Particles equal_volumes(std::size_t count) {
  Particles particles;
  particles.count = count;
  particles.density = 1;
  particles.species = {{1.0, 0.5}, {1.4, 0.5}};
  return particles;
}

struct Packing {
  ParticleState particles;
  PeriodicCell box;
};

Packing packed(const Particles& wanted, double volume_fraction, std::uint64_t seed) {
  const std::vector<double> radius = species_radii(wanted);
  const double edge = cube_edge(radius, volume_fraction);
  Packing packing{make_particles(radius, wanted.density), PeriodicCell({edge, edge, edge}, Matrix3{})};
  place_randomly(packing.particles, packing.box, seed);
  return packing;
}

// Returns the smallest r / (a_i + a_j) over nearest images; the edge exceeds twice any range in use.
double closest(const Packing& packing) {
  const ParticleState& p = packing.particles;
  const double edge = packing.box.lengths().x;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < p.count(); ++i) {
    for (std::size_t j = i + 1; j < p.count(); ++j) {
      Vector3 r = p.position[j] - p.position[i];
      r = r - edge * Vector3{std::round(r.x / edge), std::round(r.y / edge), std::round(r.z / edge)};
      smallest = std::min(smallest, norm(r) / (p.radius[i] + p.radius[j]));
    }
  }
  return smallest;
}

TEST(Packing, NoTwoSpheresOverlapAtAnyVolumeFractionThatIsPromised) {
  for (const double volume_fraction : {0.3, 0.4, 0.5, 0.55}) {
    EXPECT_GE(closest(packed(equal_volumes(1000), volume_fraction, 1)), 1 + 2e-4) << volume_fraction;
  }
}

TEST(Packing, SixtyPercentIsReachedFromEverySeed) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    EXPECT_GE(closest(packed(equal_volumes(1000), 0.60, seed)), 1 + 2e-4) << seed;
  }
}

TEST(Packing, VolumeFractionIsThatOfTheSpheres) {
  const Packing packing = packed(equal_volumes(100), 0.45, 1);
  double volume = 0;
  for (const double a : packing.particles.radius) volume += 4 * std::numbers::pi / 3 * a * a * a;
  EXPECT_NEAR(volume / packing.box.volume(), 0.45, 1e-12);
}

TEST(Packing, IsAFunctionOfTheSeed) {
  const Packing first = packed(equal_volumes(200), 0.5, 7), again = packed(equal_volumes(200), 0.5, 7),
                other = packed(equal_volumes(200), 0.5, 8);
  EXPECT_EQ(first.particles.position, again.particles.position);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_GT(norm(first.particles.position[i] - other.particles.position[i]), 0);
  }
}

TEST(Packing, SpheresAreAtRest) {
  const Packing packing = packed(equal_volumes(50), 0.5, 1);
  EXPECT_EQ(packing.particles.velocity, VectorField(50));
}

// Radii 1 and 1.4 in equal volumes jam at random between 0.64 and 0.66.
TEST(Packing, WhatCannotBePackedIsRefusedWithTheVolumeFractionReached) {
  try {
    packed(equal_volumes(300), 0.70, 1);
    ADD_FAILURE() << "packed beyond random close packing";
  } catch (const PackingError& error) {
    EXPECT_GT(error.reached(), 0.62);
    EXPECT_LT(error.reached(), 0.66);
    EXPECT_NE(std::string(error.what()).find("0.7000"), std::string::npos) << error.what();
  }
}

// Two equal spheres in a cube are farthest apart in the body-centred lattice, at sqrt(3) / 2 edges. A
// slightly smaller cube is refused, a slightly larger one accepted.
TEST(Packing, AcceptsNoOverlapHoweverSmall) {
  const auto pack_at = [](double distance_over_contact) {
    const double edge = 2 * distance_over_contact / (0.5 * std::sqrt(3.0));
    ParticleState particles = make_particles({1, 1}, 1);
    place_randomly(particles, PeriodicCell({edge, edge, edge}, Matrix3{}), 1);
  };
  for (const double overlap : {0.02, 0.009, 0.003}) {
    EXPECT_THROW(pack_at(1 - overlap), PackingError) << overlap;
  }
  EXPECT_NO_THROW(pack_at(1.01));
}

// Positions, or the volume fraction reached, of eight spheres with all lengths multiplied by `unit`.
struct Scaled {
  VectorField position;
  double reached = 0;
};

Scaled packed_in_units(double unit, double volume_fraction) {
  std::vector<double> radius = {1, 1, 1, 1.5, 1.5, 1, 1, 1.5};
  const double edge = unit * cube_edge(radius, volume_fraction);
  for (double& a : radius) a *= unit;
  ParticleState particles = make_particles(radius, 1);
  try {
    place_randomly(particles, PeriodicCell({edge, edge, edge}, Matrix3{}), 3);
  } catch (const PackingError& error) {
    return {{}, error.reached()};
  }
  return {particles.position, 0};
}

// A power of two changes no rounding, so the packings must agree bit by bit.
TEST(Packing, DoesNotDependOnTheUnitOfLength) {
  constexpr double unit = 0x1p-30;  // nanometres in metres
  const Scaled large = packed_in_units(1, 0.5), small = packed_in_units(unit, 0.5);
  ASSERT_EQ(large.position.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_TRUE(unit * large.position[i] == small.position[i]) << i;
  EXPECT_GT(packed_in_units(1, 0.72).reached, 0.5);
  EXPECT_EQ(packed_in_units(1, 0.72).reached, packed_in_units(unit, 0.72).reached);
}

// Expects these numbers of spheres of each radius.
void expect_numbers(const Particles& particles,
                    const std::vector<std::pair<double, std::ptrdiff_t>>& expected) {
  const std::vector<double> radius = species_radii(particles);
  for (const auto& [a, number] : expected)
    EXPECT_EQ(std::count(radius.begin(), radius.end(), a), number) << a;
}

TEST(SpeciesRadii, EqualVolumesOfAThousandAreThePublishedNumbers) {
  expect_numbers(equal_volumes(1000), {{1.0, 733}, {1.4, 267}});
}

// 65536 of radii 1 and 3 in volumes 1 : 0.25 (Monti et al. 2021): 64935 + 601.
TEST(SpeciesRadii, LargeMixtureIsThePublishedOne) {
  Particles particles = equal_volumes(65536);
  particles.species = {{1.0, 0.8}, {3.0, 0.2}};
  expect_numbers(particles, {{1.0, 64935}, {3.0, 601}});
}

TEST(SpeciesRadii, AreRoundedByLargestRemainders) {
  Particles particles = equal_volumes(10);
  particles.shares = Particles::Shares::number;
  // Exactly 4.4, 3.35 and 2.25; the remaining sphere goes to the first.
  particles.species = {{1.0, 0.44}, {2.0, 0.335}, {3.0, 0.225}};
  expect_numbers(particles, {{1.0, 5}, {2.0, 3}, {3.0, 2}});
}

}  // namespace
}  // namespace peclet::engine
