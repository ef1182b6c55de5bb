// Campaigns of a fixed number of realisations, from the file to the table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/command_line/ask_owner.h"
#include "runner/command_line/validate.h"
#include "runner/page/page_data.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "tests/runner/campaign_process.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

class FixedNumberCampaign : public testing::Test {
 protected:
  FixedNumberCampaign() { fix(12); }
  void fix(int seeds) {
    campaign_.document.erase("target");
    campaign_.document["realisations"] = seeds;
  }
  Reply set(const std::function<void(SetOptions&)>& choose) {
    SetOptions options;
    options.campaign = campaign_.options.campaign;
    choose(options);
    return set_campaign(options);
  }
  std::string table() {
    Database database = campaign_.reader();
    return status_table(read_status(database));
  }
  std::string canonical() {
    Database database = campaign_.reader();
    return export_json(database, true);
  }
  // Returns the export of a new campaign with the same document.
  std::string undisturbed(const Environment& environment = {}) const {
    CampaignOnDisk fresh;
    fresh.document = campaign_.document;
    fresh.run(environment);
    Database database = fresh.reader();
    return export_json(database, true);
  }

  CampaignOnDisk campaign_;
};

// A deviation of 30 % that no usual tolerance would meet.
const Environment wide{{"PECLET_FAKE_DEVIATION", "3"}};

TEST_F(FixedNumberCampaign, GivesEveryPointItsSeedsAndEndsWithZero) {
  EXPECT_EQ(campaign_.run(wide), 0) << campaign_.log();
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM realisation WHERE state = 'done'"), 24);
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM realisation WHERE seed >= 12"), 0);
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM stop_test WHERE verdict = 'complete' AND seeds = 12"), 2);
  const std::string text = table();
  EXPECT_TRUE(says(text, "test: relative_viscosity, 12 seeds a point\n")) << text;
  EXPECT_TRUE(says(text, "seeds  relative_viscosity  verdict")) << text;
  EXPECT_TRUE(says(text, "12/12")) << text;
  EXPECT_TRUE(says(text, "complete\n")) << text;
  EXPECT_TRUE(says(text, "2 points: 2 complete\n24 seeds ended;")) << text;
  Database database = campaign_.reader();
  const std::string told = explain(database, campaign_.directory(), "peclet=1");
  EXPECT_TRUE(says(told, "complete: all 12 seeds have ended\n")) << told;
  EXPECT_FALSE(says(told, "tolerance")) << told;
  EXPECT_TRUE(says(told, "next: nothing; more realisations (`peclet set --realisations`)")) << told;
  EXPECT_TRUE(says(export_csv(database, true), ",complete,12,0,12,"));
}

TEST_F(FixedNumberCampaign, EndsWithThreeWhereSeedsAreLost) {
  EXPECT_EQ(campaign_.run({{"PECLET_FAKE_FAULTS", "overlap:6"}}), 3) << campaign_.log();
  EXPECT_EQ(
      campaign_.count("SELECT count(*) FROM stop_test WHERE verdict = 'complete-with-losses' AND lost = 1"),
      2);
  EXPECT_TRUE(says(table(), "complete-with-losses(1)")) << table();
  Database database = campaign_.reader();
  EXPECT_TRUE(says(explain(database, campaign_.directory(), "peclet=1"),
                   "all 12 seeds have ended, and 1 of them are lost"));
}

TEST_F(FixedNumberCampaign, IsRaisedAndLoweredAsIfItHadAlwaysBeenSo) {
  ASSERT_EQ(campaign_.run(), 0) << campaign_.log();
  for (const int seeds : {16, 8}) {
    const Reply reply = set([&](SetOptions& options) { options.realisations = seeds; });
    EXPECT_EQ(reply.exit_code, 0);
    EXPECT_TRUE(says(reply.text, fmt::format("-> {}\n", seeds))) << reply.text;
    fix(seeds);
    EXPECT_EQ(read_json(campaign_.options.campaign), campaign_.document);
    EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
    EXPECT_EQ(canonical(), undisturbed());
  }
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM attempt WHERE outcome = 'result'"), 32);
}

TEST_F(FixedNumberCampaign, IsRaisedWhileItRuns) {
  campaign_.start(campaign_.held_from(10));
  campaign_.wait_for_results(4);
  set([](SetOptions& options) { options.realisations = 20; });
  campaign_.release();
  EXPECT_EQ(campaign_.finish(), 0) << campaign_.log();
  fix(20);
  EXPECT_EQ(canonical(), undisturbed());
}

