// Requests to campaigns that run in processes of their own, or have finished.
#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <future>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/command_line/ask_owner.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "runner/store/locks.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

using std::chrono::milliseconds;

// A realisation takes 0.2 s, and points take all seeds that they may have: the campaign lasts for a minute.
const Environment endless{{"PECLET_FAKE_STEP_MS", "20"}, {"PECLET_FAKE_DEVIATION", "5"}};
const Environment wide{{"PECLET_FAKE_DEVIATION", "5"}};
constexpr int many = 400;

// Returns the SHA-256 of the canonical export.
std::string canonical(const CampaignOnDisk& campaign) {
  Database database = campaign.reader();
  return sha256(export_json(database, true));
}

// Returns the export of a campaign of that document that is not disturbed.
std::string undisturbed(const Json& document, const Environment& environment) {
  CampaignOnDisk campaign;
  campaign.document = document;
  campaign.run(environment);
  return canonical(campaign);
}

Reply set(const CampaignOnDisk& campaign, const std::function<void(SetOptions&)>& choose) {
  SetOptions options;
  options.campaign = campaign.options.campaign;
  choose(options);
  return set_campaign(options);
}

Reply cancel(const CampaignOnDisk& campaign, const std::vector<std::string>& points, bool undo = false) {
  return cancel_points({campaign.options.campaign, {}, points, undo});
}

void wait_until(const CampaignOnDisk& campaign, const std::string& sql, std::int64_t wanted) {
  campaign.wait_until(sql, [&] { return campaign.count(sql) == wanted; });
}

TEST(Set, ReopensAFinishedCampaignWhichThenGivesWhatAFreshOneDoes) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const Reply reply = set(campaign, [](SetOptions& options) { options.tolerance = 0.04; });
  EXPECT_EQ(reply.exit_code, 0);
  EXPECT_EQ(reply.text,
            "set: tolerance 5 % -> 4 %\ngo on with: peclet run " + campaign.options.campaign.string() + "\n");
  Database database = campaign.reader();
  EXPECT_EQ(exit_code_of(read_status(database)), 4);

  campaign.document["target"]["relative_tolerance"] = 0.04;
  EXPECT_EQ(read_json(campaign.options.campaign), campaign.document);
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, {}));
}

TEST(Set, LeavesTheFileAsItWasWhenTheChangeIsRefused) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  campaign.document["target"]["observable"] = "colour";  // an observable that no result has
  const std::string before = campaign.document.dump();
  write_durably(campaign.options.campaign, before);
  EXPECT_THROW(set(campaign, [](SetOptions& options) { options.tolerance = 0.04; }), InputError);
  EXPECT_EQ(read_file(campaign.options.campaign), before);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM target"), 1);
}

// This is so if a campaign was restored into the folder of its file.
TEST(Set, DoesNotWaitForWhoOwnsTheFolderOfTheFile) {
  CampaignOnDisk campaign;
  write_durably(campaign.options.campaign, campaign.document.dump());
  const OwnerLock owner(CampaignDirectory(campaign.options.campaign.parent_path()));
  EXPECT_EQ(set(campaign, [](SetOptions& options) { options.tolerance = 0.04; }).exit_code, 0);
  EXPECT_EQ(read_json(campaign.options.campaign)["target"]["relative_tolerance"], 0.04);
}

TEST(Set, ChangesTheTargetOfARunningCampaign) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = many;
  campaign.start(endless);
  campaign.wait_for_results(2);
  const Reply reply = set(campaign, [](SetOptions& options) {
    options.tolerance = 0.9;
    options.maximum = 300;
  });
  EXPECT_TRUE(reply.text.starts_with("set: tolerance 5 % -> 90 %; maximum 400 -> 300\nprocess "))
      << reply.text;
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
  campaign.document["target"]["relative_tolerance"] = 0.9;
  campaign.document["realisations"]["maximum"] = 300;
  EXPECT_EQ(read_json(campaign.options.campaign), campaign.document);
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, wide));
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
}

