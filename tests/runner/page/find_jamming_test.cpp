// `peclet jamming`: its text and the file with proposed points. tests/python/jamming_test.py tests the fits.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/page/jamming.h"
#include "tests/contract/refusal.h"
#include "tests/runner/page/jamming_campaign.h"

namespace peclet::runner {
namespace {

using Jamming = PythonOfDebian;

TEST_F(Jamming, GivesTheLawOfTheSeedsBackToPeopleAndPrograms) {
  const std::vector<double> fractions{0.45, 0.50, 0.54, 0.57, 0.60, 0.62, 0.66};
  JammingCampaign campaign(jamming_document(fractions));
  for (int point = 0; point < 6; ++point)
    campaign.complete(point, TrueLaw{}.at(fractions[static_cast<std::size_t>(point)]));
  campaign.jam(6);
  JammingOptions options;
  options.campaign = campaign.stored().directory().root();
  const std::string table = find_jamming(options).text;
  EXPECT_TRUE(says(table, "jam: relative_viscosity over /volume_fraction, 1 curve\n")) << table;
  EXPECT_TRUE(says(table, "0.66 jammed")) << table;
  options.json = true;
  const Json answer = Json::parse(find_jamming(options).text);
  const Json& curve = answer["curves"].at(0);
  EXPECT_EQ(answer["schema_version"], 1);
  EXPECT_EQ(curve["flowing"], 6);
  EXPECT_EQ(curve["smallest_stuck"], Json({{"fraction", 0.66}, {"state", "jammed"}}));
  EXPECT_NEAR(curve["law"]["phi_m"]["value"].get<double>(), TrueLaw{}.fraction, 1e-6);
  EXPECT_EQ(curve["points"].size(), 7U);
  EXPECT_EQ(curve["points"][6]["mean"], nullptr);
}

class JammingProposal : public PythonOfDebian {
 protected:
  explicit JammingProposal(const Json& sweep = jamming_document({0.56, 0.60, 0.66}))
      : document(sweep), campaign(document) {
    campaign.complete(0, TrueLaw{}.at(0.56));
    campaign.complete(1, TrueLaw{}.at(0.60));
    campaign.jam(2);
    options.campaign = campaign.stored().directory().root();
    options.propose = true;
    options.write = folder_.path() / "next.json";
  }
  std::string refusal() {
    return refusal_by([&] { find_jamming(options); });
  }

  const Json document;
  JammingCampaign campaign;
  JammingOptions options;

 private:
  TemporaryFolder folder_;
};

TEST_F(JammingProposal, KeepsThePointsThatThereAre) {
  const Proposal answer = find_jamming(options);
  EXPECT_TRUE(says(answer.text, "next: 0.63, half-way between 0.6, which flows, and 0.66, which is jammed"))
      << answer.text;
  EXPECT_TRUE(says(answer.message, "next.json --directory ")) << answer.message;
  const Campaign before = parse_campaign(document, ""), after = read_campaign(options.write);
  ASSERT_EQ(after.points.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(after.points[i].hash, before.points[i].hash);
  EXPECT_EQ(after.points[3].settings, Json({{"/volume_fraction", 0.63}}));
}

TEST_F(JammingProposal, ReplacesNoFile) {
  std::ofstream(options.write) << "mine";
  EXPECT_TRUE(says(refusal(), "--write: is there already, and is never replaced")) << refusal();
  EXPECT_EQ(read_file(options.write), "mine");
}

TEST_F(JammingProposal, HasOptionsThatNeedOne) {
  options.propose = false;
  EXPECT_EQ(refusal(), "--write: is for --propose");
  options.write.clear();
  options.budget = 10;
  EXPECT_EQ(refusal(), "--budget: is for --propose");
}

class JammingInStep : public JammingProposal {
 protected:
  JammingInStep() : JammingProposal(in_step()) {}

 private:
  static Json in_step() {
    Json document = jamming_document({});
    document["sweep"][0] = {{"set", {"/volume_fraction", "/contact/friction"}},
                            {"values", Json::parse("[[0.56, 0], [0.6, 0.1], [0.66, 0.2]]")}};
    return document;
  }
};

TEST_F(JammingInStep, RefusesToAddRows) {
  EXPECT_TRUE(says(refusal(), ": /sweep/0/set: ")) << refusal();
  EXPECT_TRUE(says(refusal(), "add the rows by hand")) << refusal();
}

TEST_F(JammingProposal, SaysWhatItWouldHaveRunWithoutPython) {
  const TemporaryFolder empty;
  std::filesystem::create_symlink("/usr/bin/env", empty.path() / "env");
  setenv("PATH", empty.path().c_str(), 1);
  std::string said;
  try {
    find_jamming(options);
  } catch (const InputError&) {
  } catch (const std::runtime_error& fault) {
    said = fault.what();
  }
  EXPECT_TRUE(says(said, "jamming: the fits need python3 with NumPy (Debian: python3-numpy)")) << said;
  EXPECT_TRUE(says(said, "`python3 " PECLET_SOURCE_DIR "/python/peclet/answer.py jamming_report` has not "
                         "run: "))
      << said;
  EXPECT_FALSE(std::filesystem::exists(options.write));
}

}  // namespace
}  // namespace peclet::runner
