// Fluctuation and dissipation of many bodies at once: what the whole force field answers to velocities is the
// resistance whose noise it draws, pairs, images and drag together.
//
// False failures, were the seed drawn anew: one of 24 * 25 / 2 + 24 deviations beyond 5.5 standard
// deviations, 1.2e-5.
#include <gtest/gtest.h>

#include "tests/physics/laboratory.h"
#include "tests/physics/sampled_covariance.h"

namespace peclet::engine {
namespace {

constexpr double largest_sigma = 5.5;
constexpr double thermal_energy = 0.3, timestep = 2e-3;
constexpr std::uint64_t samples = 150000;
constexpr std::size_t spheres = 4, components = 6 * spheres;

using Components = std::vector<double>;  // forces of all spheres, then torques

// A cell as wide as two unit spheres and hardly more, inclined: the first two touch through two images.
System cluster(const Physics& physics) {
  System system;
  const std::vector<double> radius = {1.0, 1.0, 1.4, 0.5};
  system.particles = make_particles(radius, 1);
  const std::vector<double> sizes = distinct_radii(radius);
  system.list = NeighbourList(range_table(make_pair_kinds(physics, sizes), sizes.size()), 0.1);
  system.box = ShearedBox({4.02, 6.0, 7.0}, /*shear_rate=*/0, /*tilt=*/1.3);
  system.particles.position.set(0, {0.3, 0.3, 3.0});
  system.particles.position.set(1, {2.305, 0.31, 3.02});
  system.particles.position.set(2, Vector3{0.3, 0.3, 3.0} + 2.42 * Vector3{0.48, 0.64, 0.6});
  system.particles.position.set(3, Vector3{2.305, 0.31, 3.02} + 1.505 * Vector3{0.48, -0.6, -0.64});
  rebuild_neighbours(system);
  return system;
}

class Cluster {
 public:
  explicit Cluster(double temperature)
      : system_(cluster(physics(temperature))),
        field_(physics(temperature), system_.particles, timestep, /*seed=*/77, /*threads=*/1) {}

  Components loads() {
    field_.evaluate(system_, force_, torque_);
    Components all;
    for (const VectorField* field : {&force_, &torque_}) {
      for (std::size_t i = 0; i < spheres; ++i) {
        const Vector3 v = (*field)[i];
        all.insert(all.end(), {v.x, v.y, v.z});
      }
    }
    return all;
  }

  System& system() { return system_; }

 private:
  static Physics physics(double temperature) {
    Physics physics;
    physics.viscosity = 0.7;
    physics.thermal_energy = temperature;
    physics.lubrication = LubricationParameters{1e-3, 0.05};
    return physics;
  }

  System system_;
  ForceField field_;
  VectorField force_{spheres}, torque_{spheres};
};

// Column by column from unit velocities and spins of one sphere after another.
std::vector<Components> felt_resistance() {
  Cluster cold(0);
  std::vector<Components> columns;
  for (std::size_t k = 0; k < components; ++k) {
    ParticleState& all = cold.system().particles;
    all.velocity = all.angular_velocity = VectorField(spheres);
    const Vector3 unit = {k % 3 == 0 ? 1.0 : 0, k % 3 == 1 ? 1.0 : 0, k % 3 == 2 ? 1.0 : 0};
    (k < 3 * spheres ? all.velocity : all.angular_velocity).set(k / 3 % spheres, unit);
    columns.push_back(cold.loads());
    for (double& element : columns.back()) {
      element = -element;
    }
  }
  return columns;
}

TEST(ClusterNoise, FeltResistanceIsSymmetric) {
  const std::vector<Components> R = felt_resistance();
  for (std::size_t a = 0; a < components; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NEAR(R[a][b], R[b][a], 1e-12 * std::sqrt(R[a][a] * R[b][b]));
    }
  }
}

TEST(ClusterNoise, FirstTwoSpheresActThroughTwoImages) {
  Cluster warm(thermal_energy);
  std::size_t images = 0;
  for (const Pair& pair : warm.system().list.pairs()) {
    images += pair.first == 0 && pair.second == 1 ? 1 : 0;
  }
  EXPECT_EQ(images, 2U);
}

TEST(ClusterNoise, SampledCovarianceEqualsTheFeltResistance) {
  const std::vector<Components> R = felt_resistance();
  Cluster warm(thermal_energy);
  SampledCovariance sampled(components);
  for (std::uint64_t step = 0; step < samples; ++step) {
    warm.system().step = step;
    sampled.add(warm.loads());
  }
  const auto expected = [&R](std::size_t a, std::size_t b) {
    return 2 * thermal_energy / timestep * R[a][b];
  };
  EXPECT_LT(sampled.largest_deviation(expected), largest_sigma);
  EXPECT_LT(sampled.largest_mean(expected), largest_sigma);
}

}  // namespace
}  // namespace peclet::engine
