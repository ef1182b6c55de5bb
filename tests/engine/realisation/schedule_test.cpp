// Steps of the phases, counted by hand.
#include <gtest/gtest.h>

#include "engine/realisation/simulation.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

Schedule schedule_of(const Json& equilibration, const Json& production) {
  Json document = small_scene();  // dt = 0.002, rate 2, eta = 0.1, kT = 0.02
  document["particles"]["reference_radius"] = 1.4;
  document["duration"] = {{"equilibration", equilibration}, {"production", production}};
  return make_schedule(read_scene(document, "scene.json"), "scene.json");
}

// eta a^3 / kT = 0.1 * 2.744 / 0.02 = 13.72 with the reference radius of 1.4; without 6 pi.
TEST(Schedule, ABrownianTimeIsEtaACubedOverTheThermalEnergy) {
  const Schedule schedule = schedule_of({{"brownian_times", 0.05}}, {{"brownian_times", 0.5}});
  EXPECT_EQ(schedule.equilibration, 343u);
  EXPECT_EQ(schedule.production, 3430u);
}

TEST(Schedule, AStrainIsRateTimesTime) {
  const Schedule schedule = schedule_of({{"strain", 0.4}}, {{"strain", 4}});
  EXPECT_EQ(schedule.equilibration, 100u);
  EXPECT_EQ(schedule.production, 1000u);
}

TEST(Schedule, TheFirstLimitThatIsReachedEndsAPhase) {
  const Schedule schedule =
      schedule_of({{"strain", 0.4}, {"brownian_times", 0.05}}, {{"strain", 40}, {"brownian_times", 0.5}});
  EXPECT_EQ(schedule.equilibration, 100u);
  EXPECT_EQ(schedule.production, 3430u);
}

}  // namespace
}  // namespace peclet::engine
