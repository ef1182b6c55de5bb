// Real processes of `peclet plan --pilot`, and of the campaign that follows.
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "runner/reports/status.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

TEST(Pilot, RunsTheFirstSeedsOfEveryPointAndPredicts) {
  CampaignOnDisk campaign(3);
  campaign.pilot = 3;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'"), 9);
  EXPECT_EQ(campaign.count("SELECT max(seed) FROM realisation WHERE state = 'done'"), 2);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction WHERE pilot = 3 AND lower <= seeds AND seeds <= "
                           "upper AND cpu_seconds > 0"),
            3);
  EXPECT_NE(campaign.log().find("with 2 workers"), std::string::npos) << campaign.log();
}

TEST(Pilot, IsPartOfTheCampaignThatFollows) {
  CampaignOnDisk undisturbed(2);
  ASSERT_EQ(undisturbed.run(), 0) << undisturbed.log();
  CampaignOnDisk campaign(2);
  campaign.pilot = 4;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  campaign.pilot.reset();
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.answer(), undisturbed.answer());
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'result'"),
            campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'"));
}

TEST(Pilot, StatusJudgesTheFirstPrediction) {
  CampaignOnDisk campaign(2);
  campaign.pilot = 3;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  campaign.pilot = 5;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction WHERE pilot = 3"), 2);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 2);
  campaign.pilot.reset();
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  Database database = campaign.reader();
  const Json point = status_json(read_status(database))["points"][0]["prediction"];
  EXPECT_EQ(point["pilot"], 3);
  EXPECT_EQ(point["taken"]["seeds"],
            campaign.count("SELECT seeds FROM stop_test WHERE point_id = 1 AND verdict = 'converged'"));
}

TEST(Pilot, AKilledOneGoesOn) {
  CampaignOnDisk campaign(3);
  campaign.pilot = 4;
  campaign.start(campaign.held_from(3));
  campaign.wait_for_results(3);
  campaign.signal(SIGKILL);
  ASSERT_EQ(campaign.finish(), -SIGKILL);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 0);
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'"), 12);
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 3);
}

TEST(Pilot, AStoppedOnePredictsNothing) {
  CampaignOnDisk campaign(3);
  campaign.pilot = 4;
  campaign.start(campaign.held_from(3));
  campaign.wait_for_results(1);
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 0);
}

TEST(Pilot, LostSeedsPredictNothingAndSaySo) {
  CampaignOnDisk campaign(1);
  campaign.pilot = 3;
  EXPECT_EQ(campaign.run({{"PECLET_FAKE_FAULTS", "overlap:0 overlap:1 overlap:2"}}), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 0);
  EXPECT_NE(campaign.log().find("3 of 3 seeds are lost"), std::string::npos) << campaign.log();
}

TEST(Pilot, ANumberThatMakesNoSenseWritesNothing) {
  for (const int pilot : {1, 9}) {
    CampaignOnDisk campaign;
    campaign.pilot = pilot;
    EXPECT_EQ(campaign.run(), 2) << campaign.log();
    EXPECT_NE(campaign.log().find("must be an integer from 2 to /realisations/minimum"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(campaign.directory().root()));
  }
}

TEST(Pilot, APointThatIsDecidedNeedsNone) {
  CampaignOnDisk campaign(1);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const std::int64_t attempts = campaign.count("SELECT count(*) FROM attempt");
  campaign.pilot = 8;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt"), attempts);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM prediction"), 0);
}

}  // namespace
}  // namespace peclet::runner