// A fixed number that was not enough may be replaced by a target; the seeds that have ended count.
TEST_F(FixedNumberCampaign, BecomesATargetAndBack) {
  ASSERT_EQ(campaign_.run(), 0) << campaign_.log();
  const Json fixed = campaign_.document;
  campaign_.document.erase("realisations");
  campaign_.document.merge_patch(
      {{"target", {{"relative_tolerance", 0.05}}}, {"realisations", {{"minimum", 8}, {"maximum", 60}}}});
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  EXPECT_EQ(canonical(), undisturbed());
  campaign_.document = fixed;
  write_durably(campaign_.options.campaign, fixed.dump());
  const std::string said = set([](SetOptions&) {}).text;
  EXPECT_TRUE(says(said, "tolerance 5 % -> none; realisations 8 to 60 -> 12\n")) << said;
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  EXPECT_EQ(canonical(), undisturbed());
}

TEST_F(FixedNumberCampaign, SaysWhichOptionOfSetIsMeant) {
  write_durably(campaign_.options.campaign, campaign_.document.dump());
  const auto refusal = [&](const std::function<void(SetOptions&)>& choose) {
    try {
      set(choose);
      return std::string();
    } catch (const InputError& error) {
      return error.pointer() + ' ' + error.allowed();
    }
  };
  EXPECT_TRUE(says(refusal([](SetOptions& options) { options.maximum = 20; }),
                   "/realisations is a fixed number, changed by --realisations"));
  EXPECT_TRUE(says(refusal([](SetOptions& options) { options.tolerance = 0.1; }),
                   "/realisations is a fixed number, changed by --realisations"));
  write_durably(campaign_.options.campaign, CampaignOnDisk().document.dump());
  EXPECT_TRUE(says(refusal([](SetOptions& options) { options.realisations = 20; }),
                   "/realisations belongs to a target, and is changed by --minimum and --maximum"));
}

TEST_F(FixedNumberCampaign, NamesWhatResultsWillNotHave) {
  campaign_.document["show"] = {"relative_viscosity", "colour"};
  write_durably(campaign_.options.campaign, campaign_.document.dump());
  try {
    validate_campaign({campaign_.options.campaign});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/show/1");
    EXPECT_EQ(error.value(), "colour");
    EXPECT_EQ(error.allowed(),
              "must be a number that the results of the point peclet=1 will have: relative_viscosity");
  }
}

// Viscosities of 1 to 5 with a control variate of 0.25: 3.25 ± 2.776445 sqrt(2.5 / 5); pressures of twice 1
// to 5.
TEST(FixedNumberShown, HasAColumnForEachQuantity) {
  Campaign shown = plain_campaign(2, 5, 5, 0.05);
  shown.target = {"relative_viscosity", Tolerance::none(), 0.95};
  shown.target.also = {{"pressure", Tolerance::none()}};
  StoredCampaign campaign(shown);
  for (int seed = 0; seed < 5; ++seed) campaign.complete(0, seed, seed + 1);
  for (int seed = 0; seed < 3; ++seed) campaign.complete(1, seed, seed + 1);
  const CampaignStatus status = read_status(campaign.database());
  EXPECT_EQ(exit_code_of(status), 4);
  const std::string text = status_table(status);
  EXPECT_TRUE(says(text, "plain: relative_viscosity, pressure, 5 seeds a point\n")) << text;
  EXPECT_TRUE(says(text, "0        5/5           3.2 ± 2.0  6.0 ± 3.9  complete")) << text;
  // scipy.stats.t.ppf(0.975, 2) = 4.302653; 1 to 3 have the variance 1.
  EXPECT_TRUE(says(text, "1        3/5           2.2 ± 2.5  4.0 ± 5.0  open")) << text;
  const Json target = status_json(status).at("target");
  EXPECT_EQ(target, Json({{"observable", "relative_viscosity"},
                          {"confidence", 0.95},
                          {"also", {{{"observable", "pressure"}}}}}));
  const Json page = page_data(campaign.database(), std::nullopt);
  EXPECT_EQ(page.at("target").at("text"), "relative_viscosity, pressure");
}

}  // namespace
}  // namespace peclet::runner
