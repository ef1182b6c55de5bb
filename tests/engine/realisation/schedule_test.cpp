// Steps of the phases, counted by hand.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Expects these steps of phases of a scene with dt = 0.002, rate 2, eta = 0.1 and kT = 0.02.
void expect_steps(const Json& equilibration, const Json& production,
                  const std::array<std::uint64_t, 2>& steps) {
  Json document = small_scene();
  document["particles"]["reference_radius"] = 1.4;
  document["duration"] = {{"equilibration", equilibration}, {"production", production}};
  const Schedule schedule = make_schedule(read_scene(document, "scene.json"), "scene.json");
  EXPECT_EQ(schedule.equilibration, steps[0]);
  EXPECT_EQ(schedule.production, steps[1]);
}

// eta a^3 / kT = 0.1 * 2.744 / 0.02 = 13.72 with the reference radius of 1.4, without the factor 6 pi.
TEST(Schedule, ABrownianTimeIsEtaACubedOverTheThermalEnergy) {
  expect_steps({{"brownian_times", 0.05}}, {{"brownian_times", 0.5}}, {343, 3430});
}

TEST(Schedule, AStrainIsRateTimesTime) { expect_steps({{"strain", 0.4}}, {{"strain", 4}}, {100, 1000}); }

TEST(Schedule, TheFirstLimitThatIsReachedEndsAPhase) {
  expect_steps({{"strain", 0.4}, {"brownian_times", 0.05}}, {{"strain", 40}, {"brownian_times", 0.5}},
               {100, 3430});
}

// 200 times 4.9e10 steps are below 10^13, 5.1e10 are not; at 10^6 a second 10^13 are 0.3 years.
TEST(Schedule, SaysWhichSeedsTakeMonths) {
  const auto warnings = [](std::uint64_t steps) {
    Scene scene = read_scene(small_scene(), "scene.json");
    scene.particles.count = 200;
    return schedule_warnings(scene, {0.1, 0, steps});
  };
  EXPECT_TRUE(warnings(49'000'000'000).empty());
  EXPECT_NE(warnings(51'000'000'000).at(0).message.find("of the order of 0.3 years"), std::string::npos);
}

// A cycle of 2 has 1000 steps of 0.002, rounded up for other steps; a step is at most a 128th of a cycle.
TEST(Schedule, CyclesHaveWholeNumbersOfSteps) {
  const auto schedule_of_cycles = [](double frequency, double timestep) {
    Json document = small_scene();
    document["flow"] = {{"oscillation", {{"amplitude", 0.01}, {"frequency", frequency}}}};
    document["integrator"]["timestep"] = timestep;
    document["duration"] = {{"equilibration", {{"cycles", 2}}}, {"production", {{"cycles", 3}}}};
    return make_schedule(read_scene(document, "scene.json"), "scene.json");
  };
  const Schedule given = schedule_of_cycles(std::numbers::pi, 0.002);
  EXPECT_EQ(given.equilibration, 2000u);
  EXPECT_EQ(given.production, 3000u);
  EXPECT_DOUBLE_EQ(given.timestep, 0.002);
  EXPECT_EQ(given.timestep_limit, std::string("given"));
  const Schedule shortened = schedule_of_cycles(std::numbers::pi, 0.0021);  // 952.4 of them
  EXPECT_EQ(shortened.production, 3u * 953u);
  EXPECT_DOUBLE_EQ(shortened.timestep, 2.0 / 953);
  const Schedule fast = schedule_of_cycles(100 * std::numbers::pi, 0.002);  // a cycle of 0.02
  EXPECT_EQ(fast.production, 3u * 128u);
  EXPECT_DOUBLE_EQ(fast.timestep, 0.02 / 128);
  EXPECT_EQ(fast.timestep_limit, std::string("cycle"));
}

}  // namespace
}  // namespace peclet::engine
