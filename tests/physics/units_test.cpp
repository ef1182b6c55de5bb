#include <gtest/gtest.h>

#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

// Units in those of the scene that was written first.
struct Units {
  double length, time, mass;

  double energy() const { return mass * length * length / (time * time); }
  double force() const { return energy() / length; }
  double stiffness() const { return force() / length; }
  double viscosity() const { return force() * time / (length * length); }
  double density() const { return mass / (length * length * length); }
};

// Rough spheres of two sizes with contact, a critical load, rolling resistance, lubrication, repulsion and
// noise.
Experiment with_every_dimension(const Units& unit, double timestep, std::optional<double> solver_tolerance) {
  Experiment made;
  made.physics.viscosity = 0.1 * unit.viscosity();
  made.physics.thermal_energy = 0.017 * unit.energy();
  made.physics.flow = steady_shear(0.7 / unit.time);
  made.physics.contact = ContactParameters{.normal_stiffness = 1e4 * unit.stiffness(),
                                           .friction = 0.5,
                                           .critical_load = 0.01 * unit.force(),
                                           .tangential_stiffness = 3e3 * unit.stiffness(),
                                           .rolling_stiffness = 700 * unit.stiffness(),
                                           .rolling_friction = 0.2};
  made.physics.lubrication = LubricationParameters{.inner_gap = 1e-3, .outer_gap = 0.05};
  made.physics.repulsion = RepulsionParameters{.strength = 0.17 * unit.energy(), .relative_length = 0.01};
  made.radius.assign(30, unit.length);
  for (std::size_t i = 0; i < made.radius.size(); i += 2) made.radius[i] = 1.4 * unit.length;
  made.density = 0.1 * unit.density();
  set_cube(made, 0.55);
  made.timestep = timestep * unit.time;
  made.skin = 0.1 * unit.length;
  made.solver_tolerance = solver_tolerance;
  return made;
}

std::vector<Vector3> places_after_steps(const Experiment& experiment) {
  Laboratory laboratory = flowing_suspension(experiment, 5);
  for (int step = 0; step < 100; ++step) laboratory.step();
  return unwrapped_places(laboratory);
}

void expect_steps_in_any_units(double timestep, std::optional<double> solver_tolerance) {
  const Units first{1, 1, 1};
  const std::vector<Vector3> places =
      places_after_steps(with_every_dimension(first, timestep, solver_tolerance));
  for (const Units& unit :
       {Units{4, 1, 1}, Units{1, 0.0625, 1}, Units{1, 1, 64}, Units{0x1p-20, 0x1p-10, 0x1p-50}}) {
    const std::vector<Vector3> others =
        places_after_steps(with_every_dimension(unit, timestep, solver_tolerance));
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_TRUE(others[i] == unit.length * places[i]) << i << ", " << unit.length << ", " << unit.time;
    }
  }
}

// A power of two changes no rounding. So in other units each sphere must be at the same place bit by bit:
// only groups without dimension matter, and spheres of one size ratio behave alike at any size.
TEST(Units, ExplicitStepsAreTheSameInAny) { expect_steps_in_any_units(1e-4, {}); }

TEST(Units, ImplicitStepsAreTheSameInAny) { expect_steps_in_any_units(2e-3, 1e-3); }

}  // namespace
}  // namespace peclet::engine
