#include "engine/state/sheared_box.h"

#include <gtest/gtest.h>

#include "engine/state/particles.h"
#include "tests/engine/draws.h"
#include "tests/engine/every_image.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.7;

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(ShearedBox, TiltGrowsWithTheStrain) {
  ShearedBox box({10, 8, 6}, rate, 1);
  box.set_strain(0.25);
  EXPECT_DOUBLE_EQ(box.tilt(), 1 + 0.25 * 8);
  EXPECT_DOUBLE_EQ(box.volume(), 480);
}

TEST(ShearedBox, AFlipChoosesAnotherBasisOfTheSameLattice) {
  for (const std::int32_t count : {-2, -1, 1, 3}) {
    ShearedBox box({10, 8, 6}, rate, 1);
    box.set_strain(0.9);
    ShearedBox flipped = box;
    flipped.flip(count);
    EXPECT_DOUBLE_EQ(flipped.tilt(), box.tilt() - 10 * count);
    EXPECT_EQ(flipped.strain(), box.strain());
    for (std::int32_t x = -2; x <= 2; ++x) {
      for (std::int32_t y = -2; y <= 2; ++y) {
        const LatticeShift old = {x, y, 1}, rebased = ShearedBox::rebased(old, count);
        expect_near(flipped.displacement(rebased), box.displacement(old), 1e-13);
        EXPECT_EQ(flipped.velocity_offset(rebased), box.velocity_offset(old));
      }
    }
  }
}

TEST(ShearedBox, DueFlipsBringTheTiltNextToZero) {
  for (const double strain : {-3.3, -0.63, -0.62, 0.0, 0.6, 0.63, 1.2, 7.77}) {
    ShearedBox box({10, 8, 6}, rate);
    box.set_strain(strain);
    box.flip(box.due_flips());
    EXPECT_GE(box.tilt(), -5) << strain;
    EXPECT_LT(box.tilt(), 5) << strain;
  }
}

TEST(ShearedBox, ImagesMoveAsTheStreamingFlowDoesAtTheirHeight) {
  const ShearedBox box({10, 8, 6}, rate, 1);
  EXPECT_DOUBLE_EQ(box.velocity_offset({3, -2, 1}), -2 * 8 * rate);
}

TEST(ShearedBox, FractionalCoordinatesAreAlongTheLatticeVectors) {
  const ShearedBox box({10, 8, 6}, rate, 3);
  const Vector3 point = 0.2 * Vector3{10, 0, 0} + 0.7 * Vector3{3, 8, 0} + 0.4 * Vector3{0, 0, 6};
  expect_near(box.fractional(point), {0.2, 0.7, 0.4}, 1e-15);
}

TEST(ShearedBox, WidthsAreTheDistancesBetweenFaces) {
  const ShearedBox box({10, 8, 6}, rate, 3);
  // Volume over the area of the face: |A2 x A3| = 6 sqrt(9 + 64), |A1 x A3| = 60, |A1 x A2| = 80.
  expect_near(box.widths(), {480 / (6 * std::sqrt(73.0)), 8, 6}, 1e-14);
}

struct Suspension {
  ShearedBox box;
  ParticleState particles;
};

Suspension outside_the_cell() {
  Draws draws(3);
  Suspension s{ShearedBox({6, 5, 7}, rate, 2.4), make_particles(std::vector<double>(30, 1.0), 1)};
  for (std::size_t i = 0; i < 30; ++i) {
    s.particles.position.set(i, draws.vector(40));
    s.particles.velocity.set(i, draws.vector());
  }
  return s;
}

TEST(Wrapping, PutsEveryParticleIntoTheCell) {
  Suspension s = outside_the_cell();
  wrap_into_cell(s.particles, s.box);
  for (std::size_t i = 0; i < 30; ++i) {
    const Vector3 place = s.box.fractional(s.particles.position[i]);
    for (const double coordinate : {place.x, place.y, place.z}) {
      EXPECT_GE(coordinate, -1e-14);
      EXPECT_LE(coordinate, 1 + 1e-14);
    }
  }
}

// Separations and relative velocities of all pairs in all images, sorted so that names of images do not
// matter.
std::vector<std::array<double, 8>> relative_motions(const Suspension& s) {
  std::vector<std::array<double, 8>> motions;
  for (const SeenPair& pair : every_image(s.particles.position, s.box.lengths(), s.box.tilt(),
                                          [](std::uint32_t, std::uint32_t) { return 2.5; })) {
    Vector3 u = s.particles.velocity[pair.second] - s.particles.velocity[pair.first];
    u.x += rate * 5 * pair.image.y;
    const Vector3 r = pair.separation;
    motions.push_back(
        {double(pair.first), double(pair.second), std::round(1e6 * r.x), r.x, r.y, u.x, u.y, u.z});
  }
  std::sort(motions.begin(), motions.end());
  return motions;
}

void expect_same_motions(const Suspension& before, const Suspension& after) {
  const auto a = relative_motions(before), b = relative_motions(after);
  ASSERT_GT(a.size(), 50u);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t c = 0; c < a[k].size(); ++c) {
      EXPECT_NEAR(a[k][c], b[k][c], 1e-12 * 40);  // rounding of coordinates of up to 40
    }
  }
}

TEST(Wrapping, ChangesNoSeparationAndNoRelativeVelocity) {
  const Suspension before = outside_the_cell();
  Suspension after = before;
  wrap_into_cell(after.particles, after.box);
  expect_same_motions(before, after);
}

TEST(Wrapping, AfterAFlipChangesNoSeparationAndNoRelativeVelocity) {
  const Suspension before = outside_the_cell();
  for (const std::int32_t flips : {-1, 1, 2}) {
    Suspension after = before;
    after.box.flip(flips);
    wrap_into_cell(after.particles, after.box);
    expect_same_motions(before, after);
  }
}

TEST(Wrapping, CountsWhatItRemoved) {
  const Suspension before = outside_the_cell();
  Suspension after = before;
  wrap_into_cell(after.particles, after.box);
  for (std::size_t i = 0; i < 30; ++i) {
    expect_near(after.particles.position[i] + after.box.displacement(after.particles.image[i]),
                before.particles.position[i], 1e-12);
  }
}

// The particle leaves the streaming flow's velocity behind with the height: drag does not notice.
TEST(Wrapping, KeepsTheVelocityRelativeToTheStreamingFlow) {
  const Suspension before = outside_the_cell();
  Suspension after = before;
  wrap_into_cell(after.particles, after.box);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(after.particles.velocity[i].x - rate * after.particles.position[i].y,
                before.particles.velocity[i].x - rate * before.particles.position[i].y, 1e-12 * 40);
  }
}

}  // namespace
}  // namespace peclet::engine
