// Implicit steps that are divided where spheres would move too far.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "engine/integrators/midpoint.h"
#include "engine/realisation/schedule.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

constexpr double solved_to = 1e-5;

// Two spheres of radius 1 in a nearly inviscid fluid, with contacts of the given stiffness.
struct Flight {
  explicit Flight(double stiffness) {
    physics.viscosity = 1e-9;
    physics.contact = ContactParameters{.normal_stiffness = stiffness};
    system = spheres_in({20, 20, 20}, physics, {1, 1});
    system.particles.position.set(0, {5, 5, 5});
    system.particles.position.set(1, {12, 5, 5});
  }

  Midpoint steps_of(double timestep) {
    Midpoint integrator(physics, system.particles, timestep, solved_to, 1, 1);
    integrator.start(system);
    return integrator;
  }
  Vector3 place(std::uint32_t id) const {
    return system.particles.position[system.particles.id[0] == id ? 0 : 1];
  }

  Physics physics;
  System system;
};

// Spheres that move beyond every list are reported.
TEST(Implicit, ReportsALeapOverTheNeighbours) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {50, 0, 0});
  Midpoint integrator = flight.steps_of(0.1);
  EXPECT_GE(integrator.advance(flight.system).largest_displacement, 2);

  flight.system.particles.velocity.set(1, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_FALSE(std::isfinite(integrator.advance(flight.system).largest_displacement));
}

// A free sphere moves v dt; the step is halved until the displacement of a part is below the bound.
TEST(DividedSteps, AreHalvedUntilNoSphereMovesTooFar) {
  constexpr double way = 0.1;
  for (const auto& [bound, division] :
       {std::pair{0.11, 0}, std::pair{0.08, 1}, std::pair{0.03, 2}, std::pair{0.015, 3},
        std::pair{way / 1000, 10}, std::pair{way / 1e6, 10}}) {
    Flight flight(1e4);
    flight.system.particles.velocity.set(1, {0, 0, way});
    Midpoint integrator = flight.steps_of(1);
    integrator.divide_steps(bound);
    const StepReport report = integrator.advance(flight.system);
    EXPECT_EQ(report.division, division) << bound;
    EXPECT_NEAR(report.largest_displacement, way / (1 << division), 1e-6) << bound;
    EXPECT_NEAR(flight.place(1).z, 5 + way, 1e-6) << bound;
    EXPECT_FALSE(report.broke_off);
    EXPECT_EQ(flight.system.step, 1U);
    EXPECT_EQ(flight.system.clock.steps, 1U);
    EXPECT_EQ(flight.system.clock.timestep, 1);
  }
}

// Half of this displacement exceeds any list.
TEST(DividedSteps, AreHalvedUntilAListHolds) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {0, 0, 4});
  Midpoint integrator = flight.steps_of(1);
  integrator.divide_steps(10);
  const StepReport report = integrator.advance(flight.system);
  // Spheres of radius 1 interact within 2; the skin is a tenth of that for both.
  EXPECT_EQ(report.division, 5);
  EXPECT_NEAR(flight.place(1).z, 9, 1e-6);
}

TEST(DividedSteps, AreDividedOnlyWhereThatIsAllowed) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {0, 0, 0.1});
  EXPECT_EQ(flight.steps_of(1).advance(flight.system).division, 0);
}

TEST(DividedSteps, StartWholeAgain) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {0, 0, 0.1});
  Midpoint integrator = flight.steps_of(1);
  integrator.divide_steps(0.08);
  EXPECT_EQ(integrator.advance(flight.system).division, 1);
  flight.system.particles.velocity.set(flight.system.particles.id[0] == 1 ? 0 : 1, {0, 0, 0.05});
  EXPECT_EQ(integrator.advance(flight.system).division, 0);
}

// Two spheres of reduced mass m/2 that meet at speed v each overlap by at most k delta^2 / 2 = (m / 2)
// (2 v)^2 / 2. In an undivided step they would pass through each other.
TEST(DividedSteps, LetNoSphereLeapThroughAnother) {
  constexpr double speed = 30, stiffness = 1e5, step = 0.2;
  Flight flight(stiffness);
  flight.system.particles.velocity.set(0, {speed, 0, 0});
  flight.system.particles.velocity.set(1, {-speed, 0, 0});
  Midpoint integrator = flight.steps_of(step);
  integrator.divide_steps(0.02);
  const StepReport report = integrator.advance(flight.system);
  const double mass = 0.1 * 4 * pi / 3, deepest = 2 * speed * std::sqrt(0.5 * mass / stiffness);
  EXPECT_GT(report.sums.largest_overlap, 0.2 * deepest);
  EXPECT_LT(report.sums.largest_overlap, deepest);
  EXPECT_EQ(report.division, 9);  // 30 * 0.2 / 2^9 = 0.0117
  EXPECT_GT(flight.place(1).x - flight.place(0).x, 2);
  EXPECT_LT(flight.place(1).x, 12);
  EXPECT_LT(report.largest_displacement, 0.02);
}

std::vector<std::uint64_t> bits_of(const VectorField& field) {
  std::vector<std::uint64_t> bits;
  for (std::size_t i = 0; i < field.size(); ++i) {
    for (const double x : {field[i].x, field[i].y, field[i].z})
      bits.push_back(std::bit_cast<std::uint64_t>(x));
  }
  return bits;
}

