// Realisations of two scenes share no random numbers, unless their seeds are in common.
#include <gtest/gtest.h>

#include "engine/snapshots/snapshot.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// Returns the centres of the spheres after a time in which shear and noise move them by less than 0.01.
std::vector<Vector3> beginning(const Json& patch, std::uint64_t seed = usual_seed) {
  TemporaryFolder folder;
  Json scene =
      small_scene({{"files", {{"final_configuration", true}}},
                   {"duration", {{"equilibration", {{"time", 0}}}, {"production", {{"time", 1e-4}}}}},
                   {"integrator", {{"timestep", 1e-6}}}});
  scene.merge_patch(patch);
  run_job(job_of(scene, (folder / "a.").string(), seed), {}).value();
  return SnapshotFile(folder / "a.final.xyz").read(0).position;
}

double largest_distance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

const Json on_their_own = {{"seeds_in_common", false}};
const Json stiffer = {{"contact", {{"normal_stiffness", 2e4}}}};

TEST(RandomKey, IsOfTheScene) {
  EXPECT_GT(largest_distance(beginning(on_their_own), beginning(together({on_their_own, stiffer}))), 1);
}

TEST(RandomKey, IsOfTheSeedAloneIfSeedsAreInCommon) {
  const std::vector<Vector3> usual = beginning(Json::object());
  EXPECT_LT(largest_distance(usual, beginning(stiffer)), 0.01);
  EXPECT_GT(largest_distance(usual, beginning(Json::object(), usual_seed + 1)), 1);
  EXPECT_GT(largest_distance(usual, beginning(on_their_own)), 1);
}

TEST(RandomKey, IsTheSameWhateverIsMeasured) {
  const Json others = together({on_their_own, {{"observables", {"stress", "profiles"}}}});
  EXPECT_EQ(result_of(on_their_own).at("final_state_sha256"), result_of(others).at("final_state_sha256"));
}

}  // namespace
}  // namespace peclet::engine
