// Campaigns with engines that run several realisations at once, in real processes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "contract/durable_file.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

using std::chrono::milliseconds;

Environment several_at_once(Environment environment = {}) {
  environment["PECLET_FAKE_CAPACITY"] = "6";
  return environment;
}

std::string canonical_export(const CampaignOnDisk& campaign) {
  Database reader = campaign.reader();
  return export_json(reader, true);
}

// Returns the export of the campaign with engines that run one realisation at a time.
std::string plain_answer(int points) {
  CampaignOnDisk campaign(points);
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  return canonical_export(campaign);
}

TEST(SeveralAtOnce, GiveTheSameBytesInAnyOrder) {
  CampaignOnDisk campaign(3);
  ASSERT_EQ(campaign.run(several_at_once()), 0) << campaign.log();
  EXPECT_EQ(canonical_export(campaign), plain_answer(3));
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM lease"), 0);
}

TEST(SeveralAtOnce, ADrainSavesEachAndTheNextRunResumes) {
  CampaignOnDisk campaign(3);
  campaign.options.workers = 1;
  campaign.options.checkpoint_seconds = 0.005;
  campaign.start(campaign.held_from(0, several_at_once({{"PECLET_FAKE_STEP_MS", "1"}})));
  campaign.wait_until("six seeds that have been saved", [&] {
    const std::filesystem::directory_iterator files(campaign.directory().checkpoints());
    return std::count_if(begin(files), end(files), [](const std::filesystem::directory_entry& file) {
             return file.path().extension() == ".checkpoint";
           }) == 6;
  });
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'drained' AND step > 0"), 6);
  EXPECT_EQ(campaign.run(several_at_once()), 0) << campaign.log();
  EXPECT_EQ(canonical_export(campaign), plain_answer(3));
}

TEST(SeveralAtOnce, KillsOfEnginesAndOwnerLeaveTheSameAnswer) {
  CampaignOnDisk campaign(3);
  campaign.options.checkpoint_seconds = 0.005;
  std::mt19937 generator(20261);
  const Environment slow = several_at_once({{"PECLET_FAKE_STEP_MS", "2"}});
  for (int kill = 0; kill < 4; ++kill) {
    campaign.start(campaign.held_from(7, slow));  // three times seven seeds run, and it never ends
    campaign.wait_for_results(1 + 3 * kill);
    std::this_thread::sleep_for(milliseconds(generator() % 30));
    campaign.kill_workers();
    std::this_thread::sleep_for(milliseconds(generator() % 30));
    if (kill % 2 == 0) campaign.kill_workers();
    campaign.signal(SIGKILL);
    ASSERT_EQ(campaign.finish(), -SIGKILL) << campaign.log();
  }
  EXPECT_EQ(campaign.run(several_at_once()), 0) << campaign.log();
  EXPECT_EQ(canonical_export(campaign), plain_answer(3));
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
}

// Each fault but the crash ends less often than a seed may be blamed, because it is blamed each time that the
// seed is alone in an engine, which may be the first time already.
TEST(SeveralAtOnce, OnlyTheSeedsThatAreAtFaultAreGivenUp) {
  CampaignOnDisk campaign(1);
  campaign.document["realisations"]["minimum"] = 24;
  campaign.options.lease_seconds = 2;  // far more than a seed without a fault takes on a busy machine
  EXPECT_EQ(campaign.run(
                several_at_once({{"PECLET_FAKE_FAULTS", "crash:3 exit:11x1 hang:7x2 refuse:9x2 lie:13x1"}})),
            3)
      << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'quarantined'"), 1);
  EXPECT_EQ(campaign.count("SELECT seed FROM realisation WHERE state = 'quarantined'"), 3);
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt WHERE seed = 3"), 3);
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt WHERE seed NOT IN (3, 7, 9, 11, 13)"), 0);
  EXPECT_NE(campaign.log().find("none is blamed, and they are tried again in smaller groups"),
            std::string::npos);
}

// One process does more at once, and the forecast knows it.
TEST(SeveralAtOnce, TheStatusCountsWorkersAndRealisations) {
  CampaignOnDisk campaign(3);
  campaign.options.workers = 1;
  campaign.start(campaign.held_from(1, several_at_once()));
  campaign.wait_until("six seeds that run", [&] {
    return campaign.count("SELECT count(*) FROM lease WHERE phase != 'starting'") == 6;
  });
  EXPECT_EQ(campaign.reader().last_workers(), 6);
  Database reader = campaign.reader();
  const CampaignStatus status = read_status(reader, 4711);
  EXPECT_EQ(totals_of(status).workers, 1);
  EXPECT_TRUE(says(workers_text(status), "0  6 realisations")) << workers_text(status);
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75) << campaign.log();
}

TEST(Device, ReachesTheEngineWhoseRefusalReachesTheUser) {
  CampaignOnDisk campaign;
  campaign.options.device = "cuda";
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_NO_DEVICE", "1"}}), 1);
  EXPECT_NE(campaign.log().find("there is no device here"), std::string::npos) << campaign.log();
  EXPECT_FALSE(std::filesystem::exists(campaign.directory().root()));
  campaign.options.device = "none";
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_NO_DEVICE", "1"}, {"PECLET_DEVICE", "cuda"}}), 0) << campaign.log();
}

TEST(Device, EachWorkerGetsOne) {
  CampaignOnDisk campaign;
  campaign.document["engine"] = {"/bin/sh", "-c",
                                 "echo $PECLET_DEVICE $PECLET_DEVICE_NUMBER >&2; exec \"$0\"", FAKE_ENGINE};
  campaign.options.device = "cuda";
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  for (const int worker : {0, 1}) {
    EXPECT_TRUE(
        read_file(campaign.directory().worker_log(worker)).starts_with(fmt::format("cuda {}\n", worker)));
  }
}

TEST(Device, ACardHasOneEngine) {
  RunOptions options;
  options.device = "cuda";
  EXPECT_EQ(worker_count(options).workers, 1);
  options.workers = 3;
  EXPECT_EQ(worker_count(options).workers, 3);
}

}  // namespace
}  // namespace peclet::runner
