// Compares means and errors of quantities with formulas.
#include "runner/statistics/quantity_estimates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

Json result_of(const Json& mean) {
  return {{"mean", mean},
          {"quantities",
           {{"pressure",
             {{"symbol", "P"},
              {"unit", "stress"},
              {"estimator", "mean"},
              {"control", {{"quantity", "noise"}, {"mean", 1}}}}},
            {"noise", {{"symbol", "n"}, {"unit", "stress"}, {"estimator", "mean"}}},
            {"g", described_ratio({1, 2})}}}};
}

QuantityEstimates of(const std::vector<Json>& means) {
  QuantityEstimates estimates;
  for (const Json& mean : means) estimates.add(result_of(mean));
  return estimates;
}

// N = 1, 2 and D = 1, 3 give R = 3 / 4. Without one seed it is 2 / 3 or 1, each 1 / 6 from the mean 5 / 6:
// s^2 = 1 / 2 (1 / 36 + 1 / 36).
TEST(RatioOfMeans, HasTheErrorOfTheJackknife) {
  const Estimate found = ratio_of_means({1, 2}, {1, 3});
  EXPECT_EQ(found.count, 2);
  EXPECT_NEAR(found.mean, 0.75, 1e-15);
  EXPECT_NEAR(found.standard_error, 1.0 / 6, 1e-15);
}

// Numerators 2, 4, 9 of mean 5 have the sample variance 13. With the constant denominator 4 the standard
// error is sqrt(13 / 3) / 4.
TEST(RatioOfMeans, OverAConstantHasTheErrorOfAMean) {
  const Estimate found = ratio_of_means({2, 4, 9}, {4, 4, 4});
  EXPECT_NEAR(found.mean, 1.25, 1e-15);
  EXPECT_NEAR(found.standard_error, std::sqrt(13.0 / 3) / 4, 1e-14);
}

TEST(RatioOfMeans, ThatIsTheSameInEverySeedHasNoError) {
  EXPECT_NEAR(ratio_of_means({3, 6, 15}, {1, 2, 5}).standard_error, 0, 1e-15);
  EXPECT_NEAR(ratio_of_means({3, 6, 15}, {1, 2, 5}).mean, 3, 1e-15);
}

TEST(RatioOfMeans, OfNothingIsNone) {
  EXPECT_TRUE(std::isnan(ratio_of_means({}, {}).mean));
  EXPECT_TRUE(std::isnan(ratio_of_means({0, 0}, {0, 0}).mean));
  EXPECT_EQ(ratio_of_means({3}, {2}).mean, 1.5);
  EXPECT_TRUE(std::isnan(ratio_of_means({3}, {2}).standard_error));
}

// For N = 2 D + e with D of mean 1, R - 2 = mean of e / mean of D has the variance var(e) / n to first order.
// For 400 sets of 100 seeds, the mean square of the error and the spread of the ratios must be within 25 % of
// 0.09 / 100: 3.5 standard deviations of a variance from 400 values.
TEST(RatioOfMeans, HasTheSpreadThatItsErrorSays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int sets = 400, seeds = 100;
  double spread = 0, error = 0;
  for (int set = 0; set < sets; ++set) {
    std::vector<double> above, below;
    for (int seed = 0; seed < seeds; ++seed) {
      below.push_back(1 + 0.2 * normal(random));
      above.push_back(2 * below.back() + 0.3 * normal(random));
    }
    const Estimate found = ratio_of_means(above, below);
    spread += (found.mean - 2) * (found.mean - 2) / sets;
    error += found.standard_error * found.standard_error / sets;
  }
  EXPECT_NEAR(spread, 0.09 / seeds, 0.25 * 0.09 / seeds);
  EXPECT_NEAR(error, 0.09 / seeds, 0.25 * 0.09 / seeds);
}

// Values 10, 12, 14 with controls 1.5, 0.5, 1 of mean 1 give 10.5, 11.5, 14 of mean 12 and sample variance
// (2.25 + 0.25 + 4) / 2.
TEST(QuantityEstimates, AreOfTheControlledValueWithThePlainOneBesideIt) {
  const QuantityEstimates estimates = of({{{"pressure", 10}, {"noise", 1.5}, {"g", nullptr}},
                                          {{"pressure", 12}, {"noise", 0.5}, {"g", nullptr}},
                                          {{"pressure", 14}, {"noise", 1}, {"g", nullptr}}});
  const Json pressure = estimates.json(0.95)["pressure"];
  EXPECT_EQ(pressure["count"], 3);
  EXPECT_NEAR(pressure["mean"].get<double>(), 12, 1e-14);
  const double error = std::sqrt(3.25 / 3);
  EXPECT_NEAR(pressure["standard_error"].get<double>(), error, 1e-14);
  EXPECT_NEAR(pressure["half_width"].get<double>(), 4.302653 * error,
              1e-6 * error);  // t of 2 degrees, 97.5 %
  EXPECT_NEAR(pressure["plain"]["mean"].get<double>(), 12, 1e-14);
  EXPECT_NEAR(pressure["plain"]["standard_error"].get<double>(), std::sqrt(4.0 / 3), 1e-14);
  EXPECT_EQ(pressure["symbol"], "P");
  EXPECT_EQ(pressure["unit"], "stress");
  EXPECT_EQ(pressure["axes"], Json::array());
}

