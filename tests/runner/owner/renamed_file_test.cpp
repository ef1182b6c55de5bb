#include <gtest/gtest.h>

#include <filesystem>

#include "contract/errors.h"
#include "runner/campaign/campaign_file.h"
#include "runner/owner/open_campaign.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class Renamed : public testing::Test {
 protected:
  Renamed() {
    campaign_.document["realisations"] = {{"minimum", 8}, {"maximum", 8}};
    campaign_.run();
  }
  fs::path other(const char* name) const { return campaign_.options.campaign.parent_path() / name; }

  CampaignOnDisk campaign_;
};

TEST_F(Renamed, AFileWhoseFolderKeptTheOldNameIsRefused) {
  fs::rename(campaign_.options.campaign, other("new.json"));
  const Campaign campaign = read_campaign(other("new.json"));
  const CampaignDirectory directory = campaign_directory(other("new.json"), "");
  try {
    refuse_renamed_file(campaign, other("new.json"), directory);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("16 results"), std::string::npos) << text;  // two points of eight seeds
    EXPECT_NE(text.find("`mv " + other("test.peclet").string() + " " + other("new.peclet").string() +
                        " && peclet run " + other("new.json").string() + "`"),
              std::string::npos)
        << text;
  }
}

TEST_F(Renamed, ACopyOfAFileThatIsStillThereStartsAfresh) {
  fs::copy_file(campaign_.options.campaign, other("new.json"));
  const Campaign campaign = read_campaign(other("new.json"));
  EXPECT_NO_THROW(
      refuse_renamed_file(campaign, other("new.json"), campaign_directory(other("new.json"), "")));
}

TEST_F(Renamed, OtherScenesAreAnotherCampaign) {
  Campaign campaign = read_campaign(campaign_.options.campaign);
  for (StatePoint& point : campaign.points) point.hash = std::string(64, '0');
  fs::rename(campaign_.options.campaign, other("new.json"));
  EXPECT_NO_THROW(
      refuse_renamed_file(campaign, other("new.json"), campaign_directory(other("new.json"), "")));
}

TEST_F(Renamed, AFolderIsNoFileAndASimilarNameIsOffered) {
  const auto complaint = [](const fs::path& given) -> std::string {
    try {
      require_campaign_file(given);
    } catch (const InputError& error) {
      return error.allowed();
    }
    return "accepted";
  };
  EXPECT_EQ(complaint(campaign_.options.campaign), "accepted");
  EXPECT_EQ(complaint(campaign_.directory().root()),
            "is a folder, but must be the campaign file: " + campaign_.options.campaign.string());
  EXPECT_EQ(complaint(other("tset.json")),
            "no such file; did you mean " + campaign_.options.campaign.string() + "?");
  EXPECT_EQ(complaint(other("something.json")), "no such file");
}

}  // namespace
}  // namespace peclet::runner
