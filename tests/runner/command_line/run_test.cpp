// Real processes: the run, the fake engine, and real signals.
#include "runner/command_line/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <random>
#include <thread>

#include "contract/durable_file.h"
#include "runner/engines/engine_process.h"
#include "runner/store/result_files.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

using std::chrono::milliseconds;

// 20 ms per realisation: long enough to be hit by a kill.
const Environment slow{{"PECLET_FAKE_STEP_MS", "2"}};

Environment with_faults(const std::string& faults) { return {{"PECLET_FAKE_FAULTS", faults}}; }

bool has_no_files(const std::filesystem::path& folder) {
  return std::filesystem::directory_iterator(folder) == std::filesystem::directory_iterator();
}

TEST(Run, ConvergesAndCleansUp) {
  CampaignOnDisk campaign;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM estimates WHERE verdict = 'converged'"), 2);
  // Only seeds that were stopped beyond the deciding stop test may have kept their checkpoints.
  EXPECT_LE(std::distance(std::filesystem::directory_iterator(campaign.directory().checkpoints()),
                          std::filesystem::directory_iterator()),
            campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'drained'"));
  EXPECT_TRUE(spool_files(campaign.directory()).empty());
}

TEST(Run, AFinishedCampaignStartsNothing) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const std::int64_t attempts = campaign.count("SELECT count(*) FROM attempt");
  EXPECT_EQ(campaign.run(), 0);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt"), attempts);
}

TEST(Run, ATighterToleranceRunsNothingTwice) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  campaign.document["target"]["relative_tolerance"] = 0.04;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'result'"),
            campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'"));
  EXPECT_EQ(campaign.count("SELECT count(DISTINCT target_id) FROM stop_test"), 2);
}

TEST(Run, ReachingTheMaximumIsNotConvergence) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"]["maximum"] = 9;
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_DEVIATION", "9"}}), 3);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM estimates WHERE verdict = 'capped'"), 1);
}

class FailuresInARun : public testing::TestWithParam<bool> {};

TEST_P(FailuresInARun, AreCountedByCauseAndNeverWithTheSeedThatWaits) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"]["minimum"] = 12;
  campaign.options.lease_seconds = 2;  // far more than a seed without a fault takes on a busy machine
  Environment environment =
      with_faults("crash:0 exit:1x1 kill:2x2 hang:3x1 garble:4 refuse:5x2 overlap:6 mute:8 twice:9");
  if (GetParam()) {
    environment["PECLET_FAKE_AHEAD"] = "1";
  } else {
    // Behind a lie the next job has begun when the worker is killed, and the fake has counted that try.
    environment["PECLET_FAKE_FAULTS"] += " lie:7x1";
  }
  EXPECT_EQ(campaign.run(environment), 3) << campaign.log();
  const auto attempts = [&](const std::string& outcome, int seed) {
    return campaign.count("SELECT count(*) FROM attempt WHERE outcome = '" + outcome +
                          "' AND seed = " + std::to_string(seed));
  };
  EXPECT_EQ(attempts("crashed", 0), 3);
  EXPECT_EQ(attempts("crashed", 1), 1);
  EXPECT_EQ(attempts("killed", 2), 2);
  EXPECT_EQ(attempts("hung", 3), 1);
  EXPECT_EQ(attempts("garbled", 4), 3);
  EXPECT_EQ(attempts("refused", 5), 2);
  EXPECT_EQ(attempts("garbled", 7), GetParam() ? 0 : 1);
  EXPECT_EQ(attempts("result", 8), 1);  // died before it could say so
  EXPECT_EQ(attempts("result", 9), 1);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'quarantined'"), 2);
  EXPECT_EQ(campaign.count("SELECT seed FROM realisation WHERE state = 'failed' AND cause = 'overlap'"), 6);
  EXPECT_EQ(
      campaign.count("SELECT count(*) FROM estimates WHERE verdict = 'converged-with-losses' AND lost = 3"),
      1);
}

const auto jobs_of_workers = [](const auto& ahead) { return ahead.param ? "two_jobs" : "one_job"; };
INSTANTIATE_TEST_SUITE_P(WithWorkersThatHave, FailuresInARun, testing::Bool(), jobs_of_workers);

