// A run ends in the same bits if cut and resumed.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/checkpoint.h"
#include "engine/realisation/job.h"
#include "tests/engine/small_scene.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

constexpr std::uint64_t seed = 3;
constexpr std::uint64_t total_steps = 420;

// A way to step, with its patch of the scene.
struct Way {
  const char* name;
  Json patch;
};
const Json strained_lubrication = {{"form", "mari"},
                                   {"inner_gap", nullptr},
                                   {"outer_gap", nullptr},
                                   {"regularisation", 0.03},
                                   {"outer_distance", 0.1}};
const Json waves = {{"waves", {{{"periods", 1}, {"sine", 0.4}}}}, {"faxen", true}};
const Way ways[] = {
    {"explicit", Json::object()},
    // Less inertia, so that large steps resolve part of its range.
    {"implicit", {{"integrator", {{"method", "implicit"}}}, {"particles", {{"density", 0.01}}}}},
    {"implicit_without_noise",
     {{"integrator", {{"method", "implicit"}}},
      {"particles", {{"density", 0.01}}},
      {"fluid", {{"thermal_energy", nullptr}}}}},
    {"implicit_with_divided_steps",
     {{"integrator", {{"method", "implicit"}}},
      {"particles", {{"density", 0.01}}},
      {"guard", {{"largest_displacement", 0.01}}}}},
    {"implicit_without_noise_with_divided_steps",
     {{"integrator", {{"method", "implicit"}}},
      {"particles", {{"density", 0.01}}},
      {"fluid", {{"thermal_energy", nullptr}}},
      {"guard", {{"largest_displacement", 0.04}}}}},
    {"with_strained_lubrication_in_waves", {{"lubrication", strained_lubrication}, {"flow", waves}}},
    {"implicit_with_strained_lubrication_in_waves",
     {{"lubrication", strained_lubrication},
      {"flow", waves},
      {"integrator", {{"method", "implicit"}}},
      {"particles", {{"density", 0.01}}},
      {"fluid", {{"thermal_energy", nullptr}}}}},
    {"with_kinetic_friction", {{"contact", {{"kinetic_friction", 0.3}}}}},
    {"implicit_with_kinetic_friction",
     {{"integrator", {{"method", "implicit"}}},
      {"contact", {{"kinetic_friction", 0.3}, {"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}}},
      {"particles", {{"density", 0.01}}},
      {"fluid", {{"thermal_energy", nullptr}}}}},
    {"with_every_observable_of_a_flow",
     {{"observables",
       {"mean_squared_displacement", "pair_distribution", "contact_network", "fabric", "profiles",
        "trajectory"}},
      {"pair_distribution", {{"range", 3}}}}},
};
const auto name_of_way = [](const auto& way) { return std::string(way.param.name); };

class ResumedRun : public testing::TestWithParam<Way> {
 protected:
  std::unique_ptr<Simulation> simulation(int threads = 1) const {
    return std::make_unique<Simulation>(scene_, make_schedule(scene_, "scene.json"), seed, threads,
                                        "scene.json");
  }
  std::unique_ptr<Simulation> started(int threads = 1) const {
    auto fresh = simulation(threads);
    fresh->start();
    return fresh;
  }

  static std::string bytes_of(const Simulation& simulation) {
    ArchiveWriter archive;
    simulation.save(archive);
    return archive.bytes();
  }

  // Returns the final state of the uninterrupted run.
  const std::string& uncut() const {
    static std::map<std::string, std::string> bytes;
    std::string& of_method = bytes[GetParam().name];
    if (of_method.empty()) {
      const auto whole = started();
      EXPECT_TRUE(whole->advance(total_steps).has_value());
      of_method = bytes_of(*whole);
    }
    return of_method;
  }

  static std::size_t stretched_springs(const System& system) {
    return held_contacts(system.list, system.particles, system.springs).size();
  }

  Scene scene_ = read_scene(small_scene(GetParam().patch), "scene.json");
};

// The claims below are weak unless this holds.
TEST_P(ResumedRun, PassesThroughContactsRebuildsAndFlips) {
  const auto run = started();
  std::size_t steps_with_springs = 0;
  while (!run->advance(1)) steps_with_springs += stretched_springs(run->system()) > 0 ? 1 : 0;
  EXPECT_EQ(run->system().step, total_steps);
  EXPECT_GT(steps_with_springs, 350u);
  EXPECT_GT(run->system().list.builds(), 20u);
  EXPECT_EQ(run->system().box.basis(), flips(2));
  const bool divides = std::string(GetParam().name).ends_with("divided_steps");
  EXPECT_EQ(run->step_errors().divided_steps > 50, divides);
}

TEST_P(ResumedRun, EndsAsTheUncutOneWhereverItWasCut) {
  for (const std::uint64_t cut : {0U, 1U, 57U, 100U, 101U, 200U, 333U, 419U}) {
    const auto before = started();
    before->advance(cut);
    ArchiveWriter archive;
    before->save(archive);
    const auto after = simulation();
    ArchiveReader reader(archive.bytes());
    after->load(reader);
    EXPECT_TRUE(reader.at_end());
    EXPECT_EQ(bytes_of(*after), archive.bytes()) << "cut at " << cut;  // saving loses nothing
    const std::optional<Ending> ending = after->advance(total_steps);
    ASSERT_TRUE(ending.has_value());
    EXPECT_EQ(ending->cause, Ending::Cause::completed);
    EXPECT_TRUE(bytes_of(*after) == uncut()) << "cut at " << cut;
  }
}

TEST_P(ResumedRun, EndsAsTheUncutOneAfterThreeCheckpointsOnDisk) {
  const TemporaryFolder folder;
  const CheckpointIdentity identity = {"scene", seed, "binary"};
  auto run = started();
  for (const std::uint64_t steps : {90U, 111U, 150U}) {  // in equilibration, then twice in production
    EXPECT_FALSE(run->advance(steps).has_value());
    EXPECT_GT(stretched_springs(run->system()), 0u);  // amid frictional contacts
    write_checkpoint(folder / "checkpoint", identity, {1.5, 2.5}, *run);
    run = simulation();
    const Spent spent = read_checkpoint(folder / "checkpoint", identity, *run);
    EXPECT_EQ(spent.processor_seconds, 1.5);
    EXPECT_EQ(spent.wall_seconds, 2.5);
  }
  EXPECT_TRUE(run->advance(total_steps).has_value());
  EXPECT_TRUE(bytes_of(*run) == uncut());
}

TEST_P(ResumedRun, HasTheSameBitsOnAnyNumberOfThreads) {
  const auto one = started(1), two = started(2);
  one->advance(150);
  two->advance(150);
  EXPECT_TRUE(bytes_of(*two) == bytes_of(*one));

  const auto three = simulation(3);  // the number of threads may change
  ArchiveWriter archive;
  two->save(archive);
  ArchiveReader reader(archive.bytes());
  three->load(reader);
  three->advance(50);
  one->advance(50);
  EXPECT_TRUE(bytes_of(*three) == bytes_of(*one));
}

INSTANTIATE_TEST_SUITE_P(EveryWay, ResumedRun, testing::ValuesIn(ways), name_of_way);

// Pairs across memory blocks form and part, and lists are rebuilt, before and after the cut.
class ResumedLargeRun : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(EveryWay, ResumedLargeRun, testing::ValuesIn(ways), name_of_way);
TEST_P(ResumedLargeRun, EndsAsTheUncutOne) {
  Json document = small_scene(GetParam().patch);
  document["particles"]["count"] = 5000;
  const Scene scene = read_scene(document, "scene.json");
  const auto made = [&](int threads) {
    return Simulation(scene, make_schedule(scene, "scene.json"), seed, threads, "scene.json");
  };
  const auto bytes_of = [](const Simulation& simulation) {
    ArchiveWriter archive;
    simulation.save(archive);
    return archive.bytes();
  };
  Simulation uncut = made(1);
  uncut.start();
  uncut.advance(97);
  EXPECT_GT(uncut.system().list.crossings(), 500u);
  const std::string checkpoint = bytes_of(uncut);
  const std::uint64_t builds = uncut.system().list.builds();
  uncut.advance(60);
  EXPECT_GT(uncut.system().list.builds(), builds);
  Simulation resumed = made(2);
  ArchiveReader reader(checkpoint);
  resumed.load(reader);
  resumed.advance(60);
  EXPECT_TRUE(bytes_of(resumed) == bytes_of(uncut));
}

TEST_P(ResumedRun, DoesNotDependOnHowManyStepsAreAskedForAtOnce) {
  const auto run = started();
  while (!run->advance(7)) {
  }
  EXPECT_TRUE(bytes_of(*run) == uncut());
}

TEST_P(ResumedRun, OtherSeedsEndElsewhere) {
  Simulation other(scene_, make_schedule(scene_, "scene.json"), seed + 1, 1, "scene.json");
  other.start();
  other.advance(total_steps);
  EXPECT_FALSE(bytes_of(other) == uncut());
}

// Observables that need rest, and the friction that linear_response allows.
class ResumedRunAtRest : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(ResumedRunAtRest, KeepsItsObservables) {
  const auto& [method, scalar] = GetParam();
  Json patch = {{"flow", {{"shear_rate", 0}}},
                {"observables", {"stress_correlation", "linear_response"}},
                {"integrator", {{"method", method}}},
                {"duration", {{"production", {{"time", 1.2}}}}}};
  for (const char* key : {"friction", "normal_damping", "rolling_stiffness", "rolling_friction"}) {
    patch["contact"][key] = nullptr;
  }
  const Scene scene = read_scene(small_scene(patch), "scene.json");
  const auto made = [&] {
    return Simulation(scene, make_schedule(scene, "scene.json"), seed, 1, "scene.json");
  };
  Simulation uncut = made();
  uncut.start();
  uncut.advance(271);
  ArchiveWriter checkpoint;
  uncut.save(checkpoint);
  Simulation resumed = made();
  ArchiveReader reader(checkpoint.bytes());
  resumed.load(reader);
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
  JobSpecification job;
  job.header = {"point", seed};
  // A job polls its events after 65536 particle-steps, 1092 steps here.
  job.scene = small_scene({{"duration", {{"production", {{"time", 9}}}}}});
  job.scene_name = "scene.json";
  Json uncut = run_job(job, {}).value();
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
  uncut.erase("cost");
  result->erase("cost");
  EXPECT_EQ(result->dump(), uncut.dump());
}

}  // namespace
}  // namespace peclet::engine
