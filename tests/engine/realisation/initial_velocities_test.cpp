// Seeds are fixed, so each claim is reproducible. A statistic may deviate by five standard errors, which one
// seed in a hundred thousand would exceed.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

constexpr double rate = 2, thermal_energy = 0.02, count = 3000;

System system_at_start(const Json& patch = Json::object()) {
  Json document = small_scene({{"particles", {{"count", count}}}, {"volume_fraction", 0.1}});
  document.merge_patch(patch);
  document.erase("repulsion");  // no forces that move spheres before the start
  return started(read_scene(document, "scene.json"), 5).system();
}

double product(const Vector3& a, const Vector3& b) { return dot(a, b) / 3; }

// In units of the standard deviations sqrt(kT / m) and sqrt(kT / I), I = 2/5 m a^2: the mean is 0, and the
// mean square is 1 with variance 2 / 3 N. Velocity and spin are uncorrelated.
TEST(InitialVelocities, AreThoseOfEquilibriumAboutTheFlow) {
  const System system = system_at_start();
  const ParticleState& p = system.particles;
  Vector3 mean_velocity, mean_spin;
  double velocity_squared = 0, spin_squared = 0, both = 0;
  for (std::size_t i = 0; i < p.count(); ++i) {
    const double m = 0.1 * 4 * std::numbers::pi / 3 * std::pow(p.radius[i], 3);
    const double inertia = 0.4 * m * p.radius[i] * p.radius[i];
    const Vector3 u = std::sqrt(m / thermal_energy) * (p.velocity[i] - Vector3{rate * p.position[i].y, 0, 0});
    const Vector3 w =
        std::sqrt(inertia / thermal_energy) * (p.angular_velocity[i] - Vector3{0, 0, -0.5 * rate});
    mean_velocity += (1 / count) * u;
    mean_spin += (1 / count) * w;
    velocity_squared += product(u, u) / count;
    spin_squared += product(w, w) / count;
    both += product(u, w) / count;
  }
  for (const Vector3& mean : {mean_velocity, mean_spin}) {
    for (const double component : {mean.x, mean.y, mean.z}) EXPECT_NEAR(component, 0, 5 / std::sqrt(count));
  }
  EXPECT_NEAR(velocity_squared, 1, 5 * std::sqrt(2 / (3 * count)));
  EXPECT_NEAR(spin_squared, 1, 5 * std::sqrt(2 / (3 * count)));
  EXPECT_NEAR(both, 0, 5 / std::sqrt(3 * count));
}

// With one tau_I for all sizes m = 4 pi / 3 rho a_i, a = 1: kT / m for each size.
TEST(InitialVelocities, AreOfTheMassOfEachSize) {
  const System system = system_at_start({{"particles", {{"density_rule", "equal-inertia"}}}});
  const ParticleState& p = system.particles;
  double squares[2] = {0, 0}, number[2] = {0, 0};
  for (std::size_t i = 0; i < p.count(); ++i) {
    const double m = 0.1 * 4 * std::numbers::pi / 3 * p.radius[i];
    const Vector3 u = std::sqrt(m / thermal_energy) * (p.velocity[i] - Vector3{rate * p.position[i].y, 0, 0});
    squares[p.size_class[i]] += product(u, u);
    number[p.size_class[i]] += 1;
  }
  for (const int size : {0, 1}) {
    EXPECT_NEAR(squares[size] / number[size], 1, 5 * std::sqrt(2 / (3 * number[size]))) << size;
  }
}

}  // namespace
}  // namespace peclet::engine
