// Transients of known stresses.
#include <gtest/gtest.h>

#include "tests/engine/observables/loose_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

constexpr double viscosity = 0.1, fraction = 0.45, background = 1 + 2.5 * fraction;

Scene flowing(const Json& flow, const Json& equilibration) {
  Json document = small_scene();
  document["flow"] = flow;
  document["observables"] = {"transient"};
  document["transient"] = {{"bins", 4}};
  document["duration"] = {{"equilibration", equilibration}, {"production", {{"time", 4}}}};
  return read_scene(document, "scene.json");
}

struct Measured {
  Json transient;
  std::vector<Quantity> quantities;
};

// Measures a pair stress that doubles in each of four parts of ten steps, with the clock at a step's end.
Measured measured(const Scene& scene, double begin) {
  System system = loose_spheres(4);
  const double volume = edge * edge * edge;
  system.clock = {begin, 0.1, 0};
  const auto made = observable_of(scene, system, 40, 0.1);
  for (int k = 0; k < 40; ++k) {
    ++system.clock.steps;
    MomentumFlux flux;
    const double s = 1 << (k / 10);
    flux.by_pairs = {.xx = 2 * volume * s, .yy = 5 * volume * s, .zz = -volume * s, .xy = volume * s};
    made->take_flux(flux);
    made->sample(system, 0);
  }
  return {mean_of(*made).at("transient"), made->quantities()};
}

// Reversal from rate 2 to -2, with 0.2 as the unit: pairs still push in the old direction and count negative.
TEST(Transient, IsThatOfTheReversedFlow) {
  const Scene scene = flowing(
      Json::parse(R"({"segments": [{"shear_rate": 2, "time": 1}, {"shear_rate": -2}]})"), {{"time", 1}});
  const auto [transient, all] = measured(scene, 1);
  for (std::size_t k = 0; k < 4; ++k) {
    const double s = (1 << k) / (2 * viscosity);
    EXPECT_NEAR(transient["shear_stress"][k].get<double>(), background - s, 1e-12);
    EXPECT_NEAR(transient["first_normal_difference"][k].get<double>(), -3 * s, 1e-12);
    EXPECT_NEAR(transient["second_normal_difference"][k].get<double>(), 6 * s, 1e-12);
    EXPECT_NEAR(transient["pressure"][k].get<double>(), -2 * s, 1e-12);
  }
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all.front().unit, "η γ̇");
  EXPECT_EQ(all.front().axes.front().name, "strain");
  EXPECT_EQ(all.front().axes.front().values, Json::array({1, 3, 5, 7}));  // of 8
}

// After a stop the solvent has no stress, and no rate gives a unit.
TEST(Transient, IsInUnitsOfTheSceneWhereTheFlowHasStopped) {
  const Scene scene = flowing(
      Json::parse(R"({"segments": [{"shear_rate": 2, "time": 1}, {"shear_rate": 0}]})"), {{"time", 1}});
  const auto [transient, all] = measured(scene, 1);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(transient["shear_stress"][k].get<double>(), 1 << k, 1e-12);
  EXPECT_EQ(all.front().unit, "stress");
  EXPECT_EQ(all.front().axes.front().name, "time");
  EXPECT_EQ(all.front().axes.front().values, Json::array({0.5, 1.5, 2.5, 3.5}));
}

// (sigma_xx - sigma_yy) / (4 rate) of the solvent is its viscosity: 1 in units of 2 rate viscosity.
TEST(Transient, OfExtensionIsTheExtensionalViscosity) {
  const Scene scene = flowing({{"extension_rate", 0.5}}, {{"time", 1}});
  const auto [transient, all] = measured(scene, 1);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(transient["shear_stress"][k].get<double>(),
                background + (2.0 - 5.0) * (1 << k) / 2 / viscosity, 1e-12);
  }
}

class TransientOfEither : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Method, TransientOfEither, testing::Values("explicit", "implicit"),
                         [](const auto& method) { return std::string(method.param); });

// Spheres without neighbours add 2.5 phi. The mean rate in a part of a ramp is that at its middle. Sampling
// at the end of a step would shift the first part by 2 % in explicit steps, by 0.5 % in implicit ones.
TEST_P(TransientOfEither, OfADiluteRampIsThatOfTheMiddleOfEachPart) {
  constexpr double dilute = 0.02, last_rate = 2;
  constexpr int parts = 10;
  Json document = small_scene(
      {{"particles", {{"count", 4}}},
       {"volume_fraction", dilute},
       {"fluid", {{"thermal_energy", nullptr}}},
       {"observables", {"transient"}},
       {"transient", {{"bins", parts}}},
       {"integrator", {{"method", GetParam()}, {"timestep", GetParam()[0] == 'e' ? 0.002 : 0.0005}}},
       {"duration", {{"equilibration", {{"time", 0}}}, {"production", {{"time", 1}}}}}});
  document["flow"] = {
      {"segments", {{{"shear_rate", 0}, {"final_rate", last_rate}, {"time", 1}}, {{"shear_rate", 0}}}}};
  Simulation simulation = started(read_scene(document, "scene.json"), 3);
  ASSERT_EQ(simulation.advance(2000)->cause, Ending::Cause::completed);
  const std::vector<double> stresses =
      mean_of(*simulation.observables().front()).at("transient").at("shear_stress");
  ASSERT_EQ(static_cast<int>(stresses.size()), parts);
  double middle = 0.5;
  for (const double stress : stresses) {
    const double expected = viscosity * (1 + 2.5 * dilute) * last_rate * middle / parts;
    EXPECT_NEAR(stress, expected, 1e-3 * expected) << "part " << middle;
    ++middle;
  }
}

}  // namespace
}  // namespace peclet::engine