// Expects of two halves: the positions and velocities of two half steps, and the mean of their stresses.
void expect_steps_of_half_the_size(const Physics& physics) {
  constexpr double step = 2e-3;
  const System start = dense_suspension(physics, 203, 7);
  System whole = start, divided = start, halved = start;
  Midpoint integrator(physics, whole.particles, step, solved_to, 1, 1),
      half(physics, whole.particles, 0.5 * step, solved_to, 1, 1);
  integrator.start(whole);
  const double way = integrator.advance(whole).largest_displacement;

  Midpoint again(physics, divided.particles, step, solved_to, 1, 1);
  again.start(divided);
  again.divide_steps(0.9 * way);
  const StepReport report = again.advance(divided);
  half.start(halved);
  const StepReport first = half.advance(halved), second = half.advance(halved);
  ASSERT_EQ(report.division, 1);
  EXPECT_TRUE(bits_of(divided.particles.position) == bits_of(halved.particles.position));
  EXPECT_TRUE(bits_of(divided.particles.velocity) == bits_of(halved.particles.velocity));
  EXPECT_TRUE(bits_of(divided.particles.angular_velocity) == bits_of(halved.particles.angular_velocity));
  EXPECT_EQ(components(divided.springs), components(halved.springs));
  EXPECT_NEAR(divided.box.strain(), step * physics.flow.rate(), 1e-15);
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const SymmetricTensor &mean = report.sums.stress[t], &a = first.sums.stress[t],
                          &b = second.sums.stress[t];
    EXPECT_NEAR(mean.xy, 0.5 * (a.xy + b.xy), 1e-12 * std::abs(a.xy) + 1e-300);
    EXPECT_NEAR(mean.zz, 0.5 * (a.zz + b.zz), 1e-12 * std::abs(a.zz) + 1e-300);
  }
  EXPECT_EQ(report.sums.contacts, 0.5 * (first.sums.contacts + second.sums.contacts));
  EXPECT_EQ(report.sums.largest_overlap, std::max(first.sums.largest_overlap, second.sums.largest_overlap));
  EXPECT_EQ(report.largest_displacement, std::max(first.largest_displacement, second.largest_displacement));
  EXPECT_EQ(report.solver_iterations, first.solver_iterations + second.solver_iterations);
  EXPECT_GT(first.sums.contacts, 0);
}

TEST(DividedSteps, AreStepsOfHalfTheSize) {
  for (const bool kinetic : {false, true}) {
    expect_steps_of_half_the_size(
        physics_with({.lubrication = true, .contact = true, .friction = true, .kinetic = kinetic}));
  }
}

// A sphere without inertia moves by the integral of the noise, sqrt(2 kT dt / zeta) z, for any division of
// its steps. A part of 1/8 moves it by about sqrt(1/8) of that.
TEST(DividedSteps, FollowThePathOfTheNoise) {
  Physics physics;
  physics.viscosity = 0.1;
  physics.thermal_energy = 0.01;
  const auto end = [&](double longest_way, StepReport& report) {
    System system = spheres_in({20, 20, 20}, physics, {1}, 1e-9);
    const std::unique_ptr<Implicit> steps = implicit_steps(physics, system.particles, 0.5, solved_to, 1, 1);
    steps->start(system);
    if (longest_way > 0) steps->divide_steps(longest_way);
    for (int step = 0; step < 3; ++step) report = steps->advance(system);
    EXPECT_EQ(system.part, 1U);
    return system.particles.position[0];
  };
  StepReport whole, divided;
  const Vector3 expected = end(0, whole), found = end(0.3 * whole.largest_displacement, divided);
  EXPECT_GT(norm(expected), 0.01);
  EXPECT_GT(divided.division, 2);
  EXPECT_NEAR(norm(found - expected), 0, 1e-4 * norm(expected));
}

// The smallest part of a step moves a sphere too far. The cause is the displacement; the text names the part.
TEST(DividedSteps, BreakOffWhereTheSmallestPartLeaps) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {5e4, 0, 0});
  Midpoint integrator = flight.steps_of(1);
  integrator.divide_steps(0.1);
  const StepReport report = integrator.advance(flight.system);
  EXPECT_TRUE(report.broke_off);
  EXPECT_EQ(flight.system.step, 1U);
  const std::optional<Ending> ending = ending_of(report, flight.system, {.largest_displacement = 0.3}, 1);
  ASSERT_TRUE(ending);
  EXPECT_EQ(ending->cause, Ending::Cause::displacement);
  EXPECT_NE(ending->message.find("in 1/1024 of a step"), std::string::npos) << ending->message;
}

TEST(DividedSteps, BreakOffWhereNothingIsFinite) {
  Flight flight(1e4);
  flight.system.particles.velocity.set(1, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  Midpoint integrator = flight.steps_of(1);
  integrator.divide_steps(0.1);
  const std::optional<Ending> ending = ending_of(integrator.advance(flight.system), flight.system, {}, 1);
  ASSERT_TRUE(ending);
  EXPECT_EQ(ending->cause, Ending::Cause::non_finite);
}

}  // namespace
}  // namespace peclet::engine
