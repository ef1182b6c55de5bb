// The flow of a scene: valid blocks and their meaning.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/flow/controlled_shear.h"
#include "engine/integrators/derived_groups.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/schedule.h"
#include "engine/scene/scene.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

Scene flowing(const Json& flow, const Json& equilibration, const Json& production) {
  Json document = small_scene();
  document["flow"] = flow;
  document["duration"] = {{"equilibration", equilibration}, {"production", production}};
  return read_scene(document, "scene.json");
}

const Json reversed = Json::parse(R"({"segments": [{"shear_rate": 2, "strain": 3}, {"shear_rate": -2}]})");

TEST(FlowBlock, ReadsAReversal) {
  const Scene scene = flowing(reversed, {{"strain", 3}}, {{"strain", 5}});
  EXPECT_EQ(scene.physics.flow.deformation().velocity_gradient(1), simple_shear(2));
  EXPECT_EQ(scene.physics.flow.deformation().velocity_gradient(2), simple_shear(-2));
  EXPECT_EQ(scene.physics.flow.steady_rate(), 2);  // in the window
  EXPECT_EQ(scene.physics.flow.shear_part({.xy = -3}), 3);
  const Schedule schedule = make_schedule(scene, "scene.json");
  EXPECT_EQ(schedule.equilibration, 750u);  // steps of 0.002
  EXPECT_EQ(schedule.production, 1250u);
}

// A window that begins before the last segment has no steady rate.
TEST(FlowBlock, HasNoSteadyRateAcrossSegments) {
  EXPECT_EQ(flowing(reversed, {{"strain", 2}}, {{"strain", 5}}).physics.flow.steady_rate(), 0);
}

TEST(FlowBlock, ReadsRampsAndStops) {
  const Json segments = Json::parse(R"([{"shear_rate": 0, "final_rate": 2, "time": 1},
                                        {"shear_rate": 2, "strain": 4}, {"shear_rate": 0}])");
  const Scene scene = flowing({{"segments", segments}}, {{"strain", 5}}, {{"time", 1}});
  const Deformation& flow = scene.physics.flow.deformation();
  EXPECT_EQ(flow.velocity_gradient(0.5), simple_shear(1));
  EXPECT_EQ(flow.velocity_gradient(2.5), simple_shear(2));
  EXPECT_EQ(flow.velocity_gradient(3.5), simple_shear(0));
  EXPECT_DOUBLE_EQ(time_of(scene.equilibration, scene), 3);
}

TEST(FlowBlock, ReadsShearAcross) {
  const Scene scene =
      flowing(Json::parse(R"({"shear_rate": 2, "cross_shear": {"amplitude": 0.1, "frequency": 20}})"),
              {{"cycles", 2}}, {{"strain", 5}, {"cycles", 2}});
  EXPECT_EQ(scene.physics.flow.steady_rate(), 2);
  EXPECT_DOUBLE_EQ(time_of(scene.equilibration, scene), 2 * 2 * M_PI / 20);
  EXPECT_DOUBLE_EQ(time_of(scene.production, scene), 2.5);
  EXPECT_EQ(scene.physics.flow.deformation().swing()->component, &SymmetricTensor::yz);
}

// A Brownian time is 5 and a cycle 2 pi / 20. A window of moduli has whole cycles, rounded up.
TEST(FlowBlock, RoundsAnOscillationUpToWholeCycles) {
  constexpr double period = 2 * M_PI / 20;
  const auto cycles_of = [&](Json flow, const Json& equilibration) {
    Json document = small_scene({{"observables", {"oscillation"}}});
    document["flow"] = std::move(flow);
    document["duration"] = {{"equilibration", equilibration}, {"production", {{"time", 3.2 * period}}}};
    const Scene scene = read_scene(document, "scene.json");
    const Schedule schedule = make_schedule(scene, "scene.json");
    EXPECT_NEAR(schedule.timestep * static_cast<double>(schedule.production), 4 * period, 1e-9);
    const double cycles = schedule.timestep * static_cast<double>(schedule.equilibration) / period;
    EXPECT_NEAR(cycles, std::round(cycles), 1e-9);
    return std::lround(cycles);
  };
  const Json alone = Json::parse(R"({"oscillation": {"amplitude": 0.01, "frequency": 20}})");
  const Json across =
      Json::parse(R"({"shear_rate": 0.1, "cross_shear": {"amplitude": 0.1, "frequency": 20}})");
  for (const Json& flow : {alone, across}) {
    EXPECT_EQ(cycles_of(flow, {{"cycles", 2}}), 2);
    EXPECT_EQ(cycles_of(flow, {{"brownian_times", 1}}), 16);  // 15.9 rounded up
    EXPECT_EQ(cycles_of(flow, {{"cycles", 2}, {"brownian_times", 1}}), 16);
    EXPECT_EQ(cycles_of(flow, {{"cycles", 20}, {"brownian_times", 1}}), 20);
    EXPECT_EQ(cycles_of(flow, {{"brownian_times", 1}, {"time", 1.5 * period}}), 2);
    EXPECT_EQ(cycles_of(flow, {{"cycles", 0}}), 0);
    EXPECT_EQ(cycles_of(flow, {{"time", 0}}), 0);
  }
  EXPECT_EQ(cycles_of(across, {{"strain", 0.1}}), 4);  // 3.2 rounded up
}

TEST(FlowBlock, CountsExtensionInHenckyStrains) {
  const Scene scene = flowing({{"extension_rate", 0.5}}, {{"strain", 1}}, {{"strain", 2}});
  EXPECT_EQ(scene.physics.flow.steady_rate(), 1);
  EXPECT_DOUBLE_EQ(time_of(scene.production, scene), 4);
}

// sqrt(2 E:E) of diag(1, -1/2, -1/2) is sqrt(3).
TEST(FlowBlock, ReadsUniaxialAndBiaxialExtension) {
  for (const double rate : {0.5, -0.5}) {
    const Scene scene = flowing({{"uniaxial_rate", rate}}, {{"strain", 1}}, {{"strain", 2}});
    EXPECT_DOUBLE_EQ(scene.physics.flow.steady_rate(), 0.5 * std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(time_of(scene.production, scene), 4);
    EXPECT_EQ(scene.physics.flow.rate(), 0.5);
  }
}

// At stress 3 and viscosity 0.1 the unit of time is 1/30.
TEST(FlowBlock, CountsTimesOfAStress) {
  const Scene scene = flowing({{"stress", 3}}, {{"stress_times", 30}}, {{"stress_times", 60}});
  EXPECT_DOUBLE_EQ(time_of(scene.equilibration, scene), 1);
  EXPECT_DOUBLE_EQ(time_of(scene.production, scene), 2);
  EXPECT_EQ(scene.physics.flow.steady_rate(), 0);
  EXPECT_EQ(scene.physics.flow.deformation().at_stress()->stress(), 3);
  EXPECT_FALSE(derived_groups(scene).peclet.has_value());
  // (1 - 0.45 / 0.65)^1.6 times stress / viscosity.
  EXPECT_NEAR(scene.physics.flow.rate(), 30 * std::pow(0.2 / 0.65, 1.6), 1e-12);
}

}  // namespace
}  // namespace peclet::engine
