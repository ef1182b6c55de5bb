// The trajectory file of a job: beside the result, cut and resumed, and after an early end.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/snapshots/gsd_reader.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

// Returns a scene large enough for many iterations of the job's loop, of 13 steps each.
Json large_scene() {
  return small_scene(Json::parse(R"({
      "observables": ["trajectory"], "trajectory": {"interval": {"time": 0.01}, "contacts": true},
      "particles": {"count": 5000},
      "duration": {"equilibration": {"time": 0.04}, "production": {"time": 0.1}}})"));
}

JobSpecification job_in(const TemporaryFolder& folder, const Json& scene) {
  JobSpecification job = job_of(scene, (folder / "job@").string());
  job.checkpoint = folder / "checkpoint";
  return job;
}

TEST(TrajectoryJob, ThatIsCutAndResumedLeavesTheSameBytes) {
  const TemporaryFolder whole, cut;
  const Json result = run_job(job_in(whole, large_scene()), {}).value();
  const std::string bytes = read_file(whole / "job@trajectory.gsd");
  const Json listed = {{{"name", "trajectory.gsd"}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}}};
  EXPECT_EQ(result.at("files"), listed);
  EXPECT_EQ(GsdReader(bytes).frames(), 10U);

  JobSpecification job = job_in(cut, large_scene());
  std::optional<Json> resumed;
  int drains = 0;
  for (; !resumed; ++drains) {
    int turns = 0;
    JobEvents events;
    events.drain_requested = [&turns] { return ++turns > 1; };
    job.threads = 1 + drains % 2;
    resumed = run_job(job, events);
    ASSERT_LT(drains, 20);
  }
  EXPECT_GE(drains, 3);
  EXPECT_EQ(resumed->at("files"), listed);
  EXPECT_TRUE(read_file(cut / "job@trajectory.gsd") == bytes);
}

// After a kill the file has frames beyond the checkpoint, or lacks some.
TEST(TrajectoryJob, GoesOnFromTheCheckpointOrStartsAgain) {
  const TemporaryFolder folder;
  JobSpecification job = job_in(folder, large_scene());
  JobEvents events;
  int turns = 0;
  events.drain_requested = [&turns] { return ++turns > 4; };
  ASSERT_FALSE(run_job(job, events));
  const std::string checkpoint = read_file(folder / "checkpoint");
  const std::string grown = read_file(folder / "checkpoint@growing");
  EXPECT_GT(grown.size(), 100'000U);
  const auto with = [&](const std::string& file) {
    write_durably(folder / "checkpoint", checkpoint);
    write_durably(folder / "checkpoint@growing", file);
  };
  const auto bytes = [&] {
    EXPECT_TRUE(run_job(job, {}));
    return read_file(folder / "job@trajectory.gsd");
  };
  const std::string uncut = bytes();
  EXPECT_EQ(GsdReader(uncut).frames(), 10U);
  with(grown + std::string(3'000'000, 'x'));
  EXPECT_TRUE(bytes() == uncut);
  EXPECT_FALSE(fs::exists(folder / "checkpoint.rejected"));
  for (const bool is_absent : {false, true}) {
    with(grown.substr(0, grown.size() - 1));
    if (is_absent) fs::remove(folder / "checkpoint@growing");
    job.restart_on_bad_checkpoint = false;
    EXPECT_THROW(run_job(job, {}), CheckpointError);
    job.restart_on_bad_checkpoint = true;
    EXPECT_TRUE(bytes() == uncut);
    EXPECT_TRUE(fs::remove(folder / "checkpoint.rejected"));
  }
}

TEST(TrajectoryJob, ThatBrokeOffLeavesItsFrames) {
  const TemporaryFolder folder;
  const Json scene = small_scene({{"observables", {"trajectory"}}, {"guard", {{"largest_overlap", 0.002}}}});
  JobSpecification job = job_in(folder, scene);
  job.checkpoint.clear();
  const Json result = run_job(job, {}).value();
  EXPECT_EQ(result.at("ending").at("cause"), "overlap");
  EXPECT_EQ(result.at("files").at(0).at("name"), "trajectory.gsd");
  const GsdReader file(read_file(folder / "job@trajectory.gsd"));
  const auto step = result.at("ending").at("step").get<std::uint64_t>();
  EXPECT_EQ(file.frames(), step > 100 ? step - 101 : 0);  // one per step of the window but the last
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1U) << "without a checkpoint nothing else is left";
}

TEST(TrajectoryJob, IsRefusedWhereNobodyTakesTheFile) {
  const TemporaryFolder folder;
  JobSpecification job = job_in(folder, small_scene({{"observables", {"trajectory"}}}));
  job.files.clear();
  EXPECT_TRUE(refusal_by([&] { run_job(job, {}); }).starts_with("scene.json: /observables: "));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace peclet::engine
