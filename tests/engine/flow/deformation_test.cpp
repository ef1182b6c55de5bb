#include "engine/flow/deformation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrators/implicit.h"
#include "engine/integrators/velocity_verlet.h"

namespace peclet::engine {
namespace {

TEST(SteadyShear, StrainsByItsRateTimesTheTime) {
  const SteadyShear shear(0.7);
  EXPECT_EQ(shear.velocity_gradient(3), simple_shear(0.7));
  EXPECT_EQ(shear.displacement_gradient(3), simple_shear(0.7 * 3));
  EXPECT_EQ(shear.largest_rate(), 0.7);
  EXPECT_DOUBLE_EQ(shear.time_of(1.4), 2);
}

TEST(SteadyShear, OtherWayRoundReachesAStrainAsSoon) {
  const SteadyShear shear(-0.5);
  EXPECT_EQ(shear.largest_rate(), 0.5);
  EXPECT_DOUBLE_EQ(shear.time_of(1), 2);
  EXPECT_EQ(shear.displacement_gradient(3), simple_shear(-1.5));
}

TEST(SteadyShear, AtRestReachesNoStrain) {
  EXPECT_EQ(ImposedFlow().rate(), 0);
  EXPECT_EQ(ImposedFlow().deformation().time_of(1e-3), std::numeric_limits<double>::infinity());
}

TEST(OscillatoryShear, GoesToAndFro) {
  const OscillatoryShear shear(0.2, 3);
  EXPECT_DOUBLE_EQ(shear.largest_rate(), 0.6);
  EXPECT_DOUBLE_EQ(*shear.period(), 2 * std::numbers::pi / 3);
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

// A quarter, a half and a whole cycle have 1, 2 and 4 amplitudes; within them sin(w t) = 1/2 at a twelfth.
TEST(OscillatoryShear, CountsItsStrainInBothDirections) {
  const OscillatoryShear shear(0.2, 3);
  const double period = *shear.period();
  EXPECT_NEAR(shear.time_of(0.1), period / 12, 1e-12);
  EXPECT_NEAR(shear.time_of(0.2), period / 4, 1e-12);
  EXPECT_NEAR(shear.time_of(0.3), period * 5 / 12, 1e-12);
  EXPECT_NEAR(shear.time_of(0.4), period / 2, 1e-12);
  EXPECT_NEAR(shear.time_of(0.8), period, 1e-12);
  EXPECT_NEAR(shear.time_of(8.1), 10 * period + period / 12, 1e-11);
  EXPECT_NEAR(shear.mean_rate() * period, 0.8, 1e-12);
  const double never = std::numeric_limits<double>::infinity();
  EXPECT_EQ(shear.time_of(never), never);
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

// gamma = g sin(w t): a flow that only a test has, to see that nothing else needs to know of it.
class Oscillation final : public Deformation {
 public:
  Matrix3 velocity_gradient(double time) const override {
    return simple_shear(amplitude * frequency * std::cos(frequency * time));
  }
  Matrix3 displacement_gradient(double time) const override {
    return simple_shear(amplitude * std::sin(frequency * time));
  }
  double largest_rate() const override { return amplitude * frequency; }
  double time_of(double strain) const override { return strain / (4 * amplitude) * period; }

  static constexpr double amplitude = 0.3, frequency = 2, period = 2 * 3.14159265358979323846 / frequency;
};

// Planar extension, u = rate (x, -y, 0).
class Extension final : public Deformation {
 public:
  Matrix3 velocity_gradient(double /*time*/) const override {
    return {Vector3{rate, 0, 0}, Vector3{0, -rate, 0}, Vector3{}};
  }
  Matrix3 displacement_gradient(double time) const override {
    const double e = std::exp(rate * time);
    return {Vector3{e - 1, 0, 0}, Vector3{0, 1 / e - 1, 0}, Vector3{}};
  }
  double largest_rate() const override { return rate; }
  double time_of(double strain) const override { return strain / rate; }

  static constexpr double rate = 0.5;
};

// One light sphere that the fluid carries along: both methods take it where the flow leads, in the cell that
// the flow deforms.
System carried(const std::shared_ptr<const Deformation>& deformation, bool implicit, int steps, double step) {
  Physics physics;
  physics.viscosity = 1;
  physics.flow = ImposedFlow(deformation);
  System system;
  system.particles = make_particles({1, 1}, 1e-6);
  system.box = PeriodicCell({40, 40, 40}, deformation->velocity_gradient(0));
  physics.contact = ContactParameters{.normal_stiffness = 1};  // so that there is a range to look in
  system.list = NeighbourList(range_table(make_pair_kinds(physics, {1}), 1), 0.1);
  for (const std::size_t i : {0U, 1U}) {
    const Vector3 place = i == 0 ? Vector3{3, 5, 7} : Vector3{12, 15, 18};
    system.particles.position.set(i, place);
    system.particles.velocity.set(i, system.box.velocity_gradient() * place);
    system.particles.angular_velocity.set(i, spin_of(system.box.velocity_gradient()));
  }
  std::unique_ptr<Integrator> integrator;
  if (implicit) {
    integrator = implicit_steps(physics, system.particles, step, 1e-6, 1, 1);
  } else {
    integrator = std::make_unique<VelocityVerlet>(ForceField(physics, system.particles, step, 1, 1),
                                                  system.particles, step);
  }
  integrator->start(system);
  for (int n = 0; n < steps; ++n) integrator->advance(system);
  return system;
}

Vector3 unwrapped(const System& system, std::size_t i) {
  return system.particles.position[i] + system.box.displacement(system.particles.image[i]);
}

TEST(Deformation, OfAnyKindIsFollowedByBothMethods) {
  struct Case {
    std::shared_ptr<const Deformation> deformation;
    bool implicit;
    int steps;
    double step;
  };
  // Explicit steps must resolve m / zeta = 2/9 1e-6.
  const Case cases[] = {{std::make_shared<Oscillation>(), true, 400, 0.005},
                        {std::make_shared<Extension>(), true, 400, 0.005},
                        {std::make_shared<Oscillation>(), false, 2000, 2e-7},
                        {std::make_shared<Extension>(), false, 2000, 2e-7}};
  for (const Case& each : cases) {
    const System system = carried(each.deformation, each.implicit, each.steps, each.step);
    const double time = each.steps * each.step;
    EXPECT_NEAR(system.clock.time(), time, 1e-12 * time);
    const Matrix3 made = each.deformation->displacement_gradient(time);
    EXPECT_NEAR(norm(system.box.displacement_gradient() - made), 0, 1e-12);
    EXPECT_NEAR(norm(system.box.velocity_gradient() - each.deformation->velocity_gradient(time)), 0, 1e-12);
    // By far less than the way, up to 8, that it has gone: the methods are of second order.
    const double tolerance = each.implicit ? 2e-3 : 1e-6;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector3 start = i == 0 ? Vector3{3, 5, 7} : Vector3{12, 15, 18};
      const Vector3 way = unwrapped(system, i) - (start + made * start);
      EXPECT_LT(norm(way), tolerance) << i;
    }
  }
}

// The state knows how far the cell has come: what goes on from it goes on as if nothing had been.
TEST(Deformation, IsPartOfTheSavedState) {
  const System system = carried(std::make_shared<Oscillation>(), true, 10, 0.005);
  ArchiveWriter writer;
  save(system, writer);
  System again = carried(std::make_shared<Oscillation>(), true, 0, 0.005);
  ArchiveReader reader(writer.bytes());
  load(again, reader);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(again.clock.time(), system.clock.time());
  EXPECT_EQ(again.box.edges(), system.box.edges());
  EXPECT_EQ(again.box.velocity_gradient(), system.box.velocity_gradient());
}

}  // namespace
}  // namespace peclet::engine