TEST(QuantityEstimates, OfARatioAreListsOverItsAxes) {
  const QuantityEstimates estimates =
      of({{{"pressure", 1}, {"noise", 1}, {"g", {{"counts", {1, 5}}, {"ideal", {1, 0}}}}},
          {{"pressure", 1}, {"noise", 1}, {"g", {{"counts", {2, 5}}, {"ideal", {3, 0}}}}}});
  const Json g = estimates.json(0.95)["g"];
  EXPECT_EQ(g["estimator"], "ratio");
  EXPECT_EQ(g["axes"], described_ratio({1, 2})["axes"]);
  EXPECT_EQ(g["count"], Json({2, 2}));
  EXPECT_NEAR(g["mean"][0].get<double>(), 0.75, 1e-15);
  EXPECT_NEAR(g["standard_error"][0].get<double>(), 1.0 / 6, 1e-15);
  EXPECT_TRUE(g["mean"][1].is_null());
}

TEST(QuantityEstimates, LeaveOutWhatIsLostAndWhatIsUnlike) {
  Json other = result_of({{"pressure", 5}, {"noise", 1}, {"g", nullptr}});
  other["quantities"]["pressure"]["unit"] = "energy";
  QuantityEstimates estimates = of({{{"pressure", 1}, {"noise", 1}, {"g", nullptr}}});
  estimates.add({{"mean", nullptr}});
  estimates.add(other);
  estimates.add(result_of({{"pressure", nullptr}, {"noise", 1}, {"g", nullptr}}));
  estimates.add(result_of({{"pressure", 3}, {"noise", 1}, {"g", nullptr}}));
  const Json pressure = estimates.json(0.95)["pressure"];
  EXPECT_EQ(pressure["count"], 2);
  EXPECT_EQ(pressure["mean"], 2.0);
  EXPECT_EQ(pressure["unlike"], 1);
  EXPECT_EQ(estimates.json(0.95)["noise"]["count"], 4);
}

TEST(QuantityEstimates, OfAnotherControlAreUnlikeWhateverComesFirst) {
  Json undescribed = result_of({{"pressure", 5}, {"noise", 1}, {"g", nullptr}});
  undescribed.erase("quantities");
  Json other = result_of({{"pressure", 7}, {"noise", 1}, {"g", nullptr}});
  other["quantities"]["pressure"]["control"]["mean"] = 3;
  QuantityEstimates first_undescribed, first_described;
  first_undescribed.add(undescribed);
  for (QuantityEstimates* const estimates : {&first_undescribed, &first_described}) {
    for (const double value : {1, 2}) {
      estimates->add(result_of({{"pressure", value}, {"noise", 1}, {"g", nullptr}}));
    }
    estimates->add(other);
  }
  EXPECT_EQ(first_undescribed.json(0.95)["pressure"]["count"], 1);
  EXPECT_EQ(first_undescribed.json(0.95)["pressure"]["mean"], 5);
  EXPECT_EQ(first_undescribed.json(0.95)["pressure"]["unlike"], 3);
  EXPECT_EQ(first_described.json(0.95)["pressure"]["count"], 2);
  EXPECT_EQ(first_described.json(0.95)["pressure"]["unlike"], 1);
}

// The second value counts as value + 0, as in a stop test. The control has the mean 1.
TEST(QuantityEstimates, AValueWithoutItsControlCountsAsItIs) {
  const QuantityEstimates estimates = of({{{"pressure", 10}, {"noise", 3}, {"g", nullptr}},
                                          {{"pressure", 20}, {"noise", nullptr}, {"g", nullptr}}});
  const Json pressure = estimates.json(0.95)["pressure"];
  EXPECT_EQ(pressure["count"], 2);
  EXPECT_EQ(pressure["mean"], 16);
}

// Returns the result of a seed under a given stress. A jammed seed has a stress and almost no rate.
Json under_stress(double rate, bool has_jammed, double stress = 3) {
  const Json ratio{{"symbol", "eta"},
                   {"unit", "1"},
                   {"estimator", "ratio"},
                   {"numerator", "stress"},
                   {"denominator", "rate"}};
  return {{"mean", {{"viscosity", {{"stress", stress}, {"rate", rate}}}}},
          {"ending", {{"cause", has_jammed ? "jammed" : "completed"}}},
          {"quantities", {{"viscosity", ratio}}}};
}

TEST(QuantityEstimates, OfAPointThatHasJammedHaveNoViscosity) {
  const auto viscosity = [](int jammed, double rate, double stress) {
    QuantityEstimates estimates;
    for (int seed = 0; seed < 4; ++seed) {
      estimates.add(seed < jammed ? under_stress(rate, true, stress) : under_stress(1, false));
    }
    return estimates.json(0.95)["viscosity"]["mean"];
  };
  for (const double rate : {0.0, 3e-8, -3e-8}) {
    EXPECT_TRUE(viscosity(4, rate, 3).is_null());
    EXPECT_TRUE(viscosity(3, rate, 3).is_null());
    EXPECT_TRUE(viscosity(2, rate, 3).is_null());
    EXPECT_NEAR(viscosity(1, rate, 3).get<double>(), 4 * 3.0 / 3, 1e-6);
    EXPECT_NEAR(viscosity(0, rate, 3).get<double>(), 3, 1e-12);
  }
  EXPECT_NEAR(viscosity(3, 0, 0).get<double>(), 3, 1e-12);  // of the seed that flows
  EXPECT_TRUE(viscosity(4, 0, 0).is_null());
}

TEST(QuantityEstimates, OfScalarsAloneLeaveListsOut) {
  QuantityEstimates estimates(QuantityEstimates::Wanted::scalars);
  estimates.add(result_of({{"pressure", 10}, {"noise", 3}, {"g", {{"counts", {1, 5}}, {"ideal", {1, 0}}}}}));
  EXPECT_TRUE(estimates.json(0.95).contains("pressure"));
  EXPECT_FALSE(estimates.json(0.95).contains("g"));
}

}  // namespace
}  // namespace peclet::runner