// Kills a campaign of this many points five times, after `results` more results each, and expects the answer
// of one that was left alone. Seeds from `held` on do not end before the last kill.
void expect_no_trace_of_kills(int points, const Json& target, int held, int results,
                              const Environment& environment) {
  CampaignOnDisk undisturbed(points);
  undisturbed.document["target"] = target;
  undisturbed.document["realisations"]["maximum"] = 200;
  undisturbed.options.workers = 1;
  ASSERT_EQ(undisturbed.run(), 0) << undisturbed.log();

  CampaignOnDisk campaign(points);
  campaign.document = undisturbed.document;
  campaign.options.workers = 3;
  campaign.options.checkpoint_seconds = 0.005;
  std::mt19937 generator(20260);
  for (int kill = 0; kill < 5; ++kill) {
    campaign.start(campaign.held_from(held, environment));
    campaign.wait_for_results(1 + results * kill);
    std::this_thread::sleep_for(milliseconds(generator() % 30));
    if (kill % 2 == 0) campaign.kill_workers();
    std::this_thread::sleep_for(milliseconds(generator() % 10));
    campaign.signal(SIGKILL);
    ASSERT_EQ(campaign.finish(), -SIGKILL) << campaign.log();
  }
  EXPECT_EQ(campaign.run(environment), 0) << campaign.log();
  EXPECT_EQ(campaign.answer(), undisturbed.answer());
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
}

class KilledCampaign : public testing::TestWithParam<bool> {};

TEST_P(KilledCampaign, GivesTheAnswerOfAnUndisturbedOne) {
  Environment environment = slow;
  if (GetParam()) environment["PECLET_FAKE_AHEAD"] = "1";
  expect_no_trace_of_kills(3, {{"relative_tolerance", 0.05}}, 7, 3, environment);
}

INSTANTIATE_TEST_SUITE_P(WithWorkersThatHave, KilledCampaign, testing::Bool(), jobs_of_workers);

TEST(KilledCurve, GivesTheAnswerOfAnUndisturbedOne) {
  const Json target = Json::parse(R"({"curve": {"over": "/peclet", "relative_tolerance": 0.03}})");
  expect_no_trace_of_kills(5, target, 20, 22, slow);
}

TEST(Run, ADrainCheckpointsAndTheNextRunResumes) {
  CampaignOnDisk undisturbed;
  ASSERT_EQ(undisturbed.run({{"PECLET_FAKE_STEPS", "400"}}), 0) << undisturbed.log();

  CampaignOnDisk campaign;
  campaign.options.checkpoint_seconds = 0.005;
  campaign.start(campaign.held_from(0, {{"PECLET_FAKE_STEPS", "400"}, {"PECLET_FAKE_STEP_MS", "1"}}));
  campaign.wait_until("both workers in the middle of a seed", [&] {
    const std::filesystem::directory_iterator files(campaign.directory().checkpoints());
    return std::count_if(begin(files), end(files), [](const std::filesystem::directory_entry& file) {
             return file.path().extension() == ".checkpoint";
           }) == 2;
  });
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75) << campaign.log();
  EXPECT_FALSE(has_no_files(campaign.directory().checkpoints()));
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND step > 0"), 2);
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_STEPS", "400"}}), 0) << campaign.log();
  EXPECT_EQ(campaign.answer(), undisturbed.answer());
}

TEST(Run, TheSecondSignalStopsAtOnce) {
  CampaignOnDisk campaign;
  // Hanging workers do not hear that they are to drain.
  campaign.start({{"PECLET_FAKE_FAULTS", "hang:0 hang:1"}, {"PECLET_FAKE_FAULT_STEP", "0"}});
  campaign.wait_until("two seeds that hang", [&] {
    return campaign.count("SELECT count(*) FROM realisation WHERE state = 'running'") == 2;
  });
  campaign.signal(SIGINT);
  // Two signals at once may come as one.
  campaign.wait_until("the first signal",
                      [&] { return campaign.log().find("a second signal") != std::string::npos; });
  const auto begin = std::chrono::steady_clock::now();
  campaign.signal(SIGINT);
  EXPECT_EQ(campaign.finish(), 75) << campaign.log();
  EXPECT_LT(std::chrono::steady_clock::now() - begin,
            std::chrono::seconds(20));  // not the patience of a drain
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
}

TEST(Run, ATimeLimitStopsAndCanBeResumed) {
  CampaignOnDisk campaign;
  campaign.options.time_limit = 0.3;
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_STEP_MS", "50"}}), 75) << campaign.log();
  campaign.options.time_limit.reset();
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
}

