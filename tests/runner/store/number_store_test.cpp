// The numbers stored beside results give the same means as the results, and nothing else.
#include "runner/store/number_store.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "contract/errors.h"
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
    NumberStore book(campaign_.database().connection());
    book.for_each(1, end, [&](const NumberStore::Entry& seed) {
      sums.add(seed.layout, seed.numbers, seed.has_jammed);
    });
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
  EXPECT_EQ(found[2].plain[0].mean, 2);
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
  EXPECT_EQ(found[2].plain[0].mean, 10);
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
  NumberStore book(connection());
  Json result = campaign_.database().result(1, 0).value();
  const std::vector<std::string> observables{"relative_viscosity"};
  EXPECT_TRUE(book.agrees(1, 0, result, observables));
  EXPECT_FALSE(book.agrees(1, 1, result, observables));
  EXPECT_FALSE(book.agrees(1, 0, result, {"pressure"}));
  result["mean"]["pressure"] = std::nextafter(1.0, 2.0);
  EXPECT_FALSE(book.agrees(1, 0, result, observables));
  result["mean"] = nullptr;
  EXPECT_FALSE(book.agrees(1, 0, result, observables));
}

// Numbers of either sign, from the smallest double to the largest number of a result.
TEST_F(Numbers, ComeBackBitByBit) {
  const std::vector<double> all{0.1 + 0.2, -1.0 / 3,           5e-324, 1e100,
                                -0.0,      9007199254740993.0, 1e-9,   123456789.125};
  for (int seed = 0; seed < static_cast<int>(all.size()); ++seed) {
    const double pressure = all[static_cast<std::size_t>(seed)];
    campaign_.complete_with(0, seed, 10, [&](Json& result) { result["mean"]["pressure"] = pressure; });
  }
  NumberStore book(connection());
  book.for_each(1, 40, [&](const NumberStore::Entry& seed) {
    const Quantity& pressure = seed.layout.quantities().at(1);
    EXPECT_EQ(pressure.name, "pressure");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(seed.layout.of_quantity(1, seed.numbers)[0]),
              std::bit_cast<std::uint64_t>(all[static_cast<std::size_t>(seed.seed)]));
  });
}

TEST_F(Numbers, OfAnObservableStandOnceAndBeforeTheOthers) {
  complete(0, 1);
  // value, control, first quarter and first half of the viscosity; then g, noise, pressure and its control,
  // stress
  EXPECT_EQ(connection().text("SELECT numbers FROM numbers"),
            "[10,null,10,10,1,2,2,4,0.5,1,0.25,1,2,null,4,5,6]");
}

TEST_F(Numbers, OfAnElementThatIsTooSmallAPartOfItsListStandBeforeTheOthers) {
  Target target = campaign_.database().campaign().target.target;
  complete(0, 1);
  target.observable = "profile/3";
  target.also = {{"/pressure", 0.1}};
  campaign_.set_target(target);
  EXPECT_EQ(connection().text("SELECT numbers FROM numbers"),
            "[1,null,null,null,1,0.25,null,null,1,2,2,4,0.5,1,2,null,4,5,6]");
  EXPECT_EQ(campaign_.database().outcomes(1).at(0)->further.at(0).control, 0.25);
  EXPECT_EQ(estimates(1).at(2).estimates[0].mean, 1.25);
}

TEST_F(Numbers, ThatAreNotAsTheirLayoutSaysAreRefused) {
  complete(0, 1);
  const std::string whole = connection().text("SELECT numbers FROM numbers");
  for (const std::string& text :
       std::vector<std::string>{"[1,2]", "[]", "{}", "12", "[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,true]"}) {
    connection().execute("UPDATE numbers SET numbers = '" + text + "'");
    EXPECT_THROW(estimates(1), IntegrityError) << text;
    EXPECT_THROW(campaign_.database().outcomes(1), IntegrityError) << text;
  }
  for (const std::string& text : std::vector<std::string>{"[1,2]", "[]", "{}", "[\"1\",2,3,4]"})
    EXPECT_THROW(leading_observation(text), IntegrityError);
  connection().execute("UPDATE numbers SET numbers = '" + whole.substr(0, whole.size() - 1) + ",1]'");
  EXPECT_THROW(estimates(1), IntegrityError);
  connection().execute("UPDATE numbers SET numbers = '" + whole + "'");
  EXPECT_EQ(estimates(1).size(), 4U);
}

TEST_F(Numbers, WithALayoutThatIsNoneAreRefused) {
  complete(0, 1);
  for (const std::string& text :
       std::vector<std::string>{"{\"pressure\":1}", "[]", "{\"observables\":[1],\"quantities\":{}}"}) {
    connection().execute("UPDATE number_layout SET layout = '" + text + "'");
    EXPECT_THROW(estimates(1), IntegrityError) << text;
  }
}

}  // namespace
}  // namespace peclet::runner
