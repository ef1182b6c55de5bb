// Figures of a campaign: which numbers, which axes, and the picture and the script that are made of them.
#include "runner/figure/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

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
