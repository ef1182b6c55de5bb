// Jobs that run side by side in an ensemble end as each does alone.
#include "engine/realisation/crew.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>

#include "contract/durable_file.h"
#include "tests/engine/realisation/processor_ensemble.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// Returns what does not depend on where and how fast a result was computed.
std::string outcome(Json result) {
  result.erase("engine");
  return without_cost(std::move(result)).dump();
}

// Results and errors of jobs by seed.
struct Outcomes {
  std::mutex mutex;
  std::map<std::uint64_t, Json> results;
  std::map<std::uint64_t, std::string> errors;
};

// Begins a job; its result or its error arrives in `outcomes`.
void begin(Crew& crew, const JobSpecification& job, Outcomes& outcomes, const JobEvents& events = {}) {
  crew.begin([&crew, &outcomes, job, events] {
    try {
      const std::optional<Json> result = crew.run(job, events);
      const std::lock_guard lock(outcomes.mutex);
      if (result) outcomes.results[job.header.seed] = *result;
    } catch (const std::exception& error) {
      const std::lock_guard lock(outcomes.mutex);
      outcomes.errors[job.header.seed] = error.what();
    }
  });
}

void run_to_the_end(Crew& crew) {
  while (crew.active() > 0) crew.turn();
}

void expect_the_results_of_each_alone(const std::vector<JobSpecification>& jobs, const Outcomes& outcomes) {
  EXPECT_TRUE(outcomes.errors.empty()) << outcomes.errors.begin()->second;
  ASSERT_EQ(outcomes.results.size(), jobs.size());
  for (const JobSpecification& job : jobs) {
    const Json alone = run_job(job_of(job.scene, job.files + "alone.", job.header.seed), {}).value();
    EXPECT_EQ(outcome(outcomes.results.at(job.header.seed)), outcome(alone)) << job.header.seed;
  }
}

// Scenes of which the ensemble holds different numbers, one of them with frames.
class ACrew : public testing::Test {
 protected:
  std::vector<JobSpecification> jobs(std::size_t count) const {
    const Json with_frames = small_scene({{"observables", {"trajectory", "contact_network"}},
                                          {"trajectory", {{"interval", {{"time", 0.1}}}}}});
    const Json with_more = small_scene({{"particles", {{"count", 70}}}});
    std::vector<JobSpecification> all;
    for (std::uint64_t seed = 1; all.size() < count; ++seed) {
      const Json& scene = seed % 3 == 1 ? small_scene() : seed % 3 == 2 ? with_frames : with_more;
      all.push_back(job_of(scene, (folder_ / fmt::format("{}.", seed)).string(), seed));
    }
    return all;
  }
  std::filesystem::path checkpoint(std::uint64_t seed) const {
    return folder_ / fmt::format("checkpoint-{}", seed);
  }

  TemporaryFolder folder_;
  Outcomes outcomes_;
};

TEST_F(ACrew, HasTheResultsOfEachJobAloneInAnyOrder) {
  std::vector<JobSpecification> all = jobs(8);
  for (const std::size_t capacity : {2U, 5U}) {
    outcomes_.results.clear();
    ProcessorEnsemble ensemble(capacity);
    Crew crew(ensemble, Device::cuda);
    for (const JobSpecification& job : all) begin(crew, job, outcomes_);
    run_to_the_end(crew);
    expect_the_results_of_each_alone(all, outcomes_);
    EXPECT_GE(ensemble.most(), 2U);
    std::reverse(all.begin(), all.end());
  }
}

TEST_F(ACrew, SaysWhatComputedAResult) {
  ProcessorEnsemble ensemble(2);
  Crew crew(ensemble, Device::automatic);
  begin(crew, job_of(small_scene(), "", 1), outcomes_);
  begin(crew, job_of(small_scene(implicit_and_light), "", 2), outcomes_);
  run_to_the_end(crew);
  const std::string set = engine_identity().at("instruction_set").get<std::string>();
  for (const auto& [seed, device] : {std::pair(1, "stand-in 1"), std::pair(2, "processor")}) {
    const Json& engine = outcomes_.results.at(static_cast<std::uint64_t>(seed)).at("engine");
    EXPECT_EQ(engine.at("instruction_set"), "stand-in 1; " + set);
    EXPECT_EQ(engine.at("device"), device);
  }
}

// Short checkpoint intervals take realisations out of the ensemble and back.
TEST_F(ACrew, CanBeDrainedAtAnyMomentAndGoesOnFromThere) {
  std::vector<JobSpecification> all = jobs(7);
  for (JobSpecification& job : all) {
    job.checkpoint = checkpoint(job.header.seed);
    job.checkpoint_seconds = 0.015;
  }
  std::minstd_rand random(3);
  std::atomic<bool> drains = false;
  JobEvents events;
  events.drain_requested = [&] { return drains.load(); };
  int drained = 0;
  for (; outcomes_.results.size() < all.size(); ++drained) {
    drains = false;
    ProcessorEnsemble ensemble(4, 3);
    Crew crew(ensemble, Device::cuda);
    for (const JobSpecification& job : all) {
      if (!outcomes_.results.contains(job.header.seed)) begin(crew, job, outcomes_, events);
    }
    for (auto turns = random() % 3; turns > 0; --turns) crew.turn();
    drains = true;
    crew.drain();
    run_to_the_end(crew);
    ASSERT_TRUE(outcomes_.errors.empty()) << outcomes_.errors.begin()->second;
  }
  EXPECT_GE(drained, 3);
  expect_the_results_of_each_alone(all, outcomes_);
}

