// Charts: where numbers lie, which variable they are drawn over, and text that comes from users.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "runner/reports/report_chart.h"
#include "runner/text/chart_axis.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

using Scale = ChartAxis::Scale;

TEST(ChartAxis, IsLogarithmicWhereNumbersLieMoreEvenlyThen) {
  EXPECT_EQ(fitting_scale({2.2, 2.9, 4.1, 7.0, 21}), Scale::logarithmic);  // a viscosity towards jamming
  EXPECT_EQ(fitting_scale({1000, 1, 10, 100}), Scale::logarithmic);
  EXPECT_EQ(fitting_scale({0.1, 0.2, 0.3, 0.4, 0.5, 0.6}), Scale::linear);
  EXPECT_EQ(fitting_scale({0.01, 1, 2, 3, 4}), Scale::linear);
  EXPECT_EQ(fitting_scale({5.7, 7.2, 7.8}), Scale::linear);  // less than a factor of five
}

TEST(ChartAxis, IsLinearWhereThereAreNoLogarithms) {
  EXPECT_EQ(fitting_scale({0, 1, 10, 100, 1000}), Scale::linear);
  EXPECT_EQ(fitting_scale({-1, 1, 10, 100, 1000}), Scale::linear);
  EXPECT_EQ(fitting_scale({3}), Scale::linear);
  EXPECT_EQ(fitting_scale({}), Scale::linear);
}

TEST(ChartAxis, LeavesTheSameMarginOnBothSides) {
  for (const auto& [low, high, scale] :
       {std::tuple{2.0, 6.0, Scale::linear}, std::tuple{0.1, 1000.0, Scale::logarithmic}}) {
    const ChartAxis axis(scale, low, high, 100, 700);
    EXPECT_GT(axis.place(low), 100);
    EXPECT_NEAR(axis.place(low) - 100, 700 - axis.place(high), 1e-9);
  }
}

TEST(ChartAxis, EqualDifferencesOrRatiosAreEquallyLong) {
  const ChartAxis linear(Scale::linear, 2, 6, 400, 0), logarithmic(Scale::logarithmic, 0.1, 1000, 0, 400);
  EXPECT_NEAR(linear.place(3) - linear.place(2), linear.place(6) - linear.place(5), 1e-9);
  EXPECT_LT(linear.place(6), linear.place(2));  // drawn upwards
  EXPECT_NEAR(logarithmic.place(1) - logarithmic.place(0.1), logarithmic.place(1000) - logarithmic.place(100),
              1e-9);
}

// With five at most, as a telephone shows them, some ranges have two only.
TEST(ChartAxis, HasAFewTicksWithinItselfWhateverItsRange) {
  for (const double low : {1e-9, 0.1, 0.3, 1.0, 7.7, 9.99, 1e6}) {
    for (const double ratio :
         {1.0, 1.0001, 1.5, 3.0, 5.0, 9.5, 19.0, 21.0, 60.0, 1e3, 1e5, 1e9, 1e12, 1e15}) {
      for (const Scale scale : {Scale::linear, Scale::logarithmic}) {
        if (scale == Scale::logarithmic && ratio < 5) continue;
        for (const std::size_t most : {9U, 5U}) {
          const ChartAxis axis(scale, low, ratio * low, 0, 100, most);
          const std::vector<ChartAxis::Tick> ticks = axis.ticks();
          EXPECT_GE(ticks.size(), most == 9 ? 3U : 2U) << low << " x " << ratio;
          EXPECT_LE(ticks.size(), most) << low << " x " << ratio;
          for (const ChartAxis::Tick& tick : ticks) {
            EXPECT_GE(axis.place(tick.value), 0);
            EXPECT_LE(axis.place(tick.value), 100);
          }
        }
      }
    }
  }
}

