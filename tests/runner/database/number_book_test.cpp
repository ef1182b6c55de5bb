// The numbers that stand beside results: the same means as of the results, and nothing that they do not say.
#include "runner/database/number_book.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contract/integrity_error.h"
#include "runner/statistics/quantity_estimates.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

Json about(const char* symbol) { return {{"symbol", symbol}, {"unit", "stress"}, {"estimator", "mean"}}; }

// A result with a number, its control, a tensor, a small ratio and a distribution that is too large.
void describe(Json& result, double pressure) {
  result["mean"]["pressure"] = pressure;
  result["mean"]["noise"] = 0.5;
  result["mean"]["stress"] = {1, 2, nullptr, 4, 5, 6};
  result["mean"]["g"] = {{"counts", {pressure, 2}}, {"ideal", {2, 4}}};
  result["mean"]["profile"] = std::vector<int>(10, 1);
  Json& said = result["quantities"];
  said = {{"pressure", about("P")},
          {"noise", about("n")},
          {"stress", about("sigma")},
          {"g", described_ratio({1, 2})}};
  said["pressure"]["control"] = {{"quantity", "noise"}, {"mean", 0.25}};
  said["stress"]["axes"] = {
      {{"name", "component"}, {"unit", "1"}, {"values", {"xx", "yy", "zz", "xy", "xz", "yz"}}}};
  said["profile"] = about("p");
  said["profile"]["axes"] = {{{"name", "y"}, {"unit", "1"}, {"values", std::vector<int>(10, 0)}}};
}

class Numbers : public testing::Test {
 protected:
  void complete(int seed, double pressure) {
    campaign_.complete_with(0, seed, 10, [&](Json& result) { describe(result, pressure); });
  }
  std::vector<QuantityEstimate> estimates(int end) {
    QuantityEstimates sums;
    NumberBook book(campaign_.database().connection());
    book.for_each(
        1, end, [&](const NumberBook::Entry& seed) { sums.add(seed.layout, seed.numbers, seed.has_jammed); });
    return sums.estimates();
  }
  Connection& connection() { return campaign_.database().connection(); }

  StoredCampaign campaign_{1, 4, 40};
};

TEST_F(Numbers, GiveTheMeansOfTheResults) {
  complete(0, 1);
  complete(1, 3);
  complete(2, 100);
  const std::vector<QuantityEstimate> found = estimates(2);
  ASSERT_EQ(found.size(), 4U);  // g, noise, pressure, stress
  EXPECT_EQ(found[0].estimates[0].mean, (1.0 + 3) / (2 + 2));
  EXPECT_EQ(found[0].estimates[1].mean, 0.5);
  EXPECT_EQ(found[2].uncontrolled[0].mean, 2);
  EXPECT_EQ(found[2].estimates[0].mean, 2 + 0.5 - 0.25);
  EXPECT_EQ(found[2].estimates[0].standard_error, 1);  // |3 - 1| / 2
  EXPECT_EQ(found[3].estimates[3].mean, 4);
  EXPECT_EQ(found[3].estimates[2].count, 0);
  EXPECT_EQ(found[3].quantity.axes[0].values[3], "xy");
}

TEST_F(Numbers, OfAnEngineThatDescribesNothingCountToo) {
  campaign_.complete(0, 0, 10);
  const std::vector<QuantityEstimate> found = estimates(1);
  ASSERT_EQ(found.size(), 3U);  // control_variates/brownian_pairwise, pressure, relative_viscosity
  EXPECT_EQ(found[1].estimates[0].mean, 20);
  EXPECT_EQ(found[2].uncontrolled[0].mean, 10);
  EXPECT_EQ(found[2].estimates[0].mean, 10.25);
}

TEST_F(Numbers, AreThereOnlyForWhatHasCompleted) {
  complete(0, 1);
  campaign_.blow_up(0, 1);
  campaign_.crash(0, 2);
  EXPECT_EQ(connection().integer("SELECT count(*) FROM numbers"), 1);
  EXPECT_EQ(connection().integer("SELECT count(*) FROM number_layout"), 1);
}

TEST_F(Numbers, OfAResultAreComparedBitByBit) {
  complete(0, 1);
  NumberBook book(connection());
  Json result = campaign_.database().result(1, 0).value();
  EXPECT_TRUE(book.agrees(1, 0, result));
  EXPECT_FALSE(book.agrees(1, 1, result));
  result["mean"]["pressure"] = std::nextafter(1.0, 2.0);
  EXPECT_FALSE(book.agrees(1, 0, result));
  result["mean"] = nullptr;
  EXPECT_FALSE(book.agrees(1, 0, result));
}

TEST_F(Numbers, ThatAreTooFewAreRefused) {
  complete(0, 1);
  connection().execute("UPDATE numbers SET numbers = substr(numbers, 9)");
  EXPECT_THROW(estimates(1), IntegrityError);
}

TEST_F(Numbers, WithALayoutThatIsNoneAreRefused) {
  complete(0, 1);
  connection().execute("UPDATE number_layout SET quantities = '{\"pressure\":1}'");
  EXPECT_THROW(estimates(1), IntegrityError);
}

}  // namespace
}  // namespace peclet::runner
