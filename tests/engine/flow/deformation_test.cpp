#include "engine/flow/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/flow/extension.h"
#include "engine/flow/segments.h"
#include "engine/flow/shear.h"

namespace peclet::engine {
namespace {

TEST(SteadyShear, StrainsByItsRateTimesTheTime) {
  for (const double rate : {0.7, -0.5}) {
    const SteadyShear shear(rate);
    EXPECT_EQ(shear.velocity_gradient(3), simple_shear(rate));
    EXPECT_EQ(shear.displacement_gradient(3), simple_shear(rate * 3));
    EXPECT_EQ(shear.largest_rate(), std::abs(rate));
    EXPECT_DOUBLE_EQ(shear.time_of(2 * std::abs(rate), 0), 2);
  }
}

TEST(SteadyShear, AtRestReachesNoStrain) {
  EXPECT_EQ(ImposedFlow().rate(), 0);
  EXPECT_EQ(ImposedFlow().deformation().time_of(1e-3, 0), std::numeric_limits<double>::infinity());
}

TEST(OscillatoryShear, GoesToAndFro) {
  const OscillatoryShear shear(0.2, 3);
  EXPECT_DOUBLE_EQ(shear.largest_rate(), 0.6);
  EXPECT_DOUBLE_EQ(*ImposedFlow(std::make_shared<OscillatoryShear>(shear)).period(),
                   2 * std::numbers::pi / 3);
  for (const double time : {0.0, 0.1, 0.7, 2.0}) {
    EXPECT_DOUBLE_EQ(shear.displacement_gradient(time).column[1].x, 0.2 * std::sin(3 * time));
    const double h = 1e-6;
    const double slope = (shear.displacement_gradient(time + h).column[1].x -
                          shear.displacement_gradient(time - h).column[1].x) /
                         (2 * h);
    EXPECT_NEAR(shear.velocity_gradient(time).column[1].x, slope, 1e-9);
    EXPECT_EQ(shear.velocity_gradient(time), simple_shear(shear.velocity_gradient(time).column[1].x));
  }
}

// Quarter, half and whole cycles have strains of 1, 2 and 4 amplitudes; sin(w t) = 1/2 at a twelfth.
TEST(OscillatoryShear, CountsItsStrainInBothDirections) {
  const OscillatoryShear shear(0.2, 3);
  const double period = 2 * std::numbers::pi / 3;
  for (const auto& [strain, twelfths] : {std::pair{0.1, 1}, {0.2, 3}, {0.3, 5}, {0.4, 6}, {0.8, 12}}) {
    EXPECT_NEAR(shear.time_of(strain, 0), period * twelfths / 12, 1e-12) << strain;
  }
  EXPECT_NEAR(shear.time_of(8.1, 0), 10 * period + period / 12, 1e-11);
  EXPECT_NEAR(shear.mean_rate() * period, 0.8, 1e-12);
  const double never = std::numeric_limits<double>::infinity();
  EXPECT_EQ(shear.time_of(never, 0), never);
}

TEST(ImposedFlow, HasASteadyRateUnlessItComesAndGoes) {
  EXPECT_EQ(steady_shear(0.5).steady_rate(), 0.5);
  EXPECT_EQ(steady_shear(0.5).period(), std::nullopt);
  const ImposedFlow flow(std::make_shared<OscillatoryShear>(0.2, 3));
  EXPECT_EQ(flow.steady_rate(), 0);
  EXPECT_DOUBLE_EQ(flow.rate(), 0.6);
}

TEST(Clock, CountsStepsOfOneSizeAndKeepsTheTimeOfOthers) {
  Clock clock;
  clock.count_in(0.1);
  clock.steps = 1000000;
  EXPECT_EQ(clock.time(), 1e6 * 0.1);
  EXPECT_EQ(clock.with_parts(4).time(), clock.time());
  EXPECT_EQ(clock.with_parts(4).timestep, 0.1 / 4);
  clock.count_in(0.25);
  EXPECT_EQ(clock.time(), 1e6 * 0.1);
  ++clock.steps;
  EXPECT_EQ(clock.time(), 1e6 * 0.1 + 0.25);
}

TEST(ImposedFlow, HasTheRateOfItsSteadyPart) {
  const ImposedFlow across(std::make_shared<CrossShear>(0.5, 0.2, 3));
  EXPECT_EQ(across.steady_rate(), 0.5);
  EXPECT_DOUBLE_EQ(*across.period(), 2 * std::numbers::pi / 3);
  // E = rate diag(1, -1, 0), sqrt(2 E:E) = 2 rate; sigma:E / sqrt(2 E:E) = (sigma_xx - sigma_yy) / 2.
  const ImposedFlow extension(std::make_shared<PlanarExtension>(0.5));
  EXPECT_DOUBLE_EQ(extension.steady_rate(), 1);
  EXPECT_DOUBLE_EQ(extension.shear_part({.xx = 3, .yy = -2, .zz = 7, .xy = 5}), 2.5);
  // (sigma_xx - (sigma_yy + sigma_zz) / 2) / sqrt(3), and its opposite in biaxial extension.
  const ImposedFlow uniaxial(std::make_shared<UniaxialExtension>(0.5)),
      biaxial(std::make_shared<UniaxialExtension>(-0.5));
  const SymmetricTensor stress = {.xx = 3, .yy = -2, .zz = 7, .xy = 5};
  EXPECT_DOUBLE_EQ(uniaxial.steady_rate(), 0.5 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(uniaxial.shear_part(stress), 0.5 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(biaxial.shear_part(stress), -0.5 / std::sqrt(3.0));
  EXPECT_EQ(steady_shear(0.3).shear_part(stress), 5);
  EXPECT_EQ(ImposedFlow().shear_part({.xy = 5}), 5);
}

// Both shear gradients are along y, so the displacements add.
TEST(CrossShear, SwingsAcrossASteadyShear) {
  const CrossShear shear(0.5, 0.2, 3);
  const double time = 0.7, h = 1e-6;
  const Matrix3 made = shear.displacement_gradient(time);
  EXPECT_EQ(made.column[1], (Vector3{0.5 * time, 0, 0.2 * std::sin(3 * time)}));
  const Matrix3 slope =
      (1 / (2 * h)) * (shear.displacement_gradient(time + h) - shear.displacement_gradient(time - h));
  EXPECT_NEAR(norm(shear.velocity_gradient(time) - slope), 0, 1e-8);
  EXPECT_DOUBLE_EQ(shear.largest_rate(), std::hypot(0.5, 0.6));
  EXPECT_EQ(shear.time_of(2, 0), 4);
}

// The lattice recurs after a strain of ln((3 + sqrt 5) / 2): exp(L t) H0 = H0 M with an integer matrix M.
TEST(PlanarExtension, BringsItsLatticeBack) {
  const double rate = 0.5, period = std::log((3 + std::sqrt(5.0)) / 2) / rate;
  const PlanarExtension extension(rate);
  const Matrix3 start = extension.edges_at_start({2, 2, 3});
  const Matrix3 end = start + extension.displacement_gradient(period) * start;
  const Matrix3 whole = inverse(start) * end;
  for (const Vector3& column : whole.column) {
    for (const double number : {column.x, column.y, column.z}) EXPECT_NEAR(number, std::round(number), 1e-12);
  }
  EXPECT_NEAR(whole.column[0].x + whole.column[1].y, 3, 1e-12);
  EXPECT_NEAR(determinant(whole), 1, 1e-12);
}

// Follows a flow in steps of strain, with basis changes; calls look(cell, strain) after each.
template <class Look>
void follow(const Deformation& flow, double largest_strain, double step, const Look& look) {
  PeriodicCell cell = PeriodicCell::with_edges(flow.edges_at_start({1, 1, 1}), {});
  for (double strain = 0; strain <= largest_strain; strain += step) {
    cell.deform(flow.displacement_gradient(strain), flow.velocity_gradient(strain));
    cell.change_basis(cell.due_change());
    look(cell, strain);
  }
}

// Expects that the cell keeps its volume and its width up to the largest strain.
void expect_wide_cell(const Deformation& flow, double largest_strain, double tolerance) {
  follow(flow, largest_strain, 0.01, [&](const PeriodicCell& cell, double strain) {
    const Vector3 widths = cell.frame().widths();
    ASSERT_GT(std::min({widths.x, widths.y, widths.z}), 0.66) << strain;
    ASSERT_NEAR(cell.volume(), 1, tolerance) << strain;
  });
}

TEST(PlanarExtension, KeepsItsCellWide) {
  expect_wide_cell(PlanarExtension(1), PlanarExtension::largest_strain, 1e-6);
}

// The lattice of the unit cube has |x y z| >= 1/7 at every point but the origin, with equality at the edges.
TEST(UniaxialExtension, BeginsWithACubeWhoseLatticeNoDiagonalFlowMakesThin) {
  const Matrix3 edges = UniaxialExtension(1).edges_at_start({1, 1, 1});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(edges.column[i], edges.column[j]), i == j, 1e-15);
  }
  EXPECT_NEAR(determinant(edges), 1, 1e-15);
  constexpr int most = 12;
  double least = 1;
  for (int k = -most; k <= most; ++k) {
    for (int l = -most; l <= most; ++l) {
      for (int m = -most; m <= most; ++m) {
        const Vector3 x = edges * Vector3{double(k), double(l), double(m)};
        if (k != 0 || l != 0 || m != 0) least = std::min(least, std::abs(x.x * x.y * x.z));
      }
    }
  }
  EXPECT_NEAR(least, 1.0 / 7, 1e-12);
}

// exp(t) along and exp(-t/2) across conserve volume, for rates of either sign.
TEST(UniaxialExtension, KeepsItsCellWideAndItsImagesApart) {
  for (const double rate : {1.0, -1.0}) {
    const UniaxialExtension extension(rate);
    EXPECT_NEAR(1 + extension.displacement_gradient(2).column[0].x, std::exp(2 * rate), 1e-12);
    EXPECT_NEAR(1 + extension.displacement_gradient(2).column[2].z, std::exp(-rate), 1e-12);
    expect_wide_cell(extension, UniaxialExtension::largest_strain, 1e-8);
    follow(extension, UniaxialExtension::largest_strain, 0.01, [&](const PeriodicCell& cell, double strain) {
      ASSERT_NEAR(cell.net_strain(), rate * strain, 1e-9);
    });
  }
}

// The shortest lattice vector is among sums of few edges of a compact cell.
TEST(Deformation, BringsImagesOfTurnedCubesNoNearerThanItSays) {
  const PlanarExtension planar(1);
  const UniaxialExtension uniaxial(1), biaxial(-1);
  EXPECT_NEAR(planar.nearest_image(), std::sqrt(2.0) / std::pow(5, 0.25), 1e-4);
  EXPECT_NEAR(uniaxial.nearest_image(), std::sqrt(3.0) / std::cbrt(7.0), 1e-4);
  for (const Deformation* flow : std::initializer_list<const Deformation*>{&planar, &uniaxial, &biaxial}) {
    double nearest = 2;
    follow(*flow, 6, 0.002, [&](const PeriodicCell& cell, double) {
      for (int n = 1; n < 125; ++n) {
        const LatticeShift k{n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2};
        if (k != LatticeShift{}) nearest = std::min(nearest, norm(cell.displacement(k)));
      }
    });
    EXPECT_GE(nearest, flow->nearest_image());
    EXPECT_LT(nearest, flow->nearest_image() + 0.01);
  }
}

// Rate 2 for a strain of 1, a ramp down to -1 over a time of 3, rest for a time of 1, then rate -0.5.
class Programme : public testing::Test {
 protected:
  Segments segments{{{2, 2, time_of_segment(2, 2, 1)}, {2, -1, 3}, {0, 0, 1}}, -0.5};
};

TEST_F(Programme, HasRatesAndStrainsOfItsSegments) {
  const double rates[][2] = {{0, 2},    {0.49, 2}, {1.5, 1},    {2.5, 0},
                             {3, -0.5}, {4, 0},    {4.5, -0.5}, {9, -0.5}};
  for (const auto& [time, rate] : rates) {
    EXPECT_NEAR(segments.velocity_gradient(time).column[1].x, rate, 1e-12) << time;
  }
  const double strains[][2] = {{0.25, 0.5}, {0.5, 1},   {1.5, 2.5}, {2.5, 3},
                               {3.5, 2.5},  {4.5, 2.5}, {6.5, 1.5}};
  for (const auto& [time, strain] : strains) {
    EXPECT_NEAR(segments.displacement_gradient(time).column[1].x, strain, 1e-12) << time;
  }
  EXPECT_EQ(segments.largest_rate(), 2);
}

TEST_F(Programme, CountsStrainInBothDirectionsFromAnyTime) {
  const double times[][3] = {{0.5, 0, 0.25}, {2.5, 0, 1.5}, {1.5, 0.5, 1},
                             {3.5, 0, 3.5},  {4, 0, 5.5},   {1, 4, 2.5}};  // the last two include the rest
  for (const auto& [strain, from, time] : times)
    EXPECT_NEAR(segments.time_of(strain, from), time, 1e-12) << strain;
  EXPECT_NEAR(segments.strain_between(0.5, 0, 13), 4.5, 1e-12);
  EXPECT_NEAR(segments.strain_between(0.5, 5, 13), 1.5, 1e-12);
  EXPECT_TRUE(std::isinf(Segments({{1, 1, 1}}, 0).time_of(1.5, 0)));
}

TEST_F(Programme, IsSteadyFromItsLastSegmentOnAndJumpsBetweenOthers) {
  EXPECT_EQ(segments.steady_gradient(4.4), Matrix3{});
  EXPECT_EQ(segments.steady_gradient(4.5), simple_shear(-0.5));
  EXPECT_FALSE(segments.jumps_between(0, 3.5));  // the ramp starts without a jump
  EXPECT_TRUE(segments.jumps_between(3.5, 3.6));
  EXPECT_FALSE(segments.jumps_between(3.4, 3.5));
  EXPECT_TRUE(segments.jumps_between(4.4, 4.6));
}

TEST(TimeOfSegment, TurnsWhereItsRateDoes) {
  // From 2 to -1 over a time of 3: strain 2 forward and 0.5 back.
  EXPECT_DOUBLE_EQ(time_of_segment(2, -1, 2.5), 3);
  EXPECT_DOUBLE_EQ(time_of_segment(0, 1, 2), 4);
}

}  // namespace
}  // namespace peclet::engine
