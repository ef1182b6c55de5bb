// Displacements of spheres with constant velocities.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

class Flight : public testing::Test {
 protected:
  // Even particles move with (1, 2, 3), odd ones with (-1, 0, 3); images undo the wrapping into the cell.
  void fly(Observable& observable, System& system, std::uint64_t steps) {
    for (std::uint64_t step = 0; step < steps; step += observable.interval()) {
      for (std::size_t i = 0; i < system.particles.count(); ++i) {
        const double time = timestep * static_cast<double>(step);
        const bool even = system.particles.id[i] % 2 == 0;
        system.particles.position.set(i,
                                      even ? Vector3{time, 2 * time, 3 * time} : Vector3{-time, 5, 3 * time});
        system.particles.image[i] = {};
      }
      wrap_into_cell(system.particles, system.box);
      observable.sample(system, 0);
    }
  }
  // Expects the slope `factor` 3 t / D_0 for a lag t of a tenth of the window, which is not one of the
  // curves.
  void expect_slope(double shear_rate, double factor) {
    System system = loose_spheres(2, shear_rate);
    const auto observable =
        observable_of(scene_with("mean_squared_displacement", {}, shear_rate), system, 64);
    fly(*observable, system, 64);
    const double shorter = 6.4 * timestep, free = 2 / (std::numbers::pi * 0.1);
    const double expected = factor * 3 * shorter / free;
    EXPECT_NEAR(mean_of(*observable)["self_diffusion"].get<double>(), expected, 1e-9 * expected);
  }
};

TEST_F(Flight, HasSquaredDisplacementsOfItsSpeed) {
  System system = loose_spheres(6);
  std::swap(system.particles.id[0], system.particles.id[2]);  // order in memory is irrelevant
  const auto observable = observable_of(scene_with("mean_squared_displacement"), system, 1000);
  fly(*observable, system, 1000);
  const Json mean = mean_of(*observable)["mean_squared_displacement"];
  const auto times = mean["time"].get<std::vector<double>>();
  EXPECT_EQ(times.front(), timestep);
  EXPECT_EQ(times.back(), 7 * 32 * timestep);  // 4 * 2^6 samples exceed a quarter
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double square = times[k] * times[k];
    EXPECT_NEAR(mean["species"][0]["y"][k].get<double>(), 4 * square, 1e-9 * square);
    EXPECT_NEAR(mean["species"][1]["y"][k].get<double>(), 0, 1e-9 * square);
    EXPECT_NEAR(mean["all"]["x"][k].get<double>(), square, 1e-9 * square);
    EXPECT_NEAR(mean["all"]["y"][k].get<double>(), 2 * square, 1e-9 * square);
    EXPECT_NEAR(mean["centre"]["x"][k].get<double>(), 0, 1e-9 * square);
    EXPECT_NEAR(mean["centre"]["y"][k].get<double>(), square, 1e-9 * square);
    EXPECT_NEAR(mean["centre"]["z"][k].get<double>(), 9 * square, 1e-9 * square);
  }
  EXPECT_EQ(mean["species"][1]["radius"], 2);
}

// Relative to the centre the squares are (1 + 1 + 0) t^2: 2 (4 - 1) t^2 / t over D_0 = kT / (pi eta a). Under
// shear those across the flow are (1 + 0) t^2, and D is 3/2 of theirs for three axes.
TEST_F(Flight, HasASlopeRelativeToTheCentre) { expect_slope(0, 2); }
TEST_F(Flight, UnderShearHasTheSlopeOfTwoAxesForThree) { expect_slope(0.3, 1.5); }

TEST_F(Flight, OfSpheresThatRestHasNoSlope) {
  const System system = loose_spheres(2);
  const auto observable = observable_of(scene_with("mean_squared_displacement"), system, 10);
  for (int sample = 0; sample < 9; ++sample) observable->sample(system, 0);
  EXPECT_TRUE(mean_of(*observable)["self_diffusion"].is_null());  // a tenth of nine samples is none
  observable->sample(system, 0);
  EXPECT_EQ(mean_of(*observable)["self_diffusion"], 0);
}

TEST_F(Flight, UnderShearLeavesOutTheDirectionOfTheFlow) {
  System system = loose_spheres(2, /*shear_rate=*/0.3);
  const auto observable = observable_of(scene_with("mean_squared_displacement", {}, 0.3), system, 64);
  fly(*observable, system, 64);
  const Json mean = mean_of(*observable)["mean_squared_displacement"];
  EXPECT_TRUE(mean["all"]["x"].is_null());
  EXPECT_EQ(mean["all"]["y"][0], 0.5 * timestep * timestep * 4);
}

TEST_F(Flight, MayBeSampledSeldom) {
  System system = loose_spheres(2);
  const auto observable =
      observable_of(scene_with("mean_squared_displacement", {{"interval", 4.6 * timestep}}), system, 100);
  EXPECT_EQ(observable->interval(), 5u);
  fly(*observable, system, 100);
  EXPECT_EQ(mean_of(*observable)["mean_squared_displacement"]["time"][0], 5 * timestep);
}

}  // namespace
}  // namespace peclet::engine