TEST(Run, ALostConnectionStopsAsCtrlCDoes) {
  CampaignOnDisk campaign;
  auto* const before = std::signal(SIGHUP, SIG_DFL);  // the tests may have been started with nohup
  campaign.start(campaign.held_from(7));
  std::signal(SIGHUP, before);
  campaign.wait_for_results(0);
  campaign.signal(SIGHUP);
  EXPECT_EQ(campaign.finish(), 75);
  EXPECT_NE(campaign.log().find("goes on from there"), std::string::npos) << campaign.log();
}

TEST(StopSignals, OneThatCameTooLateDoesNotKillWhoIsLeaving) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          {
            const StopSignals signals;
            std::raise(number);  // kills unless it is taken
          }
          std::_Exit(0);
        },
        testing::ExitedWithCode(0), "")
        << number;
  }
}

TEST(Run, UnderNohupALostConnectionIsNothing) {
  CampaignOnDisk campaign;
  auto* const before = std::signal(SIGHUP, SIG_IGN);  // the run inherits it
  campaign.start(campaign.held_from(7, slow));
  std::signal(SIGHUP, before);
  campaign.wait_for_results(1);
  campaign.signal(SIGHUP);
  campaign.release();
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
}

TEST(Run, MoreWorkersThanSeedsAreNotStarted) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"] = {{"minimum", 8}, {"maximum", 8}};
  campaign.options.workers = 1000;
  EXPECT_NE(campaign.run(), 2) << campaign.log();
  EXPECT_LE(campaign.count("SELECT max(worker) FROM attempt"), 7);
}

TEST(Run, ResultsOfScenesThatLeftTheSweepAreKeptAndCountAgain) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"] = {{"minimum", 8}, {"maximum", 8}};
  campaign.document["target"]["relative_tolerance"] = 0.9;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  campaign.document["scene"]["fluid"]["viscosity"] = 2;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_NE(campaign.log().find("8 seeds that ended at 1 points of earlier versions"), std::string::npos)
      << campaign.log();
  campaign.document["scene"]["fluid"]["viscosity"] = 1;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt"), 16);  // two scenes, eight seeds, each once
}

TEST(Run, ASecondOwnerIsRefused) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7));
  campaign.wait_for_results(0);
  CampaignOnDisk second;
  second.options.directory = campaign.directory().root();
  EXPECT_EQ(second.run(), 5);
  EXPECT_NE(second.log().find("owns this campaign"), std::string::npos);
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75);
}

TEST(Run, AnotherEngineIsRefusedForPointsThatAreNotDecided) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7));
  campaign.wait_for_results(1);
  campaign.signal(SIGTERM);
  ASSERT_EQ(campaign.finish(), 75) << campaign.log();
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_IDENTITY", "another"}}), 6);
  EXPECT_NE(campaign.log().find("one point never mixes two"), std::string::npos);
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
}

TEST(Run, ADifferentAnswerToTheSameSeedIsNotPassedOver) {
  CampaignOnDisk campaign(1);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  Json result = campaign.reader().result(1, 0).value();
  result["mean"]["relative_viscosity"] = 11.1;
  write_durably(campaign.directory().spool() / "late.json", result.dump());
  EXPECT_EQ(campaign.run(), 6) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT suspect FROM points"), 1);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM event WHERE kind = 'suspect'"), 1);
  EXPECT_TRUE(std::filesystem::exists(campaign.directory().rejected() / "late.json"));
}

TEST(Run, WhatIsWrongBeforeTheStartWritesNothing) {
  struct Fault {
    const char* pointer;
    Json value;
    int code;
  };
  const std::vector<Fault> faults{{"/scene/fluid/viscosity", -1, 2},
                                  {"/engine/0", "no-such-engine", 2},
                                  {"/engine/0", "./nowhere/engine", 2},
                                  {"/engine/0", "/bin/true", 1},
                                  {"/realisations/minimum", 1000, 2}};
  for (const Fault& fault : faults) {
    CampaignOnDisk campaign;
    campaign.document[Json::json_pointer(fault.pointer)] = fault.value;
    EXPECT_EQ(campaign.run(), fault.code) << fault.pointer << ": " << fault.value << "\n" << campaign.log();
    EXPECT_FALSE(std::filesystem::exists(campaign.directory().root())) << fault.pointer;
  }
}

}  // namespace
}  // namespace peclet::runner
