// Tests the explanation of verdicts.
#include "runner/reports/explain.h"

#include <gtest/gtest.h>

#include "contract/errors.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

TEST(Explain, LossesAreNamedByCauseAndSeedWithTheLastWords) {
  StoredCampaign campaign(1, 6, 20);
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  campaign.blow_up(0, 4);
  campaign.crash(0, 5);
  const std::string text = explain(campaign.database(), campaign.directory(), "point=0");
  EXPECT_TRUE(says(text, "lost: 1 crashed (seed 5)")) << text;
  EXPECT_TRUE(says(text, "lost: 1 overlap (seed 4)")) << text;
  EXPECT_TRUE(says(text, "attempts: 6 (1 crashed, 5 result)")) << text;
  EXPECT_TRUE(says(text, "seed 5 crashed at step 42: signal 11 (Segmentation fault)")) << text;
  EXPECT_TRUE(says(text, campaign.directory().failures().string())) << text;
}

TEST(Explain, ProgramsAreToldTheSame) {
  StoredCampaign campaign(2, 6, 20);
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, 10 + 0.01 * seed);
  campaign.blow_up(0, 4);
  campaign.crash(0, 5);
  const Json all = explain_json(campaign.database(), campaign.directory(), "");
  ASSERT_EQ(all["points"].size(), 2U);
  EXPECT_EQ(explain_json(campaign.database(), campaign.directory(), "point=0")["points"][0],
            all["points"][0]);
  const Json lossy = all["points"][0], open = all["points"][1];
  EXPECT_EQ(lossy["verdict"], "converged-with-losses");
  EXPECT_EQ(lossy["stop_tests"].size(), 1U);
  EXPECT_EQ(lossy["stop_tests"][0]["seeds"], 6);
  EXPECT_EQ(lossy["losses"], Json({{"crashed", {5}}, {"overlap", {4}}}));
  EXPECT_EQ(lossy["blamed_attempts"], Json::array({{{"seed", 5},
                                                    {"outcome", "crashed"},
                                                    {"step", 42},
                                                    {"message", "signal 11 (Segmentation fault)"}}}));
  EXPECT_TRUE(open["verdict"].is_null());
  EXPECT_EQ(open["reason"], "0 of the 6 seeds of the next stop test have ended, 0 run");
  EXPECT_EQ(open["next"], "the first stop test, at 6 seeds");
}

TEST(Explain, ACappedPointIsToldHowManySeedsItWouldTake) {
  StoredCampaign campaign(1, 4, 4);
  const double values[] = {9, 10, 11, 10};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, values[seed]);
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  // The half-width 3.182 * 0.408 = 1.299 around 10 + 0.25 needs 4 * (0.1267 / 0.05)^2 = 25.7 seeds.
  EXPECT_TRUE(says(text,
                   "all 4 seeds that are allowed give a half-width of 13 %, not within the tolerance "
                   "of 5 %"))
      << text;
  EXPECT_TRUE(says(text, "/realisations/maximum (about 26 seeds)")) << text;
}

// The pressure is twice the viscosity and has no control variate: 20 +- 3.1824 * 0.8165 = 2.5985, which needs
// 4 * 2.5985^2 = 27.01 seeds.
TEST(Explain, OfSeveralTargetsEachIsToldWithItsTolerance) {
  StoredCampaign campaign(1, 4, 4, {{"pressure", Tolerance::absolute(1)}});
  const double values[] = {9, 10, 11, 10};
  for (int seed = 0; seed < 4; ++seed) campaign.complete(0, seed, values[seed]);
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text,
                   "all 4 seeds that are allowed give half-widths of 13 % for relative_viscosity, 2.6 for "
                   "pressure, not within the tolerance of 5 % for relative_viscosity, 1 for pressure"))
      << text;
  EXPECT_TRUE(says(text, "/realisations/maximum (about 28 seeds) or /target/also/0/absolute_tolerance"))
      << text;
  EXPECT_TRUE(says(text, "20.0 ± 2.6")) << text;
  EXPECT_TRUE(says(text, "the results have no blocks of pressure:")) << text;
  const std::string table = status_table(read_status(campaign.database(), 0));
  EXPECT_TRUE(says(table, "relative_viscosity to 5 %, pressure to 1 at 95 % confidence")) << table;
  EXPECT_TRUE(says(table, "pressure 2.6 x")) << table;
  const Json stop_test =
      explain_json(campaign.database(), campaign.directory(), "")["points"][0]["stop_tests"][0];
  EXPECT_EQ(stop_test["verdict"], "capped");
  ASSERT_EQ(stop_test["observables"].size(), 2U);
  EXPECT_EQ(stop_test["observables"][1]["observable"], "pressure");
  EXPECT_EQ(stop_test["observables"][1]["verdict"], "capped");
  EXPECT_NEAR(stop_test["observables"][1]["share_of_tolerance"].get<double>(), 2.598, 1e-3);
  EXPECT_EQ(
      status_json(read_status(campaign.database()))["target"],
      Json::parse(R"({"observable": "relative_viscosity", "relative_tolerance": 0.05, "confidence": 0.95,
                            "also": [{"observable": "pressure", "absolute_tolerance": 1.0}]})"));
  EXPECT_NO_THROW(export_json(campaign.database(), true));
}

