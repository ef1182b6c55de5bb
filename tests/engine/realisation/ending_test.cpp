// Every ending of a realisation has a name, a step and a state, and no means unless it is complete.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/job.h"
#include "tests/engine/small_scene.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

constexpr const char* point = "0123456789abcdef";

class EndingOfAJob : public testing::Test {
 protected:
  Json result_of(const Json& patch) {
    JobSpecification job;
    job.header = {point, 5};
    job.scene = small_scene(patch);
    job.scene_name = "scene.json";
    job.failures = folder_.path();
    return run_job(job, {}).value();
  }

  static void expect_no_numbers(const Json& result) {
    EXPECT_TRUE(result.at("mean").is_null());
    EXPECT_TRUE(result.at("blocks").is_null());
    EXPECT_TRUE(result.at("statistical_inefficiency").is_null());
  }

  // Expects that the saved state is a checkpoint of the step at which the realisation ended.
  void expect_saved_state(const Json& result, const Json& patch) {
    const Json& ending = result.at("ending");
    ASSERT_EQ(ending.at("state"), "0123456789ab-5.state");
    const Scene scene = read_scene(small_scene(patch), "scene.json");
    const Schedule schedule = make_schedule(scene, "");
    Simulation simulation(scene, schedule, 5, 1, "");
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
  EXPECT_EQ(result.at("ending").at("cause"), "overlap");
  EXPECT_GT(result.at("ending").at("step"), 0);
  EXPECT_LT(result.at("ending").at("step"), 420);
  expect_no_numbers(result);
  expect_saved_state(result, patch);
}

TEST_F(EndingOfAJob, DisplacementBeyondTheGuard) {
  const Json patch = {{"guard", {{"largest_displacement", 1e-9}}}};
  const Json result = result_of(patch);
  EXPECT_EQ(result.at("ending").at("cause"), "displacement");
  EXPECT_EQ(result.at("ending").at("step"), 1);
  expect_no_numbers(result);
  expect_saved_state(result, patch);
}

// Noise at this temperature overflows.
TEST_F(EndingOfAJob, NonFinite) {
  const Json patch = {{"fluid", {{"thermal_energy", 1e308}}}};
  const Json result = result_of(patch);
  EXPECT_EQ(result.at("ending").at("cause"), "non-finite");
  expect_no_numbers(result);
  // The state is saved, and cannot be resumed without finite positions.
  try {
    expect_saved_state(result, patch);
    ADD_FAILURE() << "it was read";
  } catch (const CheckpointError& error) {
    EXPECT_NE(std::string(error.what()).find("a sphere far outside its cell"), std::string::npos)
        << error.what();
  }
}

// Spheres that leap over each other meet no neighbours; no guard may allow this.
TEST_F(EndingOfAJob, DisplacementBeyondTheForcesEvenIfTheGuardAllowsIt) {
  const Json result = result_of({{"fluid", {{"thermal_energy", 1e12}}},
                                 {"guard", {{"largest_displacement", 1e30}, {"largest_overlap", 1e30}}}});
  EXPECT_EQ(result.at("ending").at("cause"), "displacement");
  expect_no_numbers(result);
}

TEST_F(EndingOfAJob, Packing) {
  const Json result = result_of({{"volume_fraction", 0.73}, {"particles", {{"count", 20}}}});
  EXPECT_EQ(result.at("ending").at("cause"), "packing");
  EXPECT_EQ(result.at("ending").at("step"), 0);
  EXPECT_NE(result.at("ending").at("message").get<std::string>().find("0.7300"), std::string::npos);
  EXPECT_TRUE(result.at("final_state_sha256").is_null());
  expect_no_numbers(result);
}

}  // namespace
}  // namespace peclet::engine