TEST(Set, TakesOverPointsThatWereAddedAndLeftOut) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = many;
  campaign.start(endless);
  campaign.wait_for_results(2);
  campaign.document["sweep"][0]["values"] = {3, 2};
  campaign.document["target"]["relative_tolerance"] = 0.9;
  write_durably(campaign.options.campaign, campaign.document.dump());
  const Reply reply = set(campaign, [](SetOptions&) {});
  EXPECT_TRUE(reply.text.starts_with("set: tolerance 5 % -> 90 %; 1 point added; 1 point left out\n"))
      << reply.text;
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, wide));
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM lease"), 0);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'running'"), 0);
}

TEST(Set, RefusesAFaultWithNothingWritten) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const std::string before = read_file(campaign.options.campaign);
  const std::vector<std::pair<std::function<void(SetOptions&)>, std::string>> faults{
      {[](SetOptions& options) { options.tolerance = 5; }, "/target/relative_tolerance: 5.0: must be"},
      {[](SetOptions& options) { options.absolute_tolerance = 0.1; },
       "/target/relative_tolerance: 0.05: is changed by --tolerance, not by --absolute-tolerance"},
      {[](SetOptions& options) { options.minimum = 100; }, "/realisations/maximum: 60: must be"},
      {[](SetOptions& options) { options.priority = 1; }, "--priority: needs the points"},
      {[](SetOptions& options) { options.points = {"peclet=1"}; }, "--point: is for --priority"},
      {[](SetOptions& options) { options.campaign = "absent.json"; }, "absent.json: no such file"}};
  for (const auto& [fault, message] : faults) {
    try {
      set(campaign, fault);
      ADD_FAILURE() << message;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(read_file(campaign.options.campaign), before);
  EXPECT_TRUE(waiting_requests(campaign.directory()).empty());
  EXPECT_EQ(campaign.count("SELECT count(*) FROM event WHERE request IS NOT NULL"), 0);
}

TEST(Set, ChangesTheToleranceOfACurve) {
  CampaignOnDisk campaign(4);
  campaign.document["target"] = Json::parse(R"({"curve": {"over": "/peclet", "relative_tolerance": 0.2}})");
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  set(campaign, [](SetOptions& options) { options.tolerance = 0.06; });
  campaign.document["target"]["curve"]["relative_tolerance"] = 0.06;
  EXPECT_EQ(read_json(campaign.options.campaign), campaign.document);
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, {}));
}

TEST(Set, SaysWhichOptionAnAbsoluteToleranceTakes) {
  CampaignOnDisk campaign;
  campaign.document["target"].erase("relative_tolerance");
  campaign.document["target"]["absolute_tolerance"] = 0.5;
  const std::string before = campaign.document.dump();
  write_durably(campaign.options.campaign, before);
  try {
    set(campaign, [](SetOptions& options) { options.tolerance = 0.04; });
    FAIL() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/target/absolute_tolerance");
    EXPECT_EQ(error.value(), "0.5");
    EXPECT_EQ(error.allowed(), "is changed by --absolute-tolerance, not by --tolerance");
  }
  EXPECT_EQ(read_file(campaign.options.campaign), before);
}

TEST(Set, OfACampaignThatWasNeverRunChangesItsFile) {
  CampaignOnDisk campaign;
  write_durably(campaign.options.campaign, campaign.document.dump(2));
  const Reply reply = set(campaign, [](SetOptions& options) { options.confidence = 0.9; });
  EXPECT_NE(reply.text.find("is changed; it has not been run yet"), std::string::npos) << reply.text;
  campaign.document["target"]["confidence"] = 0.9;
  EXPECT_EQ(read_file(campaign.options.campaign), campaign.document.dump(2));
  EXPECT_FALSE(std::filesystem::exists(campaign.directory().root()));
}

