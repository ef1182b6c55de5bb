// Which fraction comes next, and the campaign file that has it.
#include "runner/jamming/proposal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "runner/jamming/find_jamming.h"
#include "tests/runner/jamming/jamming_campaign.h"

namespace peclet::runner {
namespace {

// A curve without a database: flowing points of the law with errors of 1 %, and what is jammed.
JammingCurve curve_of(const std::vector<double>& flowing, const std::vector<double>& jammed,
                      const TrueLaw& law = {}) {
  JammingCurve curve;
  const auto add = [&](double phi, FlowState state) {
    JammingPoint point;
    point.fraction = phi;
    point.state = state;
    point.cpu_seconds = 10;
    if (state == FlowState::flowing) point.estimate = {16, law.at(phi), 0.01 * law.at(phi)};
    curve.points.push_back(point);
  };
  for (const double phi : flowing) add(phi, FlowState::flowing);
  for (const double phi : jammed) add(phi, FlowState::jammed);
  return curve;
}

std::optional<ProposedPoint> next_of(const JammingCurve& curve, const std::vector<double>& proposed = {}) {
  return next_fraction(estimate_jamming(curve, {}), {}, proposed);
}

TEST(JammingProposal, HalvesWhatIsBetweenFlowingAndJammed) {
  const JammingCurve curve = curve_of({0.56, 0.60}, {0.66, 0.70});
  EXPECT_NEAR(next_of(curve)->fraction, 0.63, 1e-12);
  // The widest gap of what is left, the lower one first.
  EXPECT_NEAR(next_of(curve, {0.63})->fraction, 0.615, 1e-12);
  EXPECT_NEAR(next_of(curve, {0.63, 0.615})->fraction, 0.645, 1e-12);
}

TEST(JammingProposal, GoesOnWhereAllFlowsOrNothingDoes) {
  EXPECT_NEAR(next_of(curve_of({0.40, 0.42}, {}))->fraction, 0.44, 1e-12);
  EXPECT_NEAR(next_of(curve_of({0.40, 0.42}, {}), {0.44})->fraction, 0.46, 1e-12);
  EXPECT_NEAR(next_of(curve_of({}, {0.66, 0.70}))->fraction, 0.64, 1e-12);
  EXPECT_FALSE(next_of(curve_of({}, {0.01})));
}

// The best fraction by trying: the law is fitted anew with a point more at each, of the same error.
TEST(JammingProposal, LessensTheErrorOfTheLawMost) {
  const std::vector<double> flowing{0.50, 0.53, 0.56, 0.58, 0.60};
  const std::optional<ProposedPoint> found = next_of(curve_of(flowing, {0.66}));
  ASSERT_TRUE(found);
  const auto error_with = [&](double phi) {
    std::vector<double> more = flowing;
    more.push_back(phi);
    std::vector<LawPoint> points;
    for (const double one : more) {
      const double eta = TrueLaw{}.at(one);
      points.push_back({one, eta, 1e-4 * eta, 16});
    }
    return fit_law(points, {}, std::max(0.60, phi)).law->fraction.standard_error;
  };
  // Up to half-way from 0.60 to 0.65.
  EXPECT_LE(found->fraction, 0.625 + 1e-9);
  for (double phi = 0.502; phi < 0.6245; phi += 0.004)
    EXPECT_LE(error_with(found->fraction), 1.001 * error_with(phi)) << phi;
  EXPECT_LT(error_with(found->fraction), 0.6 * error_with(0.55));
}

TEST(JammingProposal, ABudgetSaysHowMany) {
  const std::vector<JammingEstimate> estimates{estimate_jamming(curve_of({0.5, 0.6}, {0.66}), {}),
                                               estimate_jamming(curve_of({0.4, 0.5}, {0.60}), {})};
  const ProposedPoints plain = propose_points(estimates, {}, std::nullopt);
  ASSERT_EQ(plain.points.size(), 2U);  // one a curve
  EXPECT_NEAR(plain.points[0].fraction, 0.63, 1e-12);
  EXPECT_NEAR(plain.points[1].fraction, 0.55, 1e-12);
  EXPECT_EQ(plain.cpu_seconds, 20);  // the dearest point of both curves
  EXPECT_EQ(propose_points(estimates, {}, 79).points.size(), 3U);
  EXPECT_EQ(propose_points(estimates, {}, 1e9).points.size() <= 20, true);
  const ProposedPoints none = propose_points(estimates, {}, 19);
  EXPECT_TRUE(none.points.empty());
  EXPECT_TRUE(says(none.obstacle, "more than the budget")) << none.obstacle;
}

TEST(JammingProposal, ChangesTheEntryOfTheSweep) {
  const std::vector<ProposedPoint> points{{0.63, ""}, {0.55, ""}};
  const Json sweep = {{{"set", "/peclet"}, {"values", {1, 10}}},
                      {{"set", "/volume_fraction"}, {"values", {0.5, 0.6}}}};
  const SweepChange change = add_to_sweep(sweep, "/volume_fraction", points, "jam.json");
  // What anybody's implementation of RFC 6902 makes of the patch.
  EXPECT_EQ(sweep.patch(Json::parse(R"([{"op": "add", "path": "/1/values/-", "value": 0.63},
                                        {"op": "add", "path": "/1/values/-", "value": 0.55}])")),
            change.sweep);
  EXPECT_EQ(Json({{"sweep", sweep}}).patch(change.patch)["sweep"], change.sweep);
  const Json listed = {{{"set", {"/volume_fraction"}}, {"values", Json::parse("[[0.5]]")}}};
  EXPECT_EQ(add_to_sweep(listed, "/volume_fraction", {{0.63, ""}}, "").sweep[0]["values"],
            Json::parse("[[0.5], [0.63]]"));
  const Json in_step = {
      {{"set", {"/volume_fraction", "/particles/count"}}, {"values", Json::parse("[[0.5, 100]]")}}};
  try {
    add_to_sweep(in_step, "/volume_fraction", points, "jam.json");
    FAIL();
  } catch (const InputError& fault) {
    EXPECT_TRUE(says(fault.what(), "jam.json: /sweep/0/set: ")) << fault.what();
    EXPECT_TRUE(says(fault.what(), "add the rows by hand")) << fault.what();
  }
}

class WrittenProposal : public testing::Test {
 protected:
  WrittenProposal() : campaign(document) {
    campaign.complete(0, TrueLaw{}.at(0.56));
    campaign.complete(1, TrueLaw{}.at(0.60));
    campaign.jam(2);
    options.campaign = campaign.stored().directory().root();
    options.propose = true;
    options.write = folder_.path() / "next.json";
  }
  std::string refusal() {
    try {
      find_jamming(options);
    } catch (const InputError& fault) {
      return fault.what();
    }
    return "";
  }