TEST(Explain, WhereOneOfSeveralTargetsMayBeZeroItsToleranceIsToBecomeAbsolute) {
  StoredCampaign campaign(1, 8, 8, {{"N1", 0.05}});
  for (int seed = 0; seed < 8; ++seed) {
    campaign.complete_with(0, seed, 10 + 0.001 * seed,
                           [&](Json& result) { result["mean"]["N1"] = seed % 2 == 0 ? 1 : -1; });
  }
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text, "/target/also/0/absolute_tolerance, or another /target/also/0/observable")) << text;
}

// The values are +- 10 around 0.25. A number of seeds for a share of such a mean would be accidental.
TEST(Explain, AMeanThatMayBeZeroIsNotAdvisedToTakeMillionsOfSeeds) {
  StoredCampaign campaign(1, 8, 8), open(1, 8, 20);
  for (int seed = 0; seed < 8; ++seed) {
    campaign.complete(0, seed, seed % 2 == 0 ? -10 : 10);
    open.complete(0, seed, seed % 2 == 0 ? -10 : 10);
  }
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text,
                   "while the interval contains zero, no number of seeds can meet a "
                   "/target/relative_tolerance"))
      << text;
  EXPECT_FALSE(says(text, "/realisations/maximum")) << text;
  const std::string ahead = explain(open.database(), open.directory(), "");
  EXPECT_TRUE(says(ahead, "cannot be predicted while the interval contains zero")) << ahead;
}

TEST(Explain, AWindowThatBeginsTooEarlyIsATransient) {
  StoredCampaign campaign(2, 8, 20);
  for (int seed = 0; seed < 8; ++seed) {
    const double scatter = seed % 2 == 0 ? 0.01 : -0.01;
    campaign.complete_in_halves(0, seed, 10.2 + scatter, 10 - 2 * scatter);
    campaign.complete_in_halves(1, seed, 10 + scatter, 10 - 2 * scatter);
  }
  const std::string drifting = explain(campaign.database(), campaign.directory(), "point=0");
  EXPECT_TRUE(says(drifting, "converged, transient")) << drifting;
  EXPECT_TRUE(says(drifting, "the first half by 0.1000 ± 0.0057"))
      << drifting;  // 0.1 +- 1.5 * 0.01 / sqrt(7)
  EXPECT_TRUE(says(drifting, "next: set a longer /scene/duration/equilibration")) << drifting;
  const std::string steady = explain(campaign.database(), campaign.directory(), "point=1");
  EXPECT_FALSE(says(steady, "transient")) << steady;
  EXPECT_TRUE(status_json(read_status(campaign.database()))["points"][0]["stop_test"]["transient"]);
}

// Without blocks the verdict stands, and the explanation says that transients could not be tested.
TEST(Explain, WithoutBlocksNoTransientTestIsSaidNotToHaveBeenPossible) {
  StoredCampaign campaign(1, 4, 20);
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete_with(0, seed, 10 + 0.1 * (seed % 2),
                           [](Json& result) { result["blocks"] = Json::object(); });
  }
  const std::string text = explain(campaign.database(), campaign.directory(), "point=0");
  EXPECT_TRUE(says(text, "converged, no-transient-test")) << text;
  EXPECT_TRUE(says(text, "no test was possible, because the results have no blocks of relative_viscosity"))
      << text;
  EXPECT_TRUE(status_json(read_status(campaign.database()))["points"][0]["stop_test"]["transient"].is_null());
  EXPECT_TRUE(
      parse_json(export_json(campaign.database(), true), "export")["points"][0]["stop_test"]["transient"]
          .is_null());
}