TEST(Set, OfTwoAtOnceNeitherIsLost) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  auto other = std::async(std::launch::async,
                          [&] { set(campaign, [](SetOptions& options) { options.tolerance = 0.04; }); });
  set(campaign, [](SetOptions& options) { options.maximum = 500; });
  other.get();
  campaign.document["target"]["relative_tolerance"] = 0.04;
  campaign.document["realisations"]["maximum"] = 500;
  EXPECT_EQ(read_json(campaign.options.campaign), campaign.document);
  EXPECT_EQ(campaign.count("SELECT maximum FROM campaign JOIN target USING (target_id)"), 500);
  EXPECT_EQ(
      campaign.count(
          "SELECT criterion = '{\"relative_tolerance\":0.04}' FROM campaign JOIN target USING (target_id)"),
      1);
}

TEST(Set, APriorityMakesTheLaterPointGoFirst) {
  CampaignOnDisk campaign;
  campaign.document["realisations"] = {{"minimum", many}, {"maximum", many}};
  campaign.start(endless);
  campaign.wait_for_results(2);
  set(campaign, [](SetOptions& options) {
    options.points = {"peclet=2"};
    options.priority = 3;
  });
  const std::int64_t first = campaign.count("SELECT max(attempt_id) FROM attempt");
  wait_until(campaign, "SELECT count(*) >= 6 FROM attempt WHERE attempt_id > " + std::to_string(first), 1);
  EXPECT_EQ(
      campaign.count("SELECT count(*) FROM attempt JOIN point USING (point_id) WHERE label = 'peclet=1' AND "
                     "attempt_id > " +
                     std::to_string(first)),
      0);
  campaign.signal(SIGTERM);
  EXPECT_EQ(campaign.finish(), 75);
}

TEST(Cancel, StopsThePointsSeedsWithoutBlameAndIsNoSuccess) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = many;
  campaign.document["target"]["relative_tolerance"] = 0.9;
  campaign.start({{"PECLET_FAKE_STEP_MS", "20"}, {"PECLET_FAKE_STEPS", "1000"}});
  campaign.wait_for_results(0);
  wait_until(campaign, "SELECT count(*) FROM realisation WHERE state = 'running'", 2);
  const Reply reply = cancel(campaign, {"peclet=1", "peclet=2"});
  EXPECT_TRUE(reply.text.starts_with("cancel: no more seeds: peclet=1, peclet=2\n")) << reply.text;
  EXPECT_EQ(campaign.finish(), 3) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0);
  EXPECT_GE(campaign.count("SELECT count(*) FROM attempt WHERE outcome = 'drained'"), 2);
  Database database = campaign.reader();
  const CampaignStatus status = read_status(database);
  EXPECT_EQ(exit_code_of(status), 3);
  EXPECT_EQ(verdict_text(status.points.at(0)), "cancelled");
  EXPECT_NE(status_table(status).find("2 points: 2 cancelled"), std::string::npos);
}

TEST(Cancel, TakenBackLeavesTheAnswerAsItWas) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 40;
  campaign.start(endless);
  campaign.wait_for_results(2);
  cancel(campaign, {"peclet=2"});
  campaign.wait_for_results(4);
  cancel(campaign, {"peclet=2"}, true);
  EXPECT_EQ(campaign.finish(), 3) << campaign.log();  // capped
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, wide));
}

TEST(Retry, OnARunningCampaignGivesSeedsAnotherChance) {
  CampaignOnDisk campaign;
  campaign.document["realisations"] = {{"minimum", 30}, {"maximum", 30}};
  Environment faulty = endless;
  faulty["PECLET_FAKE_FAULTS"] = "crash:0x3 overlap:1";
  campaign.start(faulty);
  campaign.wait_for_results(0);
  wait_until(campaign, "SELECT count(*) FROM realisation WHERE state = 'quarantined'", 2);
  RetryOptions options;
  options.campaign = campaign.options.campaign;
  EXPECT_TRUE(retry_seeds(options).text.starts_with("retry: 2 seeds queued again"));
  EXPECT_EQ(campaign.finish(), 3) << campaign.log();
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, {{"PECLET_FAKE_DEVIATION", "5"},
                                                                 {"PECLET_FAKE_FAULTS", "overlap:1"}}));
  EXPECT_EQ(campaign.count("SELECT count(*) FROM attempt WHERE pardoned = 1"), 6);
}

