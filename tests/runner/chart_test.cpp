// Charts: where numbers lie, which variable they are drawn over, and text that comes from users.
#include <gtest/gtest.h>

#include <cmath>

#include "runner/chart_axis.h"
#include "runner/html.h"
#include "runner/report_chart.h"

namespace peclet::runner {
namespace {

TEST(ChartAxis, IsLogarithmicBeyondAFactorOfTwentyOfPositiveNumbers) {
  EXPECT_FALSE(ChartAxis(1, 20, 0, 100).is_logarithmic());
  EXPECT_TRUE(ChartAxis(1, 20.1, 0, 100).is_logarithmic());
  EXPECT_FALSE(ChartAxis(0, 1000, 0, 100).is_logarithmic());
  EXPECT_FALSE(ChartAxis(-1, 1000, 0, 100).is_logarithmic());
}

TEST(ChartAxis, LeavesTheSameMarginOnBothSides) {
  for (const auto& [low, high] : {std::pair{2.0, 6.0}, std::pair{0.1, 1000.0}}) {
    const ChartAxis axis(low, high, 100, 700);
    EXPECT_GT(axis.place(low), 100);
    EXPECT_NEAR(axis.place(low) - 100, 700 - axis.place(high), 1e-9);
  }
}

TEST(ChartAxis, EqualDifferencesOrRatiosAreEquallyLong) {
  const ChartAxis linear(2, 6, 400, 0), logarithmic(0.1, 1000, 0, 400);
  EXPECT_NEAR(linear.place(3) - linear.place(2), linear.place(6) - linear.place(5), 1e-9);
  EXPECT_LT(linear.place(6), linear.place(2));  // drawn upwards
  EXPECT_NEAR(logarithmic.place(1) - logarithmic.place(0.1), logarithmic.place(1000) - logarithmic.place(100),
              1e-9);
}

TEST(ChartAxis, HasThreeToNineTicksWithinItselfWhateverItsRange) {
  for (const double low : {1e-9, 0.1, 0.3, 1.0, 7.7, 9.99, 1e6}) {
    for (const double ratio : {1.0, 1.0001, 1.5, 3.0, 19.0, 21.0, 60.0, 1e3, 1e5, 1e9, 1e12, 1e15}) {
      const ChartAxis axis(low, ratio * low, 0, 100);
      const std::vector<ChartAxis::Tick> ticks = axis.ticks();
      EXPECT_GE(ticks.size(), 3U) << low << " x " << ratio;
      EXPECT_LE(ticks.size(), 9U) << low << " x " << ratio;
      for (const ChartAxis::Tick& tick : ticks) {
        EXPECT_GE(axis.place(tick.value), 0);
        EXPECT_LE(axis.place(tick.value), 100);
      }
    }
  }
}

TEST(ChartAxis, TicksAreRoundNumbers) {
  const auto texts = [](const ChartAxis& axis) {
    std::string all;
    for (const ChartAxis::Tick& tick : axis.ticks()) all += tick.text + ' ';
    return all;
  };
  EXPECT_EQ(texts(ChartAxis(0, 1, 0, 1)), "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(texts(ChartAxis(-1, 1, 0, 1)), "-1 -0.5 0 0.5 1 ");
  EXPECT_EQ(texts(ChartAxis(0.1, 10000, 0, 1)), "0.1 1 10 100 1000 10000 ");
  EXPECT_EQ(texts(ChartAxis(1e-5, 1e6, 0, 1)), "10⁻⁴ 0.01 1 100 10000 10⁶ ");
  EXPECT_EQ(texts(ChartAxis(2e6, 4e6, 0, 1)), "2·10⁶ 2.5·10⁶ 3·10⁶ 3.5·10⁶ 4·10⁶ ");
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
    EXPECT_EQ(points[i].solid, i < 2);
    EXPECT_EQ(points[i].y, 10.0 + static_cast<double>(i));
    EXPECT_EQ(points[i].error, 1.0 + static_cast<double>(i));
  }
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
  EXPECT_EQ(gap.note, "2 points without an interval are not drawn.");

  std::vector<PointSummary> many;
  for (int form = 0; form < 9; ++form) {
    many.push_back(converged("pe=1 form=f" + std::to_string(form)));
    many.push_back(converged("pe=2 form=f" + std::to_string(form)));
  }
  EXPECT_EQ(report_chart(many, "viscosity").note, "There is no chart, because it would need 9 curves.");
}

TEST(SvgChart, NamesOfUsersAreEscaped) {
  const Chart chart{"<x>", "\"y\"", {{"a & b", {{1, 2, 0.5, true, "<t>"}}}}};
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