TEST(Explain, AnEstimateHasABootstrapIntervalAndAdviceOnItsWindow) {
  StoredCampaign campaign(1, 16, 20);
  for (int seed = 0; seed < 16; ++seed) {  // uncorrelated halves
    campaign.complete_in_halves(0, seed, 10 + (seed % 2 == 0 ? 0.1 : -0.1), 10 + (seed % 4 < 2 ? 0.1 : -0.1));
  }
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text, "bootstrap-t ")) << text;
  // plain_result() has 20 steps of equilibration and 80 of production: (20 + 40) / 100 * 2 and (20 + 160) /
  // 100 / 2.
  EXPECT_TRUE(says(text, "its halves correlate by 0.00")) << text;
  EXPECT_TRUE(says(text, "half the window takes 1.20 times the processor time, twice the window 0.90\n"))
      << text;
}

TEST(Explain, AFewSeedsFarFromTheRestAreCalledSkewed) {
  StoredCampaign campaign(1, 8, 8);
  for (int seed = 0; seed < 8; ++seed) campaign.complete_in_halves(0, seed, 10, seed == 5 ? 11 : 10);
  const std::string text = explain(campaign.database(), campaign.directory(), "");
  EXPECT_TRUE(says(text, "converged, skewed")) << text;
  EXPECT_TRUE(says(text, "trust the bootstrap interval more")) << text;
}

TEST(Explain, TheStopTestWithoutTheControlVariateIsShownOnlyWhereThereIsOne) {
  StoredCampaign campaign(2, 4, 20);
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete(0, seed, 10 + 0.01 * seed);
    campaign.complete_in_halves(1, seed, 10 + 0.01 * seed, 10 + 0.01 * seed);
  }
  EXPECT_TRUE(says(explain(campaign.database(), campaign.directory(), "point=0"), "without control variate"));
  EXPECT_FALSE(
      says(explain(campaign.database(), campaign.directory(), "point=1"), "without control variate"));
}

TEST(Explain, AnOpenPointSaysWhatItWaitsFor) {
  StoredCampaign campaign(2, 4, 20);
  campaign.complete(1, 0, 10);
  const std::string text = explain(campaign.database(), campaign.directory(), "point=1");
  EXPECT_TRUE(says(text, "1 of the 4 seeds of the next stop test have ended, 0 run")) << text;
  EXPECT_TRUE(says(text, "no stop test yet")) << text;
  EXPECT_FALSE(says(text, "point=0")) << text;
}

TEST(Explain, APointIsNamedByItsLabelOrTheBeginningOfItsHash) {
  StoredCampaign campaign(2, 4, 20);
  const std::string hash = campaign.database().points()[1].hash;
  EXPECT_TRUE(explain(campaign.database(), campaign.directory(), hash.substr(0, 4)).starts_with("point=1"));
  for (const char* const name : {"point=2", "zzzz", "p"}) {
    EXPECT_THROW(explain(campaign.database(), campaign.directory(), name), InputError) << name;
  }
  EXPECT_THROW(explain(campaign.database(), campaign.directory(), hash.substr(0, 3)), InputError);
}

TEST(Explain, APointIsNamedByItsValuesAloneAsInTheRowOfATable) {
  StoredCampaign campaign(3, 4, 20);
  const auto name = [&](int place, const std::string& label) {
    campaign.database().connection().execute("UPDATE point SET label = '" + label +
                                             "' WHERE place = " + std::to_string(place));
  };
  name(0, "peclet=1 volume_fraction=0.5");
  name(1, "peclet=10 volume_fraction=0.5");
  name(2, "peclet=10");
  EXPECT_TRUE(explain(campaign.database(), campaign.directory(), "10 0.5")
                  .starts_with("peclet=10 volume_fraction=0.5"));
  EXPECT_TRUE(explain(campaign.database(), campaign.directory(), "10").starts_with("peclet=10  ("));
  for (const char* const text : {"0.5", "10 0", "10  0.5", "volume_fraction=0.5"}) {
    EXPECT_THROW(explain(campaign.database(), campaign.directory(), text), InputError) << text;
  }
  name(2, "rate=1 volume_fraction=0.5");
  EXPECT_THROW(explain(campaign.database(), campaign.directory(), "1 0.5"), InputError)
      << "two points have these";
}

}  // namespace
}  // namespace peclet::runner
