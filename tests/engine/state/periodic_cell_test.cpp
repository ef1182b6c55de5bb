#include "engine/state/periodic_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/state/particles.h"
#include "tests/engine/components.h"
#include "tests/engine/draws.h"
#include "tests/engine/every_image.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.7;

// Returns a cell of these lengths in shear, tilted by `tilt`.
PeriodicCell sheared_cell(double tilt = 0) { return {{10, 8, 6}, simple_shear(rate), tilt}; }

TEST(PeriodicCell, TiltGrowsWithTheStrain) {
  PeriodicCell box = sheared_cell(1);
  box.deform(simple_shear(0.25));
  EXPECT_DOUBLE_EQ(box.tilt(), 1 + 0.25 * 8);
  EXPECT_DOUBLE_EQ(box.volume(), 480);
}

// Returns a gradient without trace, of a flow of constant density.
Matrix3 any_gradient(Draws& draws) {
  Matrix3 gradient{draws.vector(), draws.vector(), draws.vector()};
  gradient.column[2].z = -gradient.column[0].x - gradient.column[1].y;
  return gradient;
}

// Returns a cell with edges of about 10, far from right angles, right- or left-handed.
PeriodicCell any_cell(Draws& draws) {
  Matrix3 edges = 10 * identity() + Matrix3{draws.vector(3), draws.vector(3), draws.vector(3)};
  if (draws.vector().x < 0) std::swap(edges.column[0], edges.column[1]);
  return PeriodicCell::with_edges(edges, any_gradient(draws));
}

// Returns a change of basis composed of six shears along any axes.
BasisChange any_change(Draws& draws) {
  BasisChange change;
  for (int k = 0; k < 6; ++k) {
    BasisChange one;
    const Vector3 v = draws.vector(2);
    const auto to = static_cast<std::size_t>(k % 3), from = static_cast<std::size_t>((k + 1 + (v.x > 0)) % 3);
    one.column[to] = one.column[to] + static_cast<std::int32_t>(std::round(v.y)) * one.column[from];
    if (v.z > 1) std::swap(one.column[to], one.column[from]);
    change = change * one;
  }
  return change;
}

TEST(PeriodicCell, AnotherBasisIsOneOfTheSameLattice) {
  Draws draws(1);
  for (int n = 0; n < 20; ++n) {
    const PeriodicCell box = any_cell(draws);
    const BasisChange change = any_change(draws);
    PeriodicCell other = box;
    other.change_basis(change);
    EXPECT_EQ(other.displacement_gradient(), box.displacement_gradient());
    EXPECT_NEAR(other.volume(), box.volume(), 1e-9 * box.volume());
    for (std::int32_t x = -2; x <= 2; ++x) {
      for (std::int32_t y = -2; y <= 2; ++y) {
        const LatticeShift old = {x, y, 1}, renamed = change.after(old);
        EXPECT_EQ(change.before(renamed), old);
        expect_near(other.displacement(renamed), box.displacement(old), 1e-10);
        expect_near(other.velocity(renamed), box.velocity(old), 1e-10);
      }
    }
  }
}

TEST(PeriodicCell, AFlipTakesBackTheTilt) {
  for (const std::int32_t count : {-2, -1, 1, 3}) {
    PeriodicCell box = sheared_cell(1);
    box.deform(simple_shear(0.9));
    PeriodicCell flipped = box;
    flipped.change_basis(flips(count));
    EXPECT_DOUBLE_EQ(flipped.tilt(), box.tilt() - 10 * count);
  }
}

TEST(PeriodicCell, DueFlipsBringTheTiltNextToZero) {
  for (const double strain : {-3.3, -0.63, -0.62, 0.0, 0.6, 0.63, 1.2, 7.77}) {
    PeriodicCell box = sheared_cell();
    box.deform(simple_shear(strain));
    const auto count = static_cast<std::int32_t>(std::floor(strain * 8 / 10 + 0.5));
    EXPECT_EQ(box.due_change(), flips(count)) << strain;
    box.change_basis(box.due_change());
    EXPECT_GE(box.tilt(), -5) << strain;
    EXPECT_LT(box.tilt(), 5) << strain;
  }
}

