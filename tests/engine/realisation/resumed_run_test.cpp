// A run ends in the same bits if cut and resumed.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "engine/realisation/checkpoint.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

constexpr std::uint64_t run_seed = 3, total_steps = 420;

// A way to step, with its patch of the scene.
struct Way {
  const char* name;
  Json patch;
};
Json dividing_at(double displacement) { return {{"guard", {{"largest_displacement", displacement}}}}; }
const Json waves = Json::parse(R"({"flow": {"waves": [{"periods": 1, "sine": 0.4}], "faxen": true}})");
const Json kinetic = Json::parse(R"({"contact": {"kinetic_friction": 0.3}})");
const Json without_rolling =
    Json::parse(R"({"contact": {"rolling_stiffness": null, "rolling_friction": null}})");
const Way ways[] = {
    {"explicit", Json::object()},
    {"implicit", implicit_and_light},
    {"implicit_without_noise", together({implicit_and_light, without_noise})},
    {"implicit_with_divided_steps", together({implicit_and_light, dividing_at(0.01)})},
    {"implicit_without_noise_with_divided_steps",
     together({implicit_and_light, without_noise, dividing_at(0.04)})},
    {"with_strained_lubrication_in_waves", together({strained_lubrication, waves})},
    {"implicit_with_strained_lubrication_in_waves",
     together({strained_lubrication, waves, implicit_and_light, without_noise})},
    {"with_kinetic_friction", kinetic},
    {"implicit_with_kinetic_friction",
     together({kinetic, without_rolling, implicit_and_light, without_noise})},
    {"with_every_observable_of_a_flow", Json::parse(R"({
         "pair_distribution": {"range": 3}, "observables": [
         "mean_squared_displacement", "pair_distribution", "contact_network",
         "fabric", "profiles", "trajectory"]})")},
};
const auto name_of_way = [](const auto& way) { return std::string(way.param.name); };

class ResumedRun : public testing::TestWithParam<Way> {
 protected:
  Simulation simulation(int threads = 1) const { return simulation_of(scene_, run_seed, threads); }
  Simulation started(int threads = 1) const { return engine::started(scene_, run_seed, threads); }

  // Returns the final state of the uninterrupted run.
  const std::string& uncut() const {
    static std::map<std::string, std::string> bytes;
    std::string& of_method = bytes[GetParam().name];
    if (of_method.empty()) {
      Simulation whole = started();
      EXPECT_TRUE(whole.advance(total_steps).has_value());
      of_method = bytes_of(whole);
    }
    return of_method;
  }

  static std::size_t stretched_springs(const System& system) {
    return held_contacts(system.list, system.particles, system.springs).size();
  }

  Scene scene_ = scene_from(GetParam().patch);
};

// The claims below are weak unless this holds.
TEST_P(ResumedRun, PassesThroughContactsRebuildsAndFlips) {
  Simulation run = started();
  std::size_t steps_with_springs = 0;
  while (!run.advance(1)) steps_with_springs += stretched_springs(run.system()) > 0 ? 1 : 0;
  EXPECT_EQ(run.system().step, total_steps);
  EXPECT_GT(steps_with_springs, 350u);
  EXPECT_GT(run.system().list.builds(), 20u);
  EXPECT_EQ(run.system().box.basis(), flips(2));
  const bool divides = std::string(GetParam().name).ends_with("divided_steps");
  EXPECT_EQ(run.step_errors().divided_steps > 50, divides);
}

TEST_P(ResumedRun, EndsAsTheUncutOneWhereverItWasCut) {
  ASSERT_EQ(simulation().schedule().total(), total_steps);
  expect_the_end_of_the_uncut(scene_, run_seed,
                              {{0, 1}, {1, 1}, {57, 1}, {100, 1}, {101, 1}, {200, 1}, {333, 1}, {419, 1}});
}

TEST_P(ResumedRun, EndsAsTheUncutOneAfterThreeCheckpointsOnDisk) {
  const TemporaryFolder folder;
  const CheckpointIdentity identity = {"scene", run_seed, "binary"};
  auto run = std::make_unique<Simulation>(started());
  for (const std::uint64_t steps : {90U, 111U, 150U}) {  // in equilibration, then twice in production
    EXPECT_FALSE(run->advance(steps).has_value());
    EXPECT_GT(stretched_springs(run->system()), 0u);  // amid frictional contacts
    write_checkpoint(folder / "checkpoint", identity, {1.5, 2.5}, *run);
    run = std::make_unique<Simulation>(simulation());
    const Spent spent = read_checkpoint(folder / "checkpoint", identity, *run);
    EXPECT_EQ(spent.processor_seconds, 1.5);
    EXPECT_EQ(spent.wall_seconds, 2.5);
  }
  EXPECT_TRUE(run->advance(total_steps).has_value());
  EXPECT_TRUE(bytes_of(*run) == uncut());
}