  const Json document = jamming_document({0.56, 0.60, 0.66});
  JammingCampaign campaign;
  JammingOptions options;

 private:
  TemporaryFolder folder_;
};

TEST_F(WrittenProposal, KeepsThePointsThatThereAre) {
  const JammingAnswer answer = find_jamming(options);
  EXPECT_TRUE(says(answer.text, "next: 0.63, half-way between 0.6, which flows, and 0.66, which is jammed"))
      << answer.text;
  EXPECT_TRUE(says(answer.message, "next.json --directory ")) << answer.message;
  const Campaign before = parse_campaign(document, ""), after = read_campaign(options.write);
  ASSERT_EQ(after.points.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(after.points[i].hash, before.points[i].hash);
  EXPECT_EQ(after.points[3].settings, Json({{"/volume_fraction", 0.63}}));
}

TEST_F(WrittenProposal, ReplacesNoFile) {
  std::ofstream(options.write) << "mine";
  EXPECT_TRUE(says(refusal(), "--write: is there already, and is never replaced")) << refusal();
  EXPECT_EQ(read_file(options.write), "mine");
}

TEST_F(WrittenProposal, OptionsOfAProposalNeedOne) {
  options.propose = false;
  EXPECT_EQ(refusal(), "--write: is for --propose");
  options.write.clear();
  options.budget = 10;
  EXPECT_EQ(refusal(), "--budget: is for --propose");
}

}  // namespace
}  // namespace peclet::runner
