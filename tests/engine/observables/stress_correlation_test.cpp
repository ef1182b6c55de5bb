// The correlation of the structural stress, for pairs that are fixed or alternate between near and far.
#include <gtest/gtest.h>

#include "engine/kernels/pair_kinds.h"
#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

// A pair within both shells has the stress -A n n, A = 2 * 20 kT / V, for any n. Its traceless part squared
// is 2/3 A^2, and G = (V / kT) / 10 of that at all lags while nothing moves.
TEST(StressCorrelation, OfAFrozenPairIsTheSquareOfItsTracelessStress) {
  const Scene scene = scene_with("stress_correlation");
  constexpr double thermal_energy = 2, volume = edge * edge * edge;
  constexpr double stress = 2 * 20 * thermal_energy / volume;
  constexpr double modulus = volume / thermal_energy / 10 * 2 / 3 * stress * stress;
  for (const Vector3& along : {Vector3{1, 0, 0}, Vector3{1, -1, 0}, Vector3{1, 2, 3}}) {
    System system = loose_spheres(2);
    system.particles.position.set(0, {5, 5, 5});
    system.particles.position.set(1, Vector3{5, 5, 5} + (3.01 / norm(along)) * along);
    system.list = NeighbourList(range_table(make_pair_kinds(scene.physics, {1, 2}), 2), 0.1);
    system.list.build(system.particles, system.box);
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
  constexpr double thermal_energy = 2, volume = edge * edge * edge;
  constexpr double stress = 2 * 20 * thermal_energy / volume;
  constexpr double modulus = volume / thermal_energy / 10 * 2 / 3 * stress * stress;
  const auto with_gap = [&](double gap) {
    System system = loose_spheres(2);
    system.particles.position.set(0, {5, 5, 5});
    system.particles.position.set(1, {8 + gap, 5, 5});
    system.list = NeighbourList(range_table(make_pair_kinds(scene.physics, {1, 2}), 2), 0.1);
    system.list.build(system.particles, system.box);
    return system;
  };
  const System near = with_gap(0.01), far = with_gap(0.5);
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
