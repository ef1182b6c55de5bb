// Progress messages of a job.
#include <gtest/gtest.h>

#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

std::vector<Progress> told_of(const Json& scene) {
  std::vector<Progress> told;
  JobEvents events;
  events.progress = [&](const Progress& progress) { told.push_back(progress); };
  run_job(job_of(scene), events);
  return told;
}

std::vector<std::uint64_t> packing_steps(const std::vector<Progress>& told) {
  std::vector<std::uint64_t> steps;
  for (const Progress& progress : told) {
    if (progress.phase != std::string("packing")) break;
    EXPECT_EQ(progress.steps, 0U) << "nobody knows how many";
    steps.push_back(progress.step);
  }
  return steps;
}

// A caller that waits for a step of a long packing gets one.
TEST(JobProgress, HasEveryStepOfThePacking) {
  const std::vector<std::uint64_t> loose = packing_steps(told_of(small_scene({{"volume_fraction", 0.3}})));
  const std::vector<std::uint64_t> dense = packing_steps(told_of(small_scene({{"volume_fraction", 0.55}})));
  for (const std::vector<std::uint64_t>& steps : {loose, dense}) {
    for (std::size_t k = 0; k < steps.size(); ++k) EXPECT_EQ(steps[k], k);
  }
  EXPECT_GT(loose.size(), 3U);
  EXPECT_GT(dense.size(), 2 * loose.size());
}

// An impossible packing is tried at decreasing volume fractions, which takes longest.
TEST(JobProgress, GoesOnWhileTheDensestPackingIsLookedFor) {
  const std::vector<std::uint64_t> steps = packing_steps(told_of(small_scene({{"volume_fraction", 0.72}})));
  for (std::size_t k = 0; k < steps.size(); ++k) EXPECT_EQ(steps[k], k);
  EXPECT_GT(steps.size(), 500U);
}

}  // namespace
}  // namespace peclet::engine