TEST(PeriodicCell, ImagesMoveAsTheFlowDoesWhereTheyAre) {
  const PeriodicCell box = sheared_cell(1);
  expect_near(box.velocity({3, -2, 1}), {-2 * 8 * rate, 0, 0}, 1e-14);
  Draws draws(2);
  for (int n = 0; n < 20; ++n) {
    const PeriodicCell cell = any_cell(draws);
    const LatticeShift k = {1, -3, 2};
    expect_near(cell.velocity(k), cell.velocity_gradient() * cell.displacement(k), 1e-12);
  }
}

// dH/dt = L H: images move by their velocities over a short time.
TEST(PeriodicCell, ImagesGoWhereTheirVelocitiesLead) {
  Draws draws(3);
  const double time = 1e-6;
  for (int n = 0; n < 20; ++n) {
    const PeriodicCell before = any_cell(draws);
    PeriodicCell after = before;
    after.deform(time * before.velocity_gradient());
    for (const LatticeShift k : {LatticeShift{1, 0, 0}, {0, 1, 0}, {-2, 1, 3}}) {
      const Vector3 way = after.displacement(k) - before.displacement(k);
      expect_near((1 / time) * way, before.velocity(k), 1e-7);
    }
  }
}

// F = diag(e, 1/e, 1), planar extension, and simple shear in each plane.
TEST(PeriodicCell, KeepsItsVolumeInAFlowOfConstantDensity) {
  Draws draws(4);
  for (int n = 0; n < 10; ++n) {
    PeriodicCell box = any_cell(draws);
    const double volume = std::abs(determinant(box.edges()));
    EXPECT_NEAR(box.volume(), volume, 1e-12 * volume);
    const double e = std::exp(0.3 * n);
    box.deform({Vector3{e - 1, 0, 0}, Vector3{0, 1 / e - 1, 0}, Vector3{}});
    EXPECT_NEAR(box.volume(), volume, 1e-12 * volume);
    box.deform({Vector3{0, 0, 0.4 * n}, Vector3{}, Vector3{}});
    EXPECT_NEAR(box.volume(), volume, 1e-12 * volume);
  }
}

TEST(PeriodicCell, FractionalCoordinatesAreAlongTheLatticeVectors) {
  const PeriodicCell box = sheared_cell(3);
  const Vector3 point = 0.2 * Vector3{10, 0, 0} + 0.7 * Vector3{3, 8, 0} + 0.4 * Vector3{0, 0, 6};
  expect_near(box.frame().fractional(point), {0.2, 0.7, 0.4}, 1e-15);
  Draws draws(5);
  for (int n = 0; n < 20; ++n) {
    const PeriodicCell cell = any_cell(draws);
    const Vector3 place = draws.vector();
    expect_near(cell.frame().fractional(cell.point_at(place)), place, 1e-13);
    // Reciprocal vectors g_a: g_a . A_b is 1 for a = b and 0 otherwise.
    const Vector3 zero = cell.frame().fractional({});
    for (std::size_t b = 0; b < 3; ++b) {
      const Vector3 along = cell.frame().fractional(cell.edges().column[b]) - zero;
      expect_near(along, identity().column[b], 1e-13);
    }
  }
}

TEST(PeriodicCell, WidthsAreTheDistancesBetweenFaces) {
  const PeriodicCell box = sheared_cell(3);
  // Volume over the area of the face: |A2 x A3| = 6 sqrt(9 + 64), |A1 x A3| = 60, |A1 x A2| = 80.
  expect_near(box.frame().widths(), {480 / (6 * std::sqrt(73.0)), 8, 6}, 1e-14);
  Draws draws(6);
  for (int n = 0; n < 20; ++n) {
    const PeriodicCell cell = any_cell(draws);
    const auto& [a, b, c] = cell.edges().column;
    const double volume = std::abs(determinant(cell.edges()));
    expect_near(cell.frame().widths(),
                {volume / norm(cross(b, c)), volume / norm(cross(c, a)), volume / norm(cross(a, b))}, 1e-12);
  }
}