TEST(Requests, AreCarriedOutOnceWhenTheOwnerDiesBefore) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 12;
  campaign.start(campaign.held_from(7, endless));
  campaign.wait_for_results(2);
  campaign.signal(SIGSTOP);
  CancelOptions options{campaign.options.campaign, {}, {"peclet=2"}};
  options.patience = 0;
  EXPECT_NE(cancel_points(options).text.find("will carry the request out"), std::string::npos);
  EXPECT_EQ(waiting_requests(campaign.directory()).size(), 1U);
  campaign.signal(SIGKILL);
  EXPECT_EQ(campaign.finish(), -SIGKILL);
  EXPECT_EQ(campaign.run(wide), 3) << campaign.log();
  EXPECT_TRUE(waiting_requests(campaign.directory()).empty());
  EXPECT_EQ(campaign.count("SELECT count(*) FROM event WHERE kind = 'cancel'"), 1);
  EXPECT_EQ(campaign.count("SELECT cancelled FROM points WHERE label = 'peclet=2'"), 1);
}

TEST(Requests, AreCarriedOutByTheVerbWhenTheOwnerDiesWhileItWaits) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 12;
  campaign.start(campaign.held_from(7, endless));
  campaign.wait_for_results(2);
  campaign.signal(SIGSTOP);
  Reply reply;
  auto verb = std::async(std::launch::async, [&] { reply = cancel(campaign, {"peclet=2"}); });
  campaign.wait_until("the request", [&] { return waiting_requests(campaign.directory()).size() == 1; });
  campaign.signal(SIGKILL);
  EXPECT_EQ(campaign.finish(), -SIGKILL);
  verb.get();
  EXPECT_TRUE(reply.text.starts_with("cancel: no more seeds: peclet=2\ngo on with: peclet run"))
      << reply.text;
}

TEST(Requests, OfAnOwnerThatDoesNotComeToThemAreLeftToIt) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 12;
  campaign.start(campaign.held_from(7, endless));
  campaign.wait_for_results(2);
  campaign.signal(SIGSTOP);
  CancelOptions options{campaign.options.campaign, {}, {"peclet=2"}};
  options.patience = 0.3;
  const Reply reply = cancel_points(options);
  EXPECT_EQ(reply.exit_code, 4);
  EXPECT_NE(reply.text.find("has not carried the request out within 0.3 s, but will"), std::string::npos)
      << reply.text;
  campaign.signal(SIGCONT);
  campaign.release();
  EXPECT_EQ(campaign.finish(), 3) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM event WHERE kind = 'cancel'"), 1);
}

TEST(AcceptEngine, IsByNameAndNeverMixes) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 12;
  campaign.start(campaign.held_from(7, endless));
  campaign.wait_for_results(2);
  campaign.signal(SIGTERM);
  ASSERT_EQ(campaign.finish(), 75) << campaign.log();
  const std::int64_t results = campaign.count("SELECT count(*) FROM realisation WHERE state = 'done'");
  Environment other = wide;
  other["PECLET_FAKE_IDENTITY"] = "another";
  EXPECT_EQ(campaign.run(other), 6);
  // The refusal says what to type.
  const std::string hash = sha256("another").substr(0, 12);
  EXPECT_NE(campaign.log().find("`peclet run " + campaign.options.campaign.string() + " --accept-engine " +
                                hash + "`"),
            std::string::npos)
      << campaign.log();
  campaign.options.accept_engine = sha256("fake").substr(0, 12);
  EXPECT_EQ(campaign.run(other), 2) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM point"), 2);
  campaign.options.accept_engine = hash;
  EXPECT_EQ(campaign.run(other), 3) << campaign.log();
  EXPECT_EQ(canonical(campaign), undisturbed(campaign.document, other));
  EXPECT_EQ(
      campaign.count("SELECT count(*) FROM realisation JOIN point USING (point_id) WHERE set_aside = 1 AND "
                     "content_sha256 IS NOT NULL"),
      results);
  EXPECT_NE(campaign.log().find("are set aside"), std::string::npos);
}

}  // namespace
}  // namespace peclet::runner
