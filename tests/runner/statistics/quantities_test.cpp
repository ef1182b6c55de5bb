#include "runner/statistics/quantities.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace peclet::runner {
namespace {

std::vector<std::string> names_in(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names(quantities.size());
  std::transform(quantities.begin(), quantities.end(), names.begin(),
                 [](const Quantity& quantity) { return quantity.name; });
  return names;
}

TEST(Quantities, OfAResultThatDescribesNoneAreItsNumbersAndLists) {
  const Json result = {{"mean",
                        {{"viscosity", 3.5},
                         {"lost", nullptr},
                         {"stress", {{"total", {1, 2, 3}}}},
                         {"map", {{1, 2}, {3, 4}, {5, 6}}},
                         {"species", {{{"x", {1}}}, {{"x", {2}}}}},
                         {"ragged", {{1}, {2, 3}}}}}};
  const std::vector<Quantity> all = quantities_of(result);
  EXPECT_EQ(names_in(all), (std::vector<std::string>{"map", "ragged/0", "ragged/1", "species/0/x",
                                                     "species/1/x", "stress/total", "viscosity"}));
  EXPECT_EQ(all[0].elements(), 6U);
  ASSERT_EQ(all[0].axes.size(), 2U);
  EXPECT_EQ(all[0].axes[0].values, Json({0, 1, 2}));
  EXPECT_EQ(all[0].axes[1].values, Json({0, 1}));
  EXPECT_TRUE(all[6].axes.empty());
  EXPECT_EQ(all[6].unit, "");
  EXPECT_TRUE(quantities_of({{"mean", nullptr}}).empty());
}

TEST(Quantities, OfEarlierEnginesHadOneControlVariate) {
  Json result = {{"mean",
                  {{"relative_viscosity", 3.5},
                   {"pressure", 1},
                   {"control_variates", {{"brownian_pairwise", 0.1}, {"pressure", 0.2}}}}}};
  EXPECT_EQ(control_of(result, "relative_viscosity")->quantity, "control_variates/brownian_pairwise");
  EXPECT_EQ(control_of(result, "pressure"), std::nullopt);
  result["mean"]["control_variates"]["brownian_pairwise"] = nullptr;
  EXPECT_EQ(control_of(result, "relative_viscosity"), std::nullopt);
}

TEST(Quantities, TheNameOfAViscosityMeansNothingInADescribedResult) {
  Json result = {{"mean", {{"relative_viscosity", 3.5}, {"control_variates", {{"brownian_pairwise", 0.1}}}}}};
  result["quantities"] = {{"relative_viscosity", {{"symbol", "eta"}, {"unit", "1"}, {"estimator", "mean"}}}};
  EXPECT_EQ(control_of(result, "relative_viscosity"), std::nullopt);
}

TEST(Quantities, APathLeadsThroughObjectsAndLists) {
  const Json mean = {{"a", {{"b", {1, {{"c", 2}}}}}}};
  EXPECT_EQ(*at_path(mean, "a/b/0"), 1);
  EXPECT_EQ(*at_path(mean, "/a/b/1/c"), 2);
  for (const char* nowhere : {"a/c", "a/b/2", "a/b/-1", "a/b/x", "a/b/0/c", "b", "a/b/0x", "a//b"}) {
    EXPECT_EQ(at_path(mean, nowhere), nullptr) << nowhere;
  }
}

TEST(Quantities, AListWhoseNameHasASlashHasElements) {
  const Json mean = {{"P/P0", {1, 2}}, {"P", {{"x", 3}}}, {"a/b", {{"c", 4}}}, {"a", {{"b", {{"d", 5}}}}}};
  EXPECT_EQ(*at_path(mean, "P/P0/0"), 1);
  EXPECT_EQ(*at_path(mean, "/P/P0/1"), 2);
  EXPECT_EQ(*at_path(mean, "P/x"), 3);
  EXPECT_EQ(*at_path(mean, "a/b/c"), 4);
  EXPECT_EQ(*at_path(mean, "a/b/d"), 5);
  for (const char* nowhere : {"P/P0/2", "P/P0/0/x", "P/P1/0", "a/b/e"}) {
    EXPECT_EQ(at_path(mean, nowhere), nullptr) << nowhere;
  }
}

TEST(Quantities, AStarStandsForAnyIndex) {
  EXPECT_TRUE(matches("stress/total/*", "stress/total/3"));
  EXPECT_TRUE(matches("stress/total/*", "/stress/total/3"));
  EXPECT_TRUE(matches("pressure", "pressure"));
  for (const char* other : {"stress/total", "stress/total/xy", "stress/total/3/4", "stress/other/3", ""}) {
    EXPECT_FALSE(matches("stress/total/*", other)) << other;
  }
}

}  // namespace
}  // namespace peclet::runner
