// Full-step velocities and spins have the variances kT / m and kT / I at any stable step, for free spheres
// and for a dense suspension with contacts, lubrication and noise.
//
// Drag conserves no momentum, so every sphere has three translational and three rotational degrees of
// freedom. False failures with fresh seeds: errors come from 100 blocks; Student's t with 99 degrees of
// freedom passes 5 with probability 2.5e-6, in 30 comparisons.
#include <gtest/gtest.h>

#include "engine/integrators/stability.h"
#include "engine/realisation/packing.h"
#include "tests/physics/estimates.h"
#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

constexpr double largest_deviation = 5;
constexpr std::size_t blocks = 100;
constexpr double thermal_energy = 1e-3;

// The mean m u^2 / 3 and I w^2 / 3 over kT of one size class, one value per step.
struct TemperatureSeries {
  std::vector<double> translational, rotational;
};

using Temperatures = std::vector<TemperatureSeries>;

void record(Temperatures& series, const ParticleState& all, double kT) {
  std::vector<double> count(series.size()), u(series.size()), w(series.size());
  for (std::size_t i = 0; i < all.count(); ++i) {
    const std::size_t size = all.size_class[i];
    count[size] += 1;
    u[size] += all.mass[i] * dot(all.velocity[i], all.velocity[i]);
    w[size] += all.inertia[i] * dot(all.angular_velocity[i], all.angular_velocity[i]);
  }
  for (std::size_t size = 0; size < series.size(); ++size) {
    series[size].translational.push_back(u[size] / (3 * count[size] * kT));
    series[size].rotational.push_back(w[size] / (3 * count[size] * kT));
  }
}

void expect_equipartition(const Temperatures& series) {
  for (const TemperatureSeries& size : series) {
    const Estimate u = block_estimate(size.translational, blocks);
    const Estimate w = block_estimate(size.rotational, blocks);
    EXPECT_LT(u.deviation(1), largest_deviation) << u.mean << " +- " << u.error;
    EXPECT_LT(w.deviation(1), largest_deviation) << w.mean << " +- " << w.error;
    // Wider error bars would not resolve the half-step bias.
    EXPECT_LT(std::max(u.error, w.error), 0.01);
  }
}

// Returns spheres of radii 1 and 1.4 without interactions.
Laboratory free_spheres(double timestep) {
  Experiment experiment;
  experiment.physics.viscosity = natural_viscosity;
  experiment.physics.thermal_energy = thermal_energy;
  experiment.radius.assign(200, 1.0);
  experiment.radius.resize(400, 1.4);
  experiment.box = PeriodicCell({130, 130, 130}, Matrix3{});
  experiment.timestep = timestep;
  experiment.skin = 10;
  return thermal_suspension(experiment, 3, 11);
}

// The step limit of the fastest mode, the spin of the small spheres: lambda dt = 2.
constexpr double spin_limit = 2 / natural_spin_rate;

class FreeSpheres : public testing::TestWithParam<double> {};

TEST_P(FreeSpheres, HaveTheTemperatureOfTheirNoise) {
  const double timestep = GetParam() * spin_limit;
  Laboratory laboratory = free_spheres(timestep);
  Temperatures series(2);
  const auto steps = static_cast<int>(blocks * std::ceil(40 / timestep));
  for (int step = 0; step < steps; ++step) {
    laboratory.step();
    record(series, laboratory.particles(), thermal_energy);
  }
  expect_equipartition(series);
}

// Displacements follow the half-step velocity, of variance (kT / m) / (1 - lambda dt / 2). A temperature
// taken half a step earlier or later would have that bias.
TEST_P(FreeSpheres, MoveFasterThanTheirTemperatureByTheHalfStepBias) {
  const double timestep = GetParam() * spin_limit;
  Laboratory laboratory = free_spheres(timestep);
  const ParticleState& all = laboratory.particles();
  std::vector<std::vector<double>> series(2);
  const auto steps = static_cast<int>(blocks * std::ceil(40 / timestep));
  for (int step = 0; step < steps; ++step) {
    std::vector<Vector3> before;
    for (std::size_t i = 0; i < all.count(); ++i) before.push_back(laboratory.unwrapped(i));
    laboratory.step();
    std::vector<double> sum(2);
    for (std::size_t i = 0; i < all.count(); ++i) {
      const Vector3 way = laboratory.unwrapped(i) - before[i];
      sum[all.size_class[i]] += all.mass[i] * dot(way, way) / (timestep * timestep);
    }
    for (std::size_t size = 0; size < 2; ++size) {
      series[size].push_back(sum[size] / (3.0 * static_cast<double>(all.count()) / 2.0 * thermal_energy));
    }
  }
  for (std::size_t size = 0; size < 2; ++size) {
    const double radius = size == 0 ? 1.0 : 1.4, rate = 1 / (radius * radius);  // zeta / m
    const Estimate moved = block_estimate(series[size], blocks);
    EXPECT_LT(moved.deviation(1 / (1 - 0.5 * rate * timestep)), largest_deviation)
        << moved.mean << " +- " << moved.error;
  }
}

INSTANTIATE_TEST_SUITE_P(FractionsOfTheLimit, FreeSpheres, testing::Values(0.1, 0.5, 0.9),
                         [](const auto& it) {
                           return "Tenths" + std::to_string(std::lround(10 * it.param));
                         });

Scene dense_scene() {
  Scene scene;
  scene.particles.count = 60;
  scene.particles.density = natural_density;
  scene.particles.species = {{1.0, 0.5}, {1.4, 0.5}};
  scene.volume_fraction = 0.45;
  scene.physics.viscosity = natural_viscosity;
  scene.physics.thermal_energy = thermal_energy;
  // Thermal overlaps are a hundredth of a radius.
  scene.physics.contact = ContactParameters{.normal_stiffness = 1e4 * thermal_energy};
  scene.physics.lubrication = LubricationParameters{1e-2, 0.05};
  return scene;
}

class DenseSuspension : public testing::TestWithParam<double> {};

TEST_P(DenseSuspension, HasTheTemperatureOfItsNoise) {
  const Scene scene = dense_scene();
  Experiment experiment;
  experiment.physics = scene.physics;
  experiment.radius = species_radii(scene.particles);
  set_cube(experiment, scene.volume_fraction);
  experiment.timestep = GetParam() * largest_timestep(scene);
  Laboratory laboratory = thermal_suspension(experiment, 5, 12);
  Temperatures series(2);
  double contacts = 0;
  const double decay_times = 4 * blocks;  // of the slowest mode, all spheres together
  const auto steps = static_cast<int>(decay_times / experiment.timestep);
  for (int step = 0; step < steps; ++step) {
    const StepReport report = laboratory.step();
    contacts += report.sums.contacts;
    record(series, laboratory.particles(), thermal_energy);
  }
  EXPECT_GT(contacts, steps) << "spheres hardly ever touched";
  expect_equipartition(series);
}

INSTANTIATE_TEST_SUITE_P(FractionsOfTheLimit, DenseSuspension, testing::Values(0.1, 0.5, 0.9),
                         [](const auto& it) {
                           return "Tenths" + std::to_string(std::lround(10 * it.param));
                         });

}  // namespace
}  // namespace peclet::engine
