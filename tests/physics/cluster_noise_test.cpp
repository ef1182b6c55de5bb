// Fluctuation–dissipation for a cluster: the noise of the whole force field has the covariance of its
// resistance, with pairs, images and drag together. The resistance is that of forces at unit velocities.
//
// False failures with fresh seeds: 2.5e-5. There are 2 x (24 * 25 / 2 + 24) deviations, and each passes 5.5
// standard deviations with probability 3.8e-8.
#include <gtest/gtest.h>

#include "tests/engine/few_spheres.h"
#include "tests/engine/linear_algebra.h"
#include "tests/physics/laboratory.h"
#include "tests/physics/sampled_covariance.h"

namespace peclet::engine {
namespace {

constexpr double largest_sigma = 5.5;
constexpr double thermal_energy = 0.3, timestep = 2e-3;
constexpr std::uint64_t samples = 150000;
constexpr Eigen::Index spheres = 4, components = 6 * spheres;

using Components = Eigen::Vector<double, components>;  // forces of all spheres, then torques
using Matrix = Eigen::Matrix<double, components, components>;
using Form = LubricationParameters::Form;

// Returns four spheres in an inclined cell hardly wider than two unit spheres, so that the first two touch
// through two images.
System cluster(const Physics& physics) {
  System system = spheres_in({4.02, 6.0, 7.0}, physics, {1.0, 1.0, 1.4, 0.5}, 1);
  system.box = PeriodicCell({4.02, 6.0, 7.0}, simple_shear(0), /*tilt=*/1.3);
  system.particles.position.set(0, {0.3, 0.3, 3.0});
  system.particles.position.set(1, {2.305, 0.31, 3.02});
  system.particles.position.set(2, Vector3{0.3, 0.3, 3.0} + 2.42 * Vector3{0.48, 0.64, 0.6});
  system.particles.position.set(3, Vector3{2.305, 0.31, 3.02} + 1.505 * Vector3{0.48, -0.6, -0.64});
  rebuild_neighbours(system);
  return system;
}

class Cluster {
 public:
  Cluster(Form form, double temperature)
      : system_(cluster(physics(form, temperature))),
        field_(physics(form, temperature), system_.particles, timestep, /*seed=*/77, /*threads=*/1) {}

  Components loads() {
    field_.evaluate(system_, force_, torque_);
    Components all;
    for (Eigen::Index i = 0; i < spheres; ++i) {
      all.segment<3>(3 * i) = to_eigen(force_[static_cast<std::size_t>(i)]);
      all.segment<3>(3 * (spheres + i)) = to_eigen(torque_[static_cast<std::size_t>(i)]);
    }
    return all;
  }

  System& system() { return system_; }

 private:
  static Physics physics(Form form, double temperature) {
    Physics physics;
    physics.viscosity = 0.7;
    physics.thermal_energy = temperature;
    physics.lubrication =
        LubricationParameters{.inner_gap = 1e-3, .outer_gap = 0.05, .form = form, .outer_distance = 0.05};
    return physics;
  }

  System system_;
  ForceField field_;
  VectorField force_{spheres}, torque_{spheres};
};

// Returns the resistance, column by column, from unit velocities and spins of one sphere after another.
Matrix felt_resistance(Form form) {
  Cluster cold(form, 0);
  Matrix R;
  for (Eigen::Index k = 0; k < components; ++k) {
    ParticleState& all = cold.system().particles;
    all.velocity = all.angular_velocity = VectorField(spheres);
    const Vector3 unit = {k % 3 == 0 ? 1.0 : 0, k % 3 == 1 ? 1.0 : 0, k % 3 == 2 ? 1.0 : 0};
    (k < 3 * spheres ? all.velocity : all.angular_velocity)
        .set(static_cast<std::size_t>(k / 3 % spheres), unit);
    R.col(k) = -cold.loads();
  }
  return R;
}

// The flow is at rest, so lubrication of the form mari sees the velocities themselves.
class ClusterNoise : public testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Of, ClusterNoise, testing::Values(Form::kim_karrila, Form::mari),
                         [](const auto& form) { return form.param == Form::mari ? "Mari" : "KimKarrila"; });

TEST_P(ClusterNoise, FeltResistanceIsSymmetric) {
  const Matrix R = felt_resistance(GetParam());
  for (Eigen::Index a = 0; a < components; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      EXPECT_NEAR(R(a, b), R(b, a), 1e-12 * std::sqrt(R(a, a) * R(b, b)));
    }
  }
}

TEST_P(ClusterNoise, FirstTwoSpheresActThroughTwoImages) {
  Cluster warm(GetParam(), thermal_energy);
  std::size_t images = 0;
  for (const Pair& pair : warm.system().list.pairs()) images += pair.first == 0 && pair.second == 1 ? 1 : 0;
  EXPECT_EQ(images, 2U);
}

TEST_P(ClusterNoise, SampledCovarianceEqualsTheFeltResistance) {
  const Matrix expected = 2 * thermal_energy / timestep * felt_resistance(GetParam());
  Cluster warm(GetParam(), thermal_energy);
  SampledCovariance sampled(components);
  for (std::uint64_t step = 0; step < samples; ++step) {
    warm.system().step = step;
    sampled.add(warm.loads());
  }
  EXPECT_LT(sampled.largest_deviation(expected), largest_sigma);
  EXPECT_LT(sampled.largest_mean(expected), largest_sigma);
}

}  // namespace
}  // namespace peclet::engine