TEST_F(ACrew, RefusesWhatTheEnsembleCannotRunOrLetsTheProcessorRunIt) {
  const JobSpecification job = job_of(small_scene(implicit_and_light), "", 3);
  ProcessorEnsemble ensemble(2);
  {
    Crew crew(ensemble, Device::cuda);
    begin(crew, job, outcomes_);
    run_to_the_end(crew);
  }
  EXPECT_EQ(outcomes_.errors.at(3), "scene.json: /integrator/method: implicit: must be explicit");
  outcomes_.errors.clear();
  {
    Crew crew(ensemble, Device::automatic);
    begin(crew, job, outcomes_);
    run_to_the_end(crew);
  }
  expect_the_results_of_each_alone({job}, outcomes_);
}

TEST_F(ACrew, TellsOfSpheresThatCannotBePacked) {
  const JobSpecification job = job_of(small_scene({{"volume_fraction", 0.72}}), "", 1);
  ProcessorEnsemble ensemble(2);
  Crew crew(ensemble, Device::cuda);
  begin(crew, job, outcomes_);
  run_to_the_end(crew);
  EXPECT_EQ(outcomes_.results.at(1).at("ending").at("cause"), "packing");
  expect_the_results_of_each_alone({job}, outcomes_);
}

// The processor may not go on with what an ensemble has begun, nor the other way round.
TEST_F(ACrew, HasCheckpointsOfItsOwn) {
  JobSpecification job = job_of(small_scene({{"duration", {{"production", {{"time", 100}}}}}}), "", 1);
  job.checkpoint = checkpoint(1);
  std::atomic<bool> drains = false;
  JobEvents events;
  events.drain_requested = [&] { return drains.load(); };
  ProcessorEnsemble ensemble(2);
  {
    Crew crew(ensemble, Device::cuda);
    begin(crew, job, outcomes_, events);
    while (ensemble.most() == 0) crew.turn();
    drains = true;
    crew.drain();
    run_to_the_end(crew);
  }
  EXPECT_TRUE(outcomes_.results.empty());
  EXPECT_TRUE(contains(refusal_by<CheckpointError>([&] { run_job(job, events); }), "another device"));
  std::filesystem::remove(job.checkpoint);
  ASSERT_FALSE(run_job(job, events).has_value());
  {
    Crew crew(ensemble, Device::cuda);
    begin(crew, job, outcomes_, events);
    run_to_the_end(crew);
  }
  EXPECT_TRUE(contains(outcomes_.errors.at(1), "another device"));
}

// A job that waits for room on its disk does so after its end, in its thread.
TEST_F(ACrew, DoesNotWaitForAJobThatHasEnded) {
  ProcessorEnsemble ensemble(1);
  Crew crew(ensemble, Device::cuda);
  std::atomic<bool> has_room = false, is_waiting = false;
  crew.begin([&] {
    crew.run(job_of(small_scene(), "", 1), {});
    is_waiting = true;
    is_waiting.notify_all();
    has_room.wait(false);
  });
  while (!is_waiting) crew.turn();
  for (const std::uint64_t seed : {2U, 3U}) begin(crew, job_of(small_scene(), "", seed), outcomes_);
  while (crew.active() > 1) crew.turn();
  EXPECT_EQ(outcomes_.results.size(), 2U);
  has_room = true;
  has_room.notify_all();
  run_to_the_end(crew);
}

TEST_F(ACrew, EndsItsJobsByAnErrorIfTheEnsembleFails) {
  ProcessorEnsemble ensemble(2);
  ensemble.break_after(2);
  Crew crew(ensemble, Device::cuda);
  const Json endless = small_scene({{"duration", {{"production", {{"time", 20000}}}}}});
  for (const std::uint64_t seed : {1U, 2U, 3U}) begin(crew, job_of(endless, "", seed), outcomes_);
  EXPECT_TRUE(contains(refusal_by<std::runtime_error>([&] { run_to_the_end(crew); }), "the stand-in broke"));
  ensemble.forget_all();
  run_to_the_end(crew);
  EXPECT_TRUE(outcomes_.results.empty());
  ASSERT_FALSE(outcomes_.errors.empty());
  for (const auto& [seed, error] : outcomes_.errors) EXPECT_EQ(error, "the stand-in broke");
}

}  // namespace
}  // namespace peclet::engine