// A square lattice turned by atan(2) / 2 recurs after planar extension by ln((3 + sqrt 5) / 2): Kraynik and
// Reinelt (1992), Int. J. Multiphase Flow 18, 1045. Its points m, n have |x y| = edge^2 |m^2 + m n - n^2| /
// sqrt 5, invariant under extension and at least edge^2 / sqrt 5. Hence every vector is at least
// sqrt(2 |x y|) >= sqrt(2 / sqrt 5) edge long, with equality for an edge of the square after one and three
// quarters of the period, where |x| = |y|. A compact cell is at least 3/4 of that wide.
TEST(PeriodicCell, IsMadeCompactInExtension) {
  const double edge = 7, angle = 0.5 * std::atan(2.0), period = std::log(0.5 * (3 + std::sqrt(5.0)));
  const double least = std::sqrt(2 / std::sqrt(5.0)) * edge;
  const Matrix3 square = {Vector3{edge * std::cos(angle), edge * std::sin(angle), 0},
                          Vector3{-edge * std::sin(angle), edge * std::cos(angle), 0}, Vector3{0, 0, edge}};
  const Matrix3 extension = {Vector3{1, 0, 0}, Vector3{0, -1, 0}, Vector3{}};
  for (const double share : {0.0, 0.1, 0.25, 0.3, 0.5, 0.7, 0.75, 0.9, 1.0, 2.0, 2.5, 5.0}) {
    PeriodicCell box = PeriodicCell::with_edges(square, extension);
    const double e = std::exp(share * period);
    box.deform({Vector3{e - 1, 0, 0}, Vector3{0, 1 / e - 1, 0}, Vector3{}});
    box.change_basis(box.due_change());
    const auto& [a, b, c] = box.edges().column;
    EXPECT_NEAR(norm(c), edge, 1e-12);
    EXPECT_NEAR(std::abs(determinant(box.edges())), edge * edge * edge, 1e-9);
    const Vector3 widths = box.frame().widths();
    const double shortest = std::min(norm(a), norm(b));
    EXPECT_GT(shortest, (1 - 1e-9) * least) << share;
    if (share == 0.25 || share == 0.75) {
      EXPECT_NEAR(shortest, least, 1e-9) << share;
    }
    EXPECT_GT(std::min({widths.x, widths.y, widths.z}), 0.75 * least) << share;
    if (share == std::floor(share)) {
      EXPECT_NEAR(norm(a), edge, 1e-9) << share;
      EXPECT_NEAR(norm(b), edge, 1e-9) << share;
      EXPECT_NEAR(dot(a, b), 0, 1e-8) << share;
    }
  }
}

struct Suspension {
  PeriodicCell box;
  ParticleState particles;
};

Suspension outside_the_cell() {
  Draws draws(3);
  Suspension s{PeriodicCell({6, 5, 7}, simple_shear(rate), 2.4),
               make_particles(std::vector<double>(30, 1.0), 1)};
  for (std::size_t i = 0; i < 30; ++i) {
    s.particles.position.set(i, draws.vector(40));
    s.particles.velocity.set(i, draws.vector());
  }
  return s;
}

Suspension wrapped(Suspension s) {
  wrap_into_cell(s.particles, s.box);
  return s;
}

TEST(Wrapping, PutsEveryParticleIntoTheCell) {
  const Suspension s = wrapped(outside_the_cell());
  for (std::size_t i = 0; i < 30; ++i) {
    const Vector3 place = s.box.frame().fractional(s.particles.position[i]);
    for (const double coordinate : {place.x, place.y, place.z}) {
      EXPECT_GE(coordinate, -1e-14);
      EXPECT_LE(coordinate, 1 + 1e-14);
    }
  }
}

// Returns separations and relative velocities of all pairs in all images, in an order without image names.
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
  expect_same_motions(outside_the_cell(), wrapped(outside_the_cell()));
}

TEST(Wrapping, AfterAFlipChangesNoSeparationAndNoRelativeVelocity) {
  for (const std::int32_t count : {-1, 1, 2}) {
    Suspension after = outside_the_cell();
    after.box.change_basis(flips(count));
    expect_same_motions(outside_the_cell(), wrapped(after));
  }
}

TEST(Wrapping, CountsWhatItRemoved) {
  const Suspension before = outside_the_cell(), after = wrapped(before);
  for (std::size_t i = 0; i < 30; ++i) {
    expect_near(after.particles.position[i] + after.box.displacement(after.particles.image[i]),
                before.particles.position[i], 1e-12);
  }
}

// The velocity changes with the height by that of the flow, so drag is unchanged.
TEST(Wrapping, KeepsTheVelocityRelativeToTheStreamingFlow) {
  const Suspension before = outside_the_cell(), after = wrapped(before);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(after.particles.velocity[i].x - rate * after.particles.position[i].y,
                before.particles.velocity[i].x - rate * before.particles.position[i].y, 1e-12 * 40);
  }
}

}  // namespace
}  // namespace peclet::engine
