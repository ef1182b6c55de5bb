// A realisation extended from the checkpoint of a shorter one equals the longer one bit by bit.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "engine/realisation/checkpoint.h"
#include "engine/realisation/job.h"
#include "tests/engine/small_scene.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

struct Way {
  const char* name;
  Json patch;
};
const Way ways[] = {
    {"explicit", Json::object()},
    {"explicit_without_noise", {{"fluid", {{"thermal_energy", nullptr}}}}},
    {"implicit", {{"integrator", {{"method", "implicit"}}}, {"particles", {{"density", 0.01}}}}},
    {"implicit_without_noise",
     {{"integrator", {{"method", "implicit"}}},
      {"particles", {{"density", 0.01}}},
      {"fluid", {{"thermal_energy", nullptr}}}}},
};

Json durations(double equilibration, double production) {
  return {{"equilibration", {{"time", equilibration}}}, {"production", {{"time", production}}}};
}

class ExtendedJob : public testing::TestWithParam<Way> {
 protected:
  // Returns a job of 100 and 320 steps, or of `duration`, with other observables than the first one.
  JobSpecification job(const Json& patch) const {
    JobSpecification job;
    job.header = {"point", 4};
    job.scene = small_scene(GetParam().patch);
    job.scene.merge_patch(patch);
    job.scene_name = "scene.json";
    return job;
  }
  std::filesystem::path checkpoint() const {
    JobSpecification first =
        job({{"files", {{"final_checkpoint", true}}}, {"observables", {"contact_network"}}});
    first.files = (folder_ / "a.").string();
    EXPECT_EQ(run_job(first, {}).value().at("files").at(0).at("name"), "final.checkpoint");
    return folder_ / "a.final.checkpoint";
  }
  static Json without_cost(Json result) {
    result.erase("cost");
    return result;
  }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(EveryWay, ExtendedJob, testing::ValuesIn(ways),
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
  JobSpecification job;
  job.header = {"point", 4};
  job.scene = small_scene(
      {{"flow", {{"shear_rate", nullptr}, {"oscillation", {{"amplitude", 0.04}, {"frequency", 50}}}}},
       {"integrator", {{"timestep", 0.0009}}},
       {"observables", {"oscillation"}},
       {"duration",
        {{"equilibration", {{"time", nullptr}, {"cycles", 0}}},
         {"production", {{"time", nullptr}, {"cycles", 40}}}}}});
  job.scene_name = "scene.json";
  job.checkpoint = folder / "checkpoint";
  JobEvents events;
  events.drain_requested = [] { return true; };
  ASSERT_FALSE(run_job(job, events).has_value());
  JobSpecification longer = job;
  longer.checkpoint.clear();
  longer.extended = job.checkpoint;
  longer.scene["duration"]["production"]["cycles"] = 60;
  try {
    run_job(longer, {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("stands within a cycle"), std::string::npos) << error.what();
  }
}

TEST_P(ExtendedJob, OfAnotherMotionIsRefused) {
  const std::filesystem::path path = checkpoint();
  const auto refusal = [&](const JobSpecification& asked) {
    JobSpecification job = asked;
    job.extended = path;
    try {
      run_job(job, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Json longer = {{"duration", durations(0.84, 0.64)}};
  const auto expect = [&](const JobSpecification& asked, const std::string& reason) {
    EXPECT_NE(refusal(asked).find(reason), std::string::npos) << refusal(asked) << " has not " << reason;
  };
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
