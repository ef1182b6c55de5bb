// The pressure of Brownian spheres at rest is that of hard spheres, a known number. All terms of the stress
// enter, and the motion contributes a quarter here.
//
// 16 windows of 50 Brownian times give a standard error of about 0.3 %. The test allows two standard errors
// plus 1 %: the equation may be off by 0.3 %, the automatic step by about 0.5 %.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "engine/scene/scene.h"
#include "tests/physics/estimates.h"

namespace peclet::engine {
namespace {

constexpr double volume_fraction = 0.3, kT = 0.017, stiffness = 1e4, second_radius = 1.4;

// Sources: Boublik (1970), J. Chem. Phys. 53, 471; Mansoori, Carnahan, Starling & Leland (1971), J. Chem.
// Phys. 54, 1523. Diameters are reduced by the contact softness, the integral of 1 - exp(-k_n s^2 / 2 kT)
// over the overlap s.
double expected_pressure() {
  const double softness = std::sqrt(std::numbers::pi * kT / (2 * stiffness));
  const double weights[] = {1, std::pow(second_radius, -3)}, radii[] = {1, second_radius};
  double moment[4] = {}, full = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const double share = weights[s] / (weights[0] + weights[1]);
    for (int k = 1; k <= 3; ++k) moment[k] += share * std::pow(2 * radii[s] - softness, k);
    full += share * std::pow(2 * radii[s], 3);
  }
  const double density = volume_fraction / (std::numbers::pi / 6 * full);
  const double packed = volume_fraction * moment[3] / full, empty = 1 - packed;
  return density * kT *
         (1 / empty + 3 * packed * moment[1] * moment[2] / (moment[3] * empty * empty) +
          packed * packed * (3 - packed) * std::pow(moment[2], 3) /
              (moment[3] * moment[3] * std::pow(empty, 3)));
}

Scene scene_at_rest() {
  Json document = Json::parse(R"({
      "particles": {"count": 250, "density": 0.1,
                    "species": [{"volume_share": 1, "radius": 1}, {"volume_share": 1}]},
      "fluid": {"viscosity": 0.1}, "flow": {"shear_rate": 0},
      "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
      "duration": {"equilibration": {"brownian_times": 20}, "production": {"brownian_times": 200}}})");
  document["particles"]["species"][1]["radius"] = second_radius;
  document["volume_fraction"] = volume_fraction;
  document["fluid"]["thermal_energy"] = kT;
  document["contact"] = {{"normal_stiffness", stiffness}};
  return read_scene(document, "scene.json");
}

TEST(Pressure, AtRestIsThatOfHardSpheres) {
  const Scene scene = scene_at_rest();
  const double expected = expected_pressure();
  std::vector<double> ratios;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Schedule schedule = make_schedule(scene, "scene.json");
    Simulation simulation(scene, schedule, seed, 1, "scene.json");
    simulation.start();
    ASSERT_EQ(simulation.advance(schedule.total())->cause, Ending::Cause::completed);
    const auto& blocks = simulation.production().blocks();
    constexpr std::size_t of_quarter = count_of_blocks / 4;
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      const BlockSums sums =
          sum_of(std::span<const BlockSums>(blocks).subspan(quarter * of_quarter, of_quarter));
      SymmetricTensor stress = sums.motion;
      for (const SymmetricTensor& term : sums.stress) stress += term;
      const double volume = simulation.system().box.volume() * static_cast<double>(sums.steps);
      ratios.push_back(-(stress.xx + stress.yy + stress.zz) / (3 * volume * expected));
    }
  }
  const Estimate ratio = estimate(ratios);
  RecordProperty("ratio", std::to_string(ratio.mean));
  EXPECT_LT(ratio.error, 0.005);
  EXPECT_NEAR(ratio.mean, 1, 0.01 + 2 * ratio.error) << "+- " << ratio.error;
}

}  // namespace
}  // namespace peclet::engine
