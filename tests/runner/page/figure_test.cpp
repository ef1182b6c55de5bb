// Figures of a campaign: their numbers and their scripts. tests/python/drawing_test.py tests the drawing.
#include "runner/page/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "contract/errors.h"
#include "runner/page/swept.h"
#include "tests/contract/refusal.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

// Returns the raw string behind the mark in a script, as Python reads it.
std::string raw_string(const std::string& script) {
  const std::string mark = "FIGURE = json.loads(r\"\"\"";
  const std::size_t begin = script.find(mark) + mark.size();
  std::size_t end = begin;
  while (script.compare(end, 3, "\"\"\"") != 0) end += script[end] == '\\' ? 2 : 1;
  return script.substr(begin, end - begin);
}

class CampaignFigure : public testing::Test {
 protected:
  // 10.05 ± 0.41 with a control of 0.25, far from the tolerance of 5 %: capped.
  void complete_widely(int point) {
    const double values[] = {9.05, 10.05, 11.05, 10.05};
    for (int seed = 0; seed < 4; ++seed) campaign_.complete(point, seed, values[seed]);
  }
  Json figure(const FigureChoice& choice = {}) { return figure_data(campaign_.database(), choice); }
  std::string refusal(const FigureChoice& choice) {
    return refusal_by([&] { figure(choice); });
  }

  StoredCampaign campaign_{3, 4, 4};
};

TEST_F(CampaignFigure, HasTheEstimateThatDecides) {
  complete_widely(0);
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(1, seed, 20 + 0.01 * seed);
  campaign_.complete(2, 0, 29.75);
  const Json drawn = figure();
  ASSERT_EQ(drawn["points"].size(), 3U);
  EXPECT_EQ(drawn["over"], "/point");
  EXPECT_EQ(drawn["quantities"][0]["path"], "relative_viscosity");
  const Json& capped = drawn["points"][0];
  EXPECT_EQ(capped["settings"]["/point"], 0);
  EXPECT_NEAR(capped["mean"].get<double>(), 10.3, 1e-12);
  EXPECT_NEAR(capped["half_width"].get<double>(), 3.18244630528 * std::sqrt(2.0 / 3) / 2,
              1e-9);  // Student's t, 3 degrees
  EXPECT_NEAR(capped["good_enough"].get<double>(), 0.05 * 10.3, 1e-12);
  EXPECT_EQ(capped["count"], 4);
  EXPECT_EQ(capped["state"], "undecided");
  EXPECT_EQ(drawn["points"][1]["state"], "converged");
  EXPECT_EQ(drawn["points"][2]["state"], "provisional");
  EXPECT_EQ(drawn["points"][2]["mean"], 30);
  EXPECT_TRUE(drawn["points"][2]["half_width"].is_null());
}

TEST_F(CampaignFigure, HasAnyQuantityThatIsMeasured) {
  complete_widely(0);
  const Json drawn = figure({.quantities = {"/pressure"}, .over = "point"});
  EXPECT_EQ(drawn["quantities"][0]["path"], "pressure");
  EXPECT_NEAR(drawn["points"][0]["mean"].get<double>(), 20.1, 1e-12);
  EXPECT_TRUE(drawn["points"][1]["mean"].is_null());
}

// The point without a result has no place on the axis.
TEST_F(CampaignFigure, OverAMeasuredNumberHasItsMeanAndInterval) {
  complete_widely(0);
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(1, seed, 20 + 0.01 * seed);
  const Json pressures = figure({.quantities = {"pressure"}})["points"];
  const Json drawn = figure({.over = "pressure"}), halved = figure({.over = "/pressure", .scale_x = "2"});
  EXPECT_EQ(drawn["over"], "pressure");
  EXPECT_EQ(drawn["along"], "/point");
  EXPECT_EQ(drawn["absent"], 1);
  ASSERT_EQ(drawn["points"].size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const Json &point = drawn["points"][k], &half = halved["points"][k];
    EXPECT_EQ(point["quantity"], "relative_viscosity");
    EXPECT_EQ(point["settings"]["pressure"], pressures[k]["mean"]);
    EXPECT_EQ(point["x_half_width"], pressures[k]["half_width"]);
    EXPECT_EQ(half["settings"]["pressure"].get<double>(), pressures[k]["mean"].get<double>() / 2);
    EXPECT_EQ(half["x_half_width"].get<double>(), pressures[k]["half_width"].get<double>() / 2);
  }
  EXPECT_FALSE(figure({.quantities = {"pressure"}}).contains("along"));
}

TEST_F(CampaignFigure, OfTwoCampaignsHasThePointsOfBothWithTheirNames) {
  StoredCampaign other(2, 4, 4);
  complete_widely(0);
  for (int seed = 0; seed < 4; ++seed) other.complete(1, seed, 20 + 0.01 * seed);
  const auto both = [&](const FigureChoice& choice) {
    return figure_data_of_several({{campaign_.database(), "rough"}, {other.database(), "smooth"}}, choice);
  };
  const Json drawn = both({});
  ASSERT_EQ(drawn["points"].size(), 5U);
  EXPECT_EQ(drawn["over"], "/point");
  EXPECT_EQ(drawn["parameters"][0]["pointer"], "campaign");
  EXPECT_EQ(drawn["points"][0]["settings"], (Json{{"/point", 0}, {"campaign", "rough"}}));
  EXPECT_EQ(drawn["points"][4]["settings"], (Json{{"/point", 1}, {"campaign", "smooth"}}));
  EXPECT_EQ(drawn["points"][4]["state"], "converged");
  EXPECT_EQ(refusal_by([&] { both({.where = {"peclet=1"}}); }).find("campaign rough: --where: peclet"), 0U);
}