TEST(ChartAxis, TicksAreRoundNumbers) {
  const auto texts = [](Scale scale, double low, double high) {
    std::string all;
    for (const ChartAxis::Tick& tick : ChartAxis(scale, low, high, 0, 1).ticks()) all += tick.text + ' ';
    return all;
  };
  EXPECT_EQ(texts(Scale::linear, 0, 1), "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(texts(Scale::linear, -1, 1), "-1 -0.5 0 0.5 1 ");
  EXPECT_EQ(texts(Scale::linear, 2e6, 4e6), "2·10⁶ 2.5·10⁶ 3·10⁶ 3.5·10⁶ 4·10⁶ ");
  EXPECT_EQ(texts(Scale::logarithmic, 0.1, 10000), "0.1 1 10 100 1000 10000 ");
  EXPECT_EQ(texts(Scale::logarithmic, 1e-5, 1e6), "10⁻⁴ 0.01 1 100 10000 10⁶ ");
  EXPECT_EQ(texts(Scale::logarithmic, 2.2, 21), "2 5 10 20 ");
  EXPECT_EQ(texts(Scale::logarithmic, 12, 60), "20 30 40 50 60 ");
}

PointSummary point(const std::string& label, double mean, double half_width, Verdict verdict) {
  PointSummary summary;
  summary.point.label = label;
  Look look;
  look.controlled = {8, mean, half_width / 2};
  look.controlled_half_width = half_width;
  look.verdict = verdict;
  summary.looks = {look};
  return summary;
}

PointSummary converged(const std::string& label) { return point(label, 10, 1, Verdict::converged); }

TEST(ReportChart, IsDrawnOverTheNumberWithMostValuesInTheirOrder) {
  const ReportChart report =
      report_chart({converged("phi=0.4 pe=100"), converged("phi=0.4 pe=1"), converged("phi=0.4 pe=10"),
                    converged("phi=0.5 pe=100"), converged("phi=0.5 pe=1"), converged("phi=0.5 pe=10")},
                   "viscosity");
  ASSERT_TRUE(report.chart);
  EXPECT_EQ(report.chart->x_title, "pe");
  EXPECT_EQ(report.chart->y_title, "viscosity");
  ASSERT_EQ(report.chart->series.size(), 2U);
  EXPECT_EQ(report.chart->series[1].name, "phi = 0.5");
  for (const ChartSeries& series : report.chart->series) {
    ASSERT_EQ(series.points.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(series.points[i].x, std::pow(10, i));
  }
}

TEST(ReportChart, WhatIsSetInStepWithTheVariableMakesNoSeries) {
  const ReportChart report =
      report_chart({converged("phi=0.4 count=500"), converged("phi=0.5 count=1000")}, "viscosity");
  ASSERT_TRUE(report.chart);
  ASSERT_EQ(report.chart->series.size(), 1U);
  EXPECT_EQ(report.chart->x_title, "phi");
}

TEST(ReportChart, MarksAreFullOnlyForConvergedPointsAndBarsAreTheInterval) {
  const ReportChart report = report_chart(
      {point("pe=1", 10, 1, Verdict::converged), point("pe=2", 11, 2, Verdict::converged_with_losses),
       point("pe=3", 12, 3, Verdict::capped), point("pe=4", 13, 4, Verdict::more)},
      "viscosity");
  ASSERT_TRUE(report.chart);
  const std::vector<ChartPoint>& points = report.chart->series.at(0).points;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(points[i].kind, i < 2 ? ChartPoint::Kind::decided : ChartPoint::Kind::undecided);
    EXPECT_EQ(points[i].y, 10.0 + static_cast<double>(i));
    EXPECT_EQ(points[i].error, 1.0 + static_cast<double>(i));
  }
}

TEST(ReportChart, BeforeTheFirstLookThereIsTheMeanSoFar) {
  PointSummary young = converged("pe=2"), single = converged("pe=3");
  young.looks.clear();
  young.so_far = {3, 11.5, 0.25};
  single.looks.clear();
  single.so_far = {1, 11.5, NAN};
  const ReportChart report = report_chart({converged("pe=1"), young, single}, "viscosity");
  ASSERT_TRUE(report.chart);
  const std::vector<ChartPoint>& points = report.chart->series.at(0).points;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1].kind, ChartPoint::Kind::provisional);
  EXPECT_EQ(points[1].y, 11.5);
  EXPECT_EQ(points[1].error, 0.25);
  EXPECT_EQ(report.note, "1 point without an error is not drawn.");
}

TEST(ReportChart, SaysWhyItIsNotThereAndWhatItLeavesOut) {
  EXPECT_FALSE(report_chart({converged("only")}, "viscosity").chart);
  const ReportChart words = report_chart({converged("form=a"), converged("form=b")}, "viscosity");
  EXPECT_FALSE(words.chart);
  EXPECT_NE(words.note.find("no swept variable is a number"), std::string::npos);

  PointSummary unseen = converged("pe=2");
  unseen.looks.clear();
  const ReportChart gap =
      report_chart({converged("pe=1"), unseen, point("pe=3", NAN, NAN, Verdict::failed)}, "viscosity");
  ASSERT_TRUE(gap.chart);
  EXPECT_EQ(gap.chart->series.at(0).points.size(), 1U);
  EXPECT_EQ(gap.note, "2 points without an error are not drawn.");

  std::vector<PointSummary> many;
  for (int form = 0; form < 9; ++form) {
    many.push_back(converged("pe=1 form=f" + std::to_string(form)));
    many.push_back(converged("pe=2 form=f" + std::to_string(form)));
  }
  EXPECT_EQ(report_chart(many, "viscosity").note, "There is no chart, because it would need 9 curves.");
}

TEST(SvgChart, TheNarrowFormIsDrawnForTheSizeThatItHasThere) {
  const Chart chart{"x", "y", {{"", {{1, 2, 0.5, ChartPoint::Kind::decided, ""}, {2, 3, 0.5, {}, ""}}}}};
  // A telephone of 390 pixels leaves the page some 358 of them: text of 13 px stays as large as it is.
  EXPECT_NE(svg(chart, ChartForm::narrow).find("viewBox=\"0 0 360 300\""), std::string::npos);
  EXPECT_NE(svg(chart).find("viewBox=\"0 0 720 400\""), std::string::npos);
}

TEST(SvgChart, NamesOfUsersAreEscaped) {
  const Chart chart{"<x>", "\"y\"", {{"a & b", {{1, 2, 0.5, ChartPoint::Kind::decided, "<t>"}}}}};
  const std::string text = svg(chart);
  EXPECT_NE(text.find("<title>&lt;t&gt;</title>"), std::string::npos);
  EXPECT_NE(text.find("&lt;x&gt;"), std::string::npos);
  EXPECT_NE(text.find("&quot;y&quot;"), std::string::npos);
  EXPECT_EQ(text.find("<x>"), std::string::npos);
  EXPECT_EQ(text.find("<t>"), std::string::npos);
}

TEST(Html, EveryCharacterThatMeansSomethingIsEscaped) {
  EXPECT_EQ(escaped("<a href='x' id=\"y\">&amp;"), "&lt;a href=&#39;x&#39; id=&quot;y&quot;&gt;&amp;amp;");
  EXPECT_EQ(escaped("φ ± 1\n\t"), "φ ± 1\n\t");
  EXPECT_EQ(escaped(std::string("a\0b\x1b\x7f", 5)), "a\uFFFDb\uFFFD\uFFFD");
}

}  // namespace
}  // namespace peclet::runner
