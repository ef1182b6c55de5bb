// A realisation extended from the checkpoint of a shorter one equals the longer one bit by bit.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "engine/realisation/checkpoint.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

struct WayToExtend {
  const char* name;
  Json patch;
};
const WayToExtend ways_to_extend[] = {
    {"explicit", Json::object()},
    {"explicit_without_noise", without_noise},
    {"implicit", implicit_and_light},
    {"implicit_without_noise", together({implicit_and_light, without_noise})}};

Json durations(double equilibration, double production) {
  return {{"equilibration", {{"time", equilibration}}}, {"production", {{"time", production}}}};
}

class ExtendedJob : public testing::TestWithParam<WayToExtend> {
 protected:
  // Returns a job of 100 and 320 steps, or of `duration`, with other observables than the first one.
  static JobSpecification job(const Json& patch, const std::string& files = "") {
    Json scene = small_scene(GetParam().patch);
    scene.merge_patch(patch);
    return job_of(scene, files, 4);
  }
  std::filesystem::path checkpoint() const {
    const JobSpecification first =
        job({{"files", {{"final_checkpoint", true}}}, {"observables", {"contact_network"}}},
            (folder_ / "a.").string());
    EXPECT_EQ(run_job(first, {}).value().at("files").at(0).at("name"), "final.checkpoint");
    return folder_ / "a.final.checkpoint";
  }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(EveryWay, ExtendedJob, testing::ValuesIn(ways_to_extend),
                         [](const auto& way) { return std::string(way.param.name); });

// The 420 steps are its equilibration: measurements begin after it, as in an uninterrupted run.
TEST_P(ExtendedJob, IsTheLongerOneWithAllItsMeans) {
  for (const double equilibration : {0.84, 1.0}) {
    JobSpecification longer =
        job({{"duration", durations(equilibration, 0.64)}, {"observables", {"profiles"}}});
    const Json uncut = run_job(longer, {}).value();
    longer.extended = checkpoint();
    const Json extended = run_job(longer, {}).value();
    EXPECT_EQ(uncut.at("ending").at("cause"), "completed");
    EXPECT_EQ(without_cost(extended).dump(), without_cost(uncut).dump());
  }
}

// If the window had begun before the checkpoint, it is measured from the checkpoint on.
TEST_P(ExtendedJob, EndsInTheSameStateWhateverItsWindowIs) {
  JobSpecification longer = job({{"duration", durations(0.2, 1.28)}});
  const Json uncut = run_job(longer, {}).value();
  longer.extended = checkpoint();
  const Json extended = run_job(longer, {}).value();
  EXPECT_EQ(extended.at("final_state_sha256"), uncut.at("final_state_sha256"));
  EXPECT_EQ(extended.at("steps").dump(), R"({"equilibration":420,"production":320})");
  EXPECT_NE(extended.at("mean"), uncut.at("mean"));
  // A scene with that window gives equal means.
  JobSpecification same = job({{"duration", durations(0.84, 0.64)}});
  EXPECT_EQ(extended.at("mean"), run_job(same, {}).value().at("mean"));
}

TEST_P(ExtendedJob, CanBeCutAndExtendedAgain) {
  JobSpecification longer = job({{"duration", durations(0.2, 6)}, {"files", {{"final_checkpoint", true}}}});
  longer.extended = checkpoint();
  longer.files = (folder_ / "b.").string();
  Json uncut = run_job(longer, {}).value();
  longer.checkpoint = folder_ / "checkpoint";
  JobEvents events;
  events.drain_requested = [] { return true; };
  std::optional<Json> result;
  int drains = 0;
  for (; !result; ++drains) result = run_job(longer, events);
  EXPECT_GE(drains, 2);
  for (Json* one : {&uncut, &*result}) one->erase("files");  // files include costs
  EXPECT_EQ(without_cost(*result).dump(), without_cost(uncut).dump());
  // The checkpoint belongs to the run whose window begins at the first checkpoint.
  JobSpecification plain = longer;
  plain.extended.clear();
  EXPECT_THROW(run_job(plain, {}), CheckpointError);

  JobSpecification longest = job({{"duration", durations(6.2, 0.64)}});
  const Json whole = run_job(longest, {}).value();
  longest.extended = folder_ / "b.final.checkpoint";
  EXPECT_EQ(without_cost(run_job(longest, {}).value()).dump(), without_cost(whole).dump());
}

// A cycle has 140 steps; the first job is cut within one.
TEST(ExtendedOscillation, GoesOnFromWholeCyclesAlone) {
  const TemporaryFolder folder;
  JobSpecification job = job_of(small_scene(Json::parse(R"({
      "flow": {"shear_rate": null, "oscillation": {"amplitude": 0.04, "frequency": 50}},
      "integrator": {"timestep": 0.0009}, "observables": ["oscillation"],
      "duration": {"equilibration": {"time": null, "cycles": 0},
                   "production": {"time": null, "cycles": 40}}})")),
                                "", 4);
  job.checkpoint = folder / "checkpoint";
  JobEvents events;
  events.drain_requested = [] { return true; };
  ASSERT_FALSE(run_job(job, events).has_value());
  JobSpecification longer = job;
  longer.checkpoint.clear();
  longer.extended = job.checkpoint;
  longer.scene["duration"]["production"]["cycles"] = 60;
  EXPECT_TRUE(contains(refusal_by([&] { run_job(longer, {}); }), "stands within a cycle"));
}

TEST_P(ExtendedJob, OfAnotherMotionIsRefused) {
  const std::filesystem::path path = checkpoint();
  const auto expect = [&](JobSpecification asked, const std::string& reason) {
    asked.extended = path;
    EXPECT_TRUE(contains(refusal_by([&] { run_job(asked, {}); }), reason));
  };
  const Json longer = {{"duration", durations(0.84, 0.64)}};
  expect(job({{"duration", durations(0.84, 0.64)}, {"contact", {{"friction", 0.4}}}}),
         "differs in more than durations");
  expect(job({{"duration", durations(0.84, 0.64)}, {"integrator", {{"timestep", 0.001}}}}), "time step");
  JobSpecification other_seed = job(longer);
  other_seed.header.seed = 5;
  expect(other_seed, "another seed");
  expect(job(Json::object()), "/duration: 420 steps: must be 452 steps at least");
  write_durably(path, "no checkpoint");
  expect(job(longer), "--extend: " + path.string() + ": is no checkpoint");
  std::filesystem::remove(path);
  expect(job(longer), "--extend: " + path.string());
}

}  // namespace
}  // namespace peclet::engine