TEST_F(CampaignFigure, RefusesWhatIsNotThere) {
  EXPECT_EQ(refusal({}), "--quantity: relative_viscosity: nothing has been measured yet");
  complete_widely(0);
  EXPECT_EQ(refusal({.quantities = {"presure"}}),
            "--quantity: presure: must be a measured quantity; did you mean pressure?");
  EXPECT_EQ(refusal({.over = "peclet"}), "--over: peclet: must be the name of one swept parameter: /point");
  EXPECT_EQ(refusal({.quantities = {"pressure"}, .tolerance = true}),
            "--band: pressure: has no tolerance: it is not a target of the campaign");
}

// Points at x = 0, 1 and 2, of which the second one has jammed.
TEST_F(CampaignFigure, HasNoNumberOfThoseThatHappenedToFlowWhereThePointHasJammed) {
  complete_widely(0);
  for (int seed = 0; seed < 3; ++seed) campaign_.blow_up(1, seed, "overlap");
  campaign_.complete(1, 3, 11);
  complete_widely(2);
  const Json point = figure()["points"][1];
  EXPECT_EQ(point["jammed"], true);
  EXPECT_TRUE(point["mean"].is_null());
  EXPECT_EQ(point["count"], 4);
}

// A rate of 0 is a number of a point that has jammed.
TEST_F(CampaignFigure, HasTheNumberOfAJamThatAllSeedsHave) {
  complete_widely(0);
  const auto stand_still = [](Json& result) { result["ending"]["cause"] = "jammed"; };
  for (int seed = 0; seed < 4; ++seed)
    campaign_.complete_with(1, seed, -0.25, stand_still);  // with its control 0
  EXPECT_EQ(figure()["points"][1]["mean"], 0);
  EXPECT_EQ(figure()["points"][1]["jammed"], true);
}

TEST_F(CampaignFigure, IsRefusedWhereALogarithmicAxisHasAPlaceForNoNumber) {
  complete_widely(0);  // at x = 0
  EXPECT_EQ(refusal({.log = "x"}),
            "--quantity: relative_viscosity: has no number that a logarithmic axis can show");
  complete_widely(1);
  EXPECT_EQ(refusal({.log = "x"}), "");
}

TEST_F(CampaignFigure, ObeysNothingThatANameSays) {
  complete_widely(0);
  Connection& tables = campaign_.database().connection();
  Statement(tables, "UPDATE campaign SET name = '</svg><script>1</script>\"\"\"'").step();
  Statement(tables, "UPDATE point SET label = '\"\"\"+exit(1)+r\"\"\"\\' || place").step();
  const Json data = Json::parse(raw_string(figure_script(figure())));
  EXPECT_EQ(data["campaign"], "</svg><script>1</script>\"\"\"");
  EXPECT_EQ(data["points"][0]["label"], "\"\"\"+exit(1)+r\"\"\"\\0");
}

TEST_F(CampaignFigure, HasAScriptThatKnowsWhetherItWasChanged) {
  complete_widely(0);
  std::string script = figure_script(figure());
  EXPECT_EQ(script, figure_script(figure()));
  EXPECT_TRUE(is_own_script(script));
  script.insert(script.find("import"), "# mine\n");
  EXPECT_FALSE(is_own_script(script));
  EXPECT_FALSE(is_own_script(""));
  EXPECT_FALSE(is_own_script("print('mine')\n"));
}

TEST(FigurePicture, HasItsFormFromItsName) {
  EXPECT_EQ(picture_form("a.svg"), PictureForm::svg);
  EXPECT_EQ(picture_form("b.c/a.png"), PictureForm::png);
  EXPECT_EQ(picture_form("a.b.pdf"), PictureForm::pdf);
  EXPECT_EQ(picture_form("a.py"), PictureForm::script);
  for (const char* const name : {"a.jpg", "a", "svg", "a.svg.gz", ".svg"}) {
    EXPECT_THROW(picture_form(name), InputError) << name;
  }
}

TEST(FigurePicture, TakesNoScriptOfAnothersAway) {
  const TemporaryFolder folder;
  const std::filesystem::path picture = folder.path() / "curve.svg";
  EXPECT_EQ(script_beside(picture), folder.path() / "curve.py");
  std::ofstream(folder.path() / "curve.py") << "print('mine')\n";
  EXPECT_THROW(script_beside(picture), InputError);
}

// The elements of a list over k = 1, 2: the target measure/k_core/1 is that of k = 2.
TEST(ChosenColumn, IsThatOfThePathBeforeThatOfAnAxisValue) {
  const std::vector<Drawable> list{
      {.path = "k_core/0", .name = "k_core", .element = "1", .symbol = "", .unit = "1"},
      {.path = "k_core/1", .name = "k_core", .element = "2", .symbol = "", .unit = "1"}};
  EXPECT_EQ(chosen_column(list, "k_core/0"), 0u);
  EXPECT_EQ(chosen_column(list, "k_core/1"), 1u);
  EXPECT_EQ(chosen_column(list, "k_core/2"), 1u);
}

}  // namespace
}  // namespace peclet::runner
