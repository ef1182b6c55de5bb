// Figures of a campaign: which numbers, which axes, and the picture and the script that are made of them.
#include "runner/figure/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>

#include "contract/input_error.h"
#include "runner/figure/figure_script.h"
#include "runner/figure/picture.h"
#include "runner/figure/svg_figure.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// The string between r""" and """ that a reader of Python takes from a script.
std::string raw_string(const std::string& script) {
  const std::size_t begin = script.find("r\"\"\"") + 4;
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
  Figure figure(const FigureChoice& choice = {}) { return make_figure(campaign_.database(), choice); }
  std::string refusal(const FigureChoice& choice) {
    try {
      figure(choice);
    } catch (const InputError& fault) {
      return fault.what();
    }
    return "";
  }

  StoredCampaign campaign_{3, 4, 4};
};

TEST_F(CampaignFigure, HasTheEstimateThatDecides) {
  complete_widely(0);
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(1, seed, 20 + 0.01 * seed);
  campaign_.complete(2, 0, 29.75);
  const Figure drawn = figure();
  ASSERT_EQ(drawn.curves.size(), 1U);
  ASSERT_EQ(drawn.curves[0].marks.size(), 3U);
  const Mark& capped = drawn.curves[0].marks[0];
  EXPECT_EQ(capped.x, 0);
  EXPECT_NEAR(capped.mean, 10.3, 1e-12);
  EXPECT_NEAR(capped.half_width, 3.18244630528 * std::sqrt(2.0 / 3) / 2, 1e-9);  // Student's t, 3 degrees
  EXPECT_NEAR(*capped.good_enough, 0.05 * 10.3, 1e-12);
  EXPECT_EQ(capped.count, 4);
  EXPECT_EQ(capped.standing, Standing::undecided);
  EXPECT_EQ(drawn.curves[0].marks[1].standing, Standing::converged);
  EXPECT_EQ(drawn.curves[0].marks[2].standing, Standing::provisional);
  EXPECT_EQ(drawn.curves[0].marks[2].mean, 30);
  EXPECT_TRUE(std::isnan(drawn.curves[0].marks[2].half_width));
}

TEST_F(CampaignFigure, DrawsAnyQuantityThatIsMeasured) {
  complete_widely(0);
  const Figure drawn = figure({.quantity = "/pressure", .over = "point", .scale = {}, .tolerance = false});
  EXPECT_EQ(drawn.quantity, "pressure");
  EXPECT_NEAR(drawn.curves[0].marks[0].mean, 20.1, 1e-12);
  EXPECT_EQ(drawn.absent, 2);
  EXPECT_EQ(left_out(drawn), "left out: 2 points without a number of pressure yet\n");
}

TEST_F(CampaignFigure, RefusesWhatIsNotThere) {
  EXPECT_EQ(refusal({}), "--quantity: relative_viscosity: nothing has been measured yet");
  complete_widely(0);
  EXPECT_EQ(refusal({.quantity = "presure", .over = {}, .scale = {}, .tolerance = false}),
            "--quantity: presure: must be a number that is measured; did you mean pressure?");
  EXPECT_EQ(refusal({.quantity = {}, .over = "peclet", .scale = {}, .tolerance = false}),
            "--over: peclet: must be what one thing is called that is swept: /point");
  EXPECT_EQ(refusal({.quantity = "pressure", .over = {}, .scale = {}, .tolerance = true}),
            "--band: pressure: has no tolerance: the campaign does not aim at it");
}

TEST_F(CampaignFigure, LeavesOutWhatALogarithmicAxisHasNoPlaceFor) {
  complete_widely(0);  // at x = 0
  complete_widely(1);
  const Figure drawn = figure({.quantity = {}, .over = {}, .scale = "x", .tolerance = false});
  EXPECT_EQ(drawn.hidden, 1);
  EXPECT_EQ(drawn.curves[0].marks.size(), 1U);
  EXPECT_TRUE(drawn.x.range.log);
  EXPECT_FALSE(drawn.y.range.log);
}

TEST_F(CampaignFigure, IsAPictureWithAMarkAndABarForEachPoint) {
  complete_widely(0);
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(1, seed, 20 + 0.01 * seed);
  const std::string svg = svg_figure(figure({.quantity = {}, .over = {}, .scale = {}, .tolerance = true}));
  EXPECT_EQ(count(svg, "class=\"mark\""), 2 + 1U);        // one of the legend: not converged
  EXPECT_EQ(count(svg, "fill=\"#ffffff\"/>\n</g>"), 1U);  // the hollow one
  EXPECT_EQ(count(svg, "class=\"bar\""), 2 * 4U);         // two halves, two caps
  EXPECT_EQ(count(svg, "class=\"band\""), 1U);
  EXPECT_TRUE(says(svg, ">tolerance</tspan>"));
  EXPECT_EQ(svg, svg_figure(figure({.quantity = {}, .over = {}, .scale = {}, .tolerance = true})));
}

