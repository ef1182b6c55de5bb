// Every ending of a realisation has a name, a step and a state, and no means unless it is complete.
#include <gtest/gtest.h>

#include "contract/provenance.h"
#include "contract/sha256.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

constexpr const char* point = "0123456789abcdef";

class EndingOfAJob : public testing::Test {
 protected:
  Json result_of(const Json& patch) {
    JobSpecification job = job_of(small_scene(patch), "", 5);
    job.header.point = point;
    job.failures = folder_.path();
    return run_job(job, {}).value();
  }

  // Expects this cause, and no means.
  static void expect_broken_off(const Json& result, const char* cause) {
    EXPECT_EQ(result.at("ending").at("cause"), cause);
    EXPECT_TRUE(result.at("mean").is_null());
    EXPECT_TRUE(result.at("blocks").is_null());
    EXPECT_TRUE(result.at("statistical_inefficiency").is_null());
  }

  // Expects that the saved state is a checkpoint of the step at which the realisation ended.
  void expect_saved_state(const Json& result, const Json& patch) {
    const Json& ending = result.at("ending");
    ASSERT_EQ(ending.at("state"), "0123456789ab-5.state");
    const Scene scene = scene_from(patch);
    const Schedule schedule = make_schedule(scene, "");
    Simulation simulation = simulation_of(scene, 5);
    read_checkpoint(folder_ / ending.at("state").get<std::string>(),
                    {sha256(canonical_json(scene.document)), 5, provenance().at("binary_sha256"),
                     motion_of(scene, schedule)},
                    simulation);
    EXPECT_EQ(simulation.system().step, ending.at("step").get<std::uint64_t>());
  }

  TemporaryFolder folder_;
};

TEST_F(EndingOfAJob, CompletedHasMeansAndSavesNoState) {
  const Json result = result_of(Json::object());
  EXPECT_EQ(result.at("ending").at("cause"), "completed");
  EXPECT_EQ(result.at("ending").at("step"), 420);
  EXPECT_TRUE(result.at("ending").at("state").is_null());
  EXPECT_TRUE(result.at("mean").is_object());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(EndingOfAJob, OverlapBeyondTheGuard) {
  const Json patch = {{"guard", {{"largest_overlap", 1e-6}}}};
  const Json result = result_of(patch);
  expect_broken_off(result, "overlap");
  EXPECT_GT(result.at("ending").at("step"), 0);
  EXPECT_LT(result.at("ending").at("step"), 420);
  expect_saved_state(result, patch);
}

TEST_F(EndingOfAJob, DisplacementBeyondTheGuard) {
  const Json patch = {{"guard", {{"largest_displacement", 1e-9}}}};
  const Json result = result_of(patch);
  expect_broken_off(result, "displacement");
  EXPECT_EQ(result.at("ending").at("step"), 1);
  expect_saved_state(result, patch);
}

// Noise at this temperature overflows. The state is saved, and cannot be resumed without finite positions.
TEST_F(EndingOfAJob, NonFinite) {
  const Json patch = {{"fluid", {{"thermal_energy", 1e308}}}};
  const Json result = result_of(patch);
  expect_broken_off(result, "non-finite");
  EXPECT_TRUE(contains(refusal_by<CheckpointError>([&] { expect_saved_state(result, patch); }),
                       "a sphere far outside its cell"));
}

// Spheres that leap over each other meet no neighbours; no guard may allow this.
TEST_F(EndingOfAJob, DisplacementBeyondTheForcesEvenIfTheGuardAllowsIt) {
  expect_broken_off(result_of({{"fluid", {{"thermal_energy", 1e12}}},
                               {"guard", {{"largest_displacement", 1e30}, {"largest_overlap", 1e30}}}}),
                    "displacement");
}

TEST_F(EndingOfAJob, Packing) {
  const Json result = result_of({{"volume_fraction", 0.73}, {"particles", {{"count", 20}}}});
  expect_broken_off(result, "packing");
  EXPECT_EQ(result.at("ending").at("step"), 0);
  EXPECT_TRUE(contains(result.at("ending").at("message"), "0.7300"));
  EXPECT_TRUE(result.at("final_state_sha256").is_null());
}

}  // namespace
}  // namespace peclet::engine