TEST_P(ResumedRun, HasTheSameBitsOnAnyNumberOfThreads) {
  Simulation one = started(1), two = started(2), three = simulation(3);
  one.advance(150);
  two.advance(150);
  EXPECT_TRUE(bytes_of(two) == bytes_of(one));
  load(three, bytes_of(two));  // the number of threads may change
  three.advance(50);
  one.advance(50);
  EXPECT_TRUE(bytes_of(three) == bytes_of(one));
}

INSTANTIATE_TEST_SUITE_P(EveryWay, ResumedRun, testing::ValuesIn(ways), name_of_way);

// Pairs across memory blocks form and part, and lists are rebuilt, before and after the cut.
class ResumedLargeRun : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(EveryWay, ResumedLargeRun, testing::ValuesIn(ways), name_of_way);
TEST_P(ResumedLargeRun, EndsAsTheUncutOne) {
  Json document = small_scene(GetParam().patch);
  document["particles"]["count"] = 5000;
  const Scene scene = read_scene(document, "scene.json");
  Simulation uncut = started(scene, run_seed), resumed = simulation_of(scene, run_seed, 2);
  uncut.advance(97);
  EXPECT_GT(uncut.system().list.crossings(), 500u);
  load(resumed, bytes_of(uncut));
  const std::uint64_t builds = uncut.system().list.builds();
  uncut.advance(60);
  EXPECT_GT(uncut.system().list.builds(), builds);
  resumed.advance(60);
  EXPECT_TRUE(bytes_of(resumed) == bytes_of(uncut));
}

TEST_P(ResumedRun, DoesNotDependOnHowManyStepsAreAskedForAtOnce) {
  Simulation run = started();
  while (!run.advance(7)) {
  }
  EXPECT_TRUE(bytes_of(run) == uncut());
}

TEST_P(ResumedRun, OtherSeedsEndElsewhere) {
  Simulation other = engine::started(scene_, run_seed + 1);
  other.advance(total_steps);
  EXPECT_FALSE(bytes_of(other) == uncut());
}

// Observables that need rest, and the friction that linear_response allows.
class ResumedRunAtRest : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(ResumedRunAtRest, KeepsItsObservables) {
  const auto& [method, scalar] = GetParam();
  const Scene scene = scene_from(together({at_rest,
                                           elastic_contacts,
                                           {{"observables", {"stress_correlation", "linear_response"}},
                                            {"integrator", {{"method", method}}},
                                            {"duration", {{"production", {{"time", 1.2}}}}}}}));
  Simulation uncut = started(scene, run_seed), resumed = simulation_of(scene, run_seed);
  uncut.advance(271);
  load(resumed, bytes_of(uncut));
  uncut.advance(10 * total_steps);
  resumed.advance(10 * total_steps);
  Json expected = Json::object(), mean = Json::object();
  for (const auto& observable : uncut.observables()) observable->add_to(expected);
  for (const auto& observable : resumed.observables()) observable->add_to(mean);
  EXPECT_GT(expected.at(scalar), 0);
  EXPECT_EQ(mean, expected);
}

INSTANTIATE_TEST_SUITE_P(EitherMethod, ResumedRunAtRest,
                         testing::Combine(testing::Values("implicit", "explicit"),
                                          testing::Values("green_kubo_viscosity", "zero_shear_viscosity")));

// Compares a job that is drained at every opportunity with an undisturbed one.
TEST(ResumedJob, ResultEqualsTheUncutOneButForItsCost) {
  const TemporaryFolder folder;
  // A job polls its events after 65536 particle-steps, 1092 steps here.
  JobSpecification job = job_of(small_scene({{"duration", {{"production", {{"time", 9}}}}}}), "", run_seed);
  const Json uncut = run_job(job, {}).value();
  EXPECT_EQ(uncut.at("ending").at("cause"), "completed");

  job.checkpoint = folder / "checkpoint";
  JobEvents drained;
  drained.drain_requested = [] { return true; };
  int drains = 0;
  std::optional<Json> result;
  while (!(result = run_job(job, drained))) {
    ++drains;
    EXPECT_TRUE(std::filesystem::exists(job.checkpoint));
    job.threads = 1 + drains % 2;
  }
  EXPECT_GE(drains, 3);
  EXPECT_GT(result->at("cost").at("cpu_seconds"), 0);
  EXPECT_EQ(without_cost(*result).dump(), without_cost(uncut).dump());
}

}  // namespace
}  // namespace peclet::engine
