#include <gtest/gtest.h>

#include "runner/campaign/text_table.h"
#include "runner/reports/status.h"

namespace peclet::runner {
namespace {

CampaignStatus swept(const std::vector<std::pair<Json, double>>& points) {
  CampaignStatus status;
  status.campaign.target.target.observable = "relative_viscosity";
  for (const auto& [settings, mean] : points) {
    PointSummary point;
    point.point.settings = settings;
    point.all_seeds.mean = mean;
    status.points.push_back(point);
  }
  return status;
}

const double nan = std::nan("");

// The means 1, 2.5 and 4 are at 0, 1/2 and 1 of the seven steps between the lowest and the highest bar.
TEST(Curve, IsAsHighAsItsMeans) {
  const CampaignStatus status =
      swept({{{{"/peclet", 1}}, 1.0}, {{{"/peclet", 100}}, 4.0}, {{{"/peclet", 10}}, 2.5}});
  EXPECT_EQ(curve_text(status, 80), "relative_viscosity over peclet, 1 to 100\n▁▁▁▁▅▅▅▅████  1 to 4\n");
}

TEST(Curve, IsLogarithmicOverAFactorOfFive) {
  const CampaignStatus status =
      swept({{{{"/phi", 0.1}}, 1.0}, {{{"/phi", 0.2}}, 10.0}, {{{"/phi", 0.3}}, 100.0}});
  EXPECT_EQ(curve_text(status, 80), "relative_viscosity over phi, 0.1 to 0.3\n▁▁▁▁▅▅▅▅████  1 to 100\n");
}

TEST(Curve, HasALineForEachOfTheOthersAndADotForWhatIsNotKnown) {
  std::vector<std::pair<Json, double>> points;
  for (const double phi : {0.4, 0.5}) {
    for (const int peclet : {1, 2, 3}) points.push_back({{{"/peclet", peclet}, {"/phi", phi}}, phi * 10});
  }
  points[4].second = nan;
  EXPECT_EQ(curve_text(swept(points), 80),
            "relative_viscosity over peclet, 1 to 3\n"
            "phi=0.4  ▁▁▁▁▁▁▁▁▁▁▁▁  4 to 4\n"
            "phi=0.5  ████····████  5 to 5\n");
}

// Half of the ended seeds have jammed: the mean of -1e-8 is meaningless and does not set the scale.
TEST(Curve, HasACrossForWhatHasJammed) {
  CampaignStatus status =
      swept({{{{"/x", 1}}, 1.0}, {{{"/x", 2}}, 2.5}, {{{"/x", 3}}, 4.0}, {{{"/x", 4}}, -1e-8}});
  status.points[3].endings = {4, 2, 0};
  EXPECT_EQ(curve_text(status, 80), "relative_viscosity over x, 1 to 4\n▁▁▁▁▅▅▅▅████××××  1 to 4\n");
}

TEST(Curve, IsLeftOutWhereItSaysNothingOrDoesNotFit) {
  EXPECT_EQ(curve_text(swept({}), 80), "");
  EXPECT_EQ(curve_text(swept({{{{"/form", "a"}}, 1}, {{{"/form", "b"}}, 2}, {{{"/form", "c"}}, 3}}), 80), "");
  const CampaignStatus few = swept({{{{"/x", 1}}, 1}, {{{"/x", 2}}, 2}, {{{"/x", 3}}, nan}});
  EXPECT_EQ(curve_text(few, 80), "");
  const CampaignStatus status = swept({{{{"/x", 1}}, 1}, {{{"/x", 2}}, 2}, {{{"/x", 3}}, 3}});
  EXPECT_EQ(curve_text(status, 20), "");
  EXPECT_NE(curve_text(status, unlimited_width), "");
}

}  // namespace
}  // namespace peclet::runner
