#include "engine/flow/waves.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "tests/engine/draws.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

constexpr double edge = 20, pi = std::numbers::pi;

// 0.1 sin^3(2 pi y / L) = 0.1 (3 sin t - sin 3t) / 4.
const std::vector<Wave> cube_of_a_sine = {{1, 0.075, 0}, {3, -0.025, 0}};

TEST(Waves, MakeUpTheCubeOfASine) {
  const Waves waves(cube_of_a_sine, true);
  const PeriodicCell cell({edge, edge, edge}, Matrix3{});
  Draws draws(1);
  for (int n = 0; n < 20; ++n) {
    const Vector3 x = draws.vector(30);
    const double k = 2 * pi / edge, s = std::sin(k * x.y), c = std::cos(k * x.y);
    const FlowVariation::Local local = waves.at(x, cell);
    EXPECT_NEAR(local.velocity.x, 0.1 * s * s * s, 1e-15);
    EXPECT_NEAR(local.gradient.column[1].x, 0.3 * k * s * s * c, 1e-15);
    EXPECT_NEAR(local.laplacian.x, 0.3 * k * k * s * (2 * c * c - s * s), 1e-15);
    EXPECT_NEAR(local.laplacian_of_gradient.column[1].x, 0.3 * k * k * k * c * (2 * c * c - 7 * s * s),
                1e-15);
    EXPECT_EQ(local.velocity.y, 0);
    EXPECT_EQ(local.velocity.z, 0);
    EXPECT_LE(std::abs(local.gradient.column[1].x), waves.largest_rate(cell));
  }
}

// A point and its images have equal wave velocities, also in a tilted cell.
TEST(Waves, HaveThePeriodsOfTheCell) {
  PeriodicCell cell({edge, edge, edge}, simple_shear(0.3));
  cell.deform(simple_shear(0.37));
  const Waves waves({{2, 0.3, -0.2}, {5, 0.1, 0.4}}, true);
  const Vector3 x = {1, 2, 3};
  const double velocity = waves.at(x, cell).velocity.x;
  for (const LatticeShift k : {LatticeShift{1, 0, 0}, {0, 1, 0}, {-2, 3, 1}}) {
    EXPECT_NEAR(waves.at(x + cell.displacement(k), cell).velocity.x, velocity, 1e-13);
  }
}

// A force-free sphere moves with U = (1 - a^2 k^2 / 6) u, Faxen's correction, and turns with half the
// vorticity at its centre. From rest it relaxes there exponentially, in implicit steps by
// 1 / (1 + dt zeta / m) a step. Its height is constant.
TEST(Waves, CarryAFreeSphereAsFaxenSays) {
  struct Case {
    double rate;
    bool implicit, faxen;
  };
  constexpr double density = 1, viscosity = 1, sine = 0.4, cosine = -0.3;
  constexpr Case cases[] = {{0, false, true},  {0, true, true},     {0.2, false, true},
                            {0.2, true, true}, {0.2, false, false}, {0.2, true, false}};
  for (const Case& each : cases) {
    Physics physics;
    physics.viscosity = viscosity;
    physics.flow = ImposedFlow(std::make_shared<SteadyShear>(each.rate),
                               std::make_shared<Waves>(std::vector<Wave>{{2, sine, cosine}}, each.faxen));
    physics.contact = ContactParameters{.normal_stiffness = 1};  // gives the list a range
    System system = spheres_in({edge, edge, edge}, physics, {1, 3}, density);
    const Vector3 places[] = {{4, 3, 5}, {12, 14.5, 15}};
    for (std::size_t i = 0; i < 2; ++i) system.particles.position.set(i, places[i]);
    constexpr int steps = 60;
    const double step = each.implicit ? 0.01 : 0.002;
    start_and_advance(*steps_of_method(each.implicit, physics, system, step, 1e-8), system, steps);
    const double k = 2 * pi * 2 / edge;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t p = system.particles.id[i];
      const double a = p == 0 ? 1 : 3, y = places[p].y;
      const double factor = each.faxen ? 1 - a * a * k * k / 6 : 1;
      const double u = each.rate * y + factor * (sine * std::sin(k * y) + cosine * std::cos(k * y));
      const double slope = each.rate + k * (sine * std::cos(k * y) - cosine * std::sin(k * y));
      // zeta / m = 9 eta / (2 rho a^2), zeta_r / I = 15 eta / (rho a^2). Explicit steps multiply the
      // deviation by 1 - dt zeta / m at each half-step velocity, and by 1 - dt zeta / (2 m) at both ends.
      const auto reached = [&](double decay) {
        const double x = step * decay;
        return each.implicit ? 1 - std::pow(1 + x, -steps)
                             : 1 - (1 - x / 2) * (1 - x / 2) * std::pow(1 - x, steps - 1);
      };
      const double tolerance = each.implicit ? 1e-6 : 1e-12;
      EXPECT_NEAR(system.particles.velocity[i].x, u * reached(4.5 * viscosity / (density * a * a)), tolerance)
          << each.rate << ' ' << each.implicit << ' ' << a;
      EXPECT_NEAR(system.particles.angular_velocity[i].z,
                  -0.5 * slope * reached(15 * viscosity / (density * a * a)), tolerance)
          << each.rate << ' ' << each.implicit << ' ' << a;
      EXPECT_EQ(system.particles.position[i].y, y);
    }
  }
}

// The forces on fixed spheres at all heights cancel; the power is zeta times the mean square velocity.
TEST(Waves, DragAsMuchForwardAsBack) {
  Physics physics;
  physics.viscosity = 1;
  physics.flow = ImposedFlow(std::make_shared<SteadyShear>(0),
                             std::make_shared<Waves>(std::vector<Wave>{{1, 0.4, 0.1}, {3, 0.2, -0.3}}, true));
  constexpr std::size_t count = 32;
  System system;
  system.particles = make_particles(std::vector<double>(count, 1.0), 1);
  system.box = PeriodicCell({edge, edge, edge}, Matrix3{});
  for (std::size_t i = 0; i < count; ++i) {
    system.particles.position.set(i, {0, edge * static_cast<double>(i) / count, 0});
  }
  const ForceField field(physics, system.particles, 0.01, 1, 1);
  VectorField force(count), torque(count);
  field.add_varying_drag(system, 0, count, force, torque);
  double forces = 0, power = 0, expected = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = physics.flow.at(system.box).velocity(system.particles.position[i]).x;
    forces += force[i].x;
    power += force[i].x * u / count;
  }
  // Power on fixed spheres by Parseval's theorem: zeta times the sum of (1 - a^2 k^2 / 6) (S^2 + C^2) / 2.
  for (const auto& [periods, squares] : {std::pair{1, 0.17}, std::pair{3, 0.13}}) {
    const double k = 2 * pi * periods / edge;
    expected += 6 * pi * (1 - k * k / 6) * squares / 2;
  }
  EXPECT_NEAR(forces, 0, 1e-13);
  EXPECT_NEAR(power, expected, 1e-13);
}

}  // namespace
}  // namespace peclet::engine