// Points at x = 0, 1 and 2, of which the second one has jammed.
TEST_F(CampaignFigure, ShowsWhatHasJammedAtTheEdgeAndLeadsNoLineToIt) {
  complete_widely(0);
  for (int seed = 0; seed < 3; ++seed) campaign_.blow_up(1, seed, "overlap");
  campaign_.complete(1, 3, 11);  // one that happened to flow
  complete_widely(2);
  const Figure drawn = figure();
  const std::vector<Mark>& marks = drawn.curves.at(0).marks;
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[1].jam, Jam::above);
  EXPECT_EQ(drawn.absent, 0);
  EXPECT_TRUE(std::isnan(marks[1].mean));
  const std::string svg = svg_figure(drawn);
  EXPECT_EQ(count(svg, "class=\"jammed\""), 2 * 2U);  // two strokes, and two in the legend
  EXPECT_TRUE(says(svg, ">jammed</tspan>"));
  const std::size_t guide = svg.find("<path d=\"") + 9;
  EXPECT_EQ(count(svg.substr(guide, svg.find('"', guide) - guide), "L"), 1U);  // from the first to the third
  const Json row = Json::parse(raw_string(figure_script(drawn)))["curves"][0]["marks"][1];
  EXPECT_EQ(row.back(), "upper edge");
  EXPECT_TRUE(row[2].is_null());
}

// A rate of 0 is a number; a logarithmic axis has no place for it.
TEST_F(CampaignFigure, ShowsARateOfZeroAtTheLowerEdgeOfALogarithmicAxis) {
  complete_widely(0);
  const auto stand_still = [](Json& result) { result["ending"]["cause"] = "jammed"; };
  for (int seed = 0; seed < 4; ++seed)
    campaign_.complete_with(1, seed, -0.25, stand_still);  // with its control 0
  for (const auto& [scale, jam] : {std::pair{"none", Jam::at_number}, {"y", Jam::below}}) {
    const Figure drawn = figure({.quantity = {}, .over = {}, .scale = scale, .tolerance = false});
    EXPECT_EQ(drawn.curves.at(0).marks.at(1).jam, jam);
    EXPECT_EQ(drawn.hidden, 0);
  }
  const Figure drawn = figure({.quantity = {}, .over = {}, .scale = "y", .tolerance = false});
  EXPECT_GT(drawn.y.range.low, 1);
}

// 10.3 ± 26 and 1000 ± 0: the bar goes below zero, its mean stays.
TEST_F(CampaignFigure, HasEveryPositiveMeanWithinALogarithmicAxis) {
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10.05 + (seed % 2 == 0 ? 14 : -14));
  for (int seed = 0; seed < 4; ++seed) campaign_.complete(1, seed, 1000 + seed);
  const Figure drawn = figure({.quantity = {}, .over = {}, .scale = "y", .tolerance = false});
  EXPECT_LE(drawn.y.range.low, 10.3);
  EXPECT_GE(drawn.y.range.high, 1002);
  // Nothing is beyond the frame, from its title on the left to its lower edge.
  const std::string svg = svg_figure(drawn);
  std::smatch bar;
  for (std::string rest = svg; std::regex_search(rest, bar, std::regex("y2=\"([0-9.]+)\" class=\"bar\""));
       rest = bar.suffix()) {
    EXPECT_GE(std::stod(bar[1]), 16);
    EXPECT_LE(std::stod(bar[1]), 430 - 56);
  }
}

TEST_F(CampaignFigure, ObeysNothingThatANameSays) {
  complete_widely(0);
  Connection& tables = campaign_.database().connection();
  Statement(tables, "UPDATE campaign SET name = '</svg><script>1</script>\"\"\"'").step();
  Statement(tables, "UPDATE point SET label = '\"\"\"+exit(1)+r\"\"\"\\' || place").step();
  const Figure drawn = figure();
  EXPECT_FALSE(says(svg_figure(drawn), "<script>"));
  const Json data = Json::parse(raw_string(figure_script(drawn)));
  EXPECT_EQ(data["campaign"], "</svg><script>1</script>\"\"\"");
  EXPECT_EQ(data["curves"][0]["marks"][0][0], "\"\"\"+exit(1)+r\"\"\"\\0");
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

}  // namespace
}  // namespace peclet::runner
