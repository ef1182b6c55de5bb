// The correlation of the structural stress, for pairs that are fixed or alternate between near and far.
#include <gtest/gtest.h>

#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

constexpr double pair_energy = 2, pair_volume = edge * edge * edge;
// A pair within both shells has the stress -A n n, A = 2 * 20 kT / V, for any n. Its traceless part squared
// is 2/3 A^2, and G = (V / kT) / 10 of that at all lags while nothing moves.
constexpr double pair_stress = 2 * 20 * pair_energy / pair_volume;
constexpr double modulus = pair_volume / pair_energy / 10 * 2 / 3 * pair_stress * pair_stress;

// Returns a pair of spheres at this separation.
System pair_apart(const Scene& scene, const Vector3& separation) {
  System system = loose_spheres(2);
  system.particles.position.set(0, {5, 5, 5});
  system.particles.position.set(1, Vector3{5, 5, 5} + separation);
  build_list(system, scene.physics);
  return system;
}

TEST(StressCorrelation, OfAFrozenPairIsTheSquareOfItsTracelessStress) {
  const Scene scene = scene_with("stress_correlation");
  for (const Vector3& along : {Vector3{1, 0, 0}, Vector3{1, -1, 0}, Vector3{1, 2, 3}}) {
    const System system = pair_apart(scene, (3.01 / norm(along)) * along);
    const auto observable = observable_of(scene, system, 256);
    for (int k = 0; k < 256; ++k) observable->sample(system, 0);
    const Json mean = mean_of(*observable);
    const Json& found = mean["stress_correlation"];
    EXPECT_GT(found["time"].size(), 16u);
    for (std::size_t k = 0; k < found["time"].size(); ++k) {
      const double viscosity = modulus * found["time"][k].get<double>() / scene.physics.viscosity;
      EXPECT_NEAR(found["modulus"][k].get<double>(), modulus, 1e-12 * modulus);
      EXPECT_NEAR(found["viscosity"][k].get<double>(), viscosity, 1e-12 * viscosity);
    }
    EXPECT_EQ(mean["green_kubo_viscosity"], found["viscosity"].back());
  }
}

// A pair that is near at every other sample has the stress A, 0, A, 0 .... The correlation is A^2 / 2 at even
// lags, 0 at odd lags, and A^2 / 4 for means over two samples, from lag 16 on. The trapezia have the mean
// height A^2 / 4; the one from lag 15 to 16 is half as high.
TEST(StressCorrelation, IsIntegratedByTrapezia) {
  const Scene scene = scene_with("stress_correlation");
  const System near = pair_apart(scene, {3.01, 0, 0}), far = pair_apart(scene, {3.5, 0, 0});
  const auto observable = observable_of(scene, near, 256);
  for (int k = 0; k < 128; ++k) {
    observable->sample(near, 0);
    observable->sample(far, 0);
  }
  const Json found = mean_of(*observable)["stress_correlation"];
  const double sample = found["time"][1];
  ASSERT_GT(found["time"].size(), 17u);
  for (std::size_t k = 0; k < 18; ++k) {
    const double expected = k > 15 ? 0.25 : k % 2 == 0 ? 0.5 : 0;
    EXPECT_NEAR(found["modulus"][k].get<double>() / modulus, expected, 1e-12) << k;
    const double area = 0.25 * found["time"][k].get<double>() / sample - (k > 15 ? 0.125 : 0);
    EXPECT_NEAR(found["viscosity"][k].get<double>() * scene.physics.viscosity / modulus / sample, area, 1e-12)
        << k;
  }
}

}  // namespace
}  // namespace peclet::engine
