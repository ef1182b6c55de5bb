// Descriptions of numbers in results, and how they decide what is read of a number.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "contract/sha256.h"
#include "runner/statistics/number_layout.h"
#include "runner/statistics/quantities.h"
#include "runner/store/realisation_result.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

Observation observe(const Json& result, const std::string& path) {
  const NumberLayout layout(result, {path});
  return layout.observation(0, layout.numbers(result));
}

TEST(RealisationResult, OnlyRelativeViscositiesHaveAControlVariate) {
  const Json result = plain_result(sha256("point"), 3, 12.5);
  EXPECT_EQ(observe(result, "relative_viscosity").value, 12.5);
  EXPECT_EQ(observe(result, "relative_viscosity").control, 0.25);
  EXPECT_EQ(observe(result, "pressure").value, 25);
  EXPECT_EQ(observe(result, "pressure").control, 0);
  EXPECT_EQ(control_of(result, "pressure"), std::nullopt);
  EXPECT_TRUE(std::isnan(observe(result, "temperature").value));
}

// A profile of three bins with a control variate of mean 0.5, in quarters; a scalar without blocks; a ratio.
Json described_result() {
  Json result = plain_result(sha256("point"), 3, 12.5);
  result["mean"] = {{"profile", {{"velocity", {1, 2, 4}}}},
                    {"noise", {0.5, 0.75, 0}},
                    {"alone", 7},
                    {"g", {{"counts", {3, 4}}, {"ideal", 2}}}};
  result["blocks"] = {{"profile", {{"velocity", {{1, 1, 1}, {1, 2, 3}, {1, 3, 5}, {1, 2, 7}}}}},
                      {"noise", {{0.5, 0.5, 0}, {0.5, 1, 0}, {0.5, 1, 0}, {0.5, 0.5, 0}}}};
  const Json y = {{{"name", "y"}, {"unit", "length"}, {"values", {0.5, 1.5, 2.5}}}};
  result["quantities"] = {
      {"profile/velocity",
       {{"symbol", "u"},
        {"unit", "length / time"},
        {"estimator", "mean"},
        {"axes", y},
        {"control", {{"quantity", "noise"}, {"mean", 0.5}}}}},
      {"noise", {{"symbol", "n"}, {"unit", "length / time"}, {"estimator", "mean"}, {"axes", y}}},
      {"alone", {{"symbol", "a"}, {"unit", "1"}, {"estimator", "mean"}}},
      {"g", described_ratio({1, 2})}};
  return result;
}

TEST(RealisationResult, AnElementHasTheControlVariateAndTheBlocksOfItsList) {
  const Json result = parse_result(described_result().dump()).document;
  for (const char* path : {"profile/velocity/1", "/profile/velocity/1"}) {
    const Observation observed = observe(result, path);
    EXPECT_EQ(observed.value, 2);
    EXPECT_EQ(observed.control, 0.25);  // 0.75 less its known mean
    EXPECT_EQ(observed.first_quarter, 1 + 0.5 - 0.5);
    EXPECT_EQ(observed.first_half, 1.5 + 0.75 - 0.5);
  }
  EXPECT_TRUE(std::isnan(observe(result, "profile/velocity").value));  // a list is not a number
  EXPECT_TRUE(std::isnan(observe(result, "profile/velocity/3").value));
  EXPECT_EQ(observe(result, "g/counts/1").value, 4);
  EXPECT_EQ(names_of_targets(result), "alone, noise/*, profile/velocity/*");
}

// Moduli of few cycles have few blocks.
TEST(RealisationResult, TheBeginningOfEightBlocksIsThatOfTwoAndOfFour) {
  Json result = plain_result(sha256("point"), 3, 12.5);
  result["mean"]["loss_modulus"] = 4.5;
  result["blocks"]["loss_modulus"] = {1, 2, 3, 4, 5, 6, 7, 8};
  const Observation observed = observe(result, "loss_modulus");
  EXPECT_EQ(observed.value, 4.5);
  EXPECT_EQ(observed.first_quarter, 1.5);
  EXPECT_EQ(observed.first_half, 2.5);
}

TEST(RealisationResult, WithoutBlocksTheBeginningOfTheWindowIsNotKnown) {
  const Observation observed = observe(described_result(), "alone");
  EXPECT_EQ(observed.value, 7);
  EXPECT_TRUE(std::isnan(observed.first_quarter));
  EXPECT_TRUE(std::isnan(observed.first_half));
}

TEST(RealisationResult, ItsDescriptionsAreThoseOfItsNumbers) {
  struct Fault {
    const char* place;
    Json value;
    const char* complaint;
  };
  const std::vector<Fault> faults{
      {"/quantities", Json::array(), "/quantities: []: must be an object"},
      {"/quantities/alone/unit", "", "/quantities/alone/unit: \"\": must be a name"},
      {"/quantities/alone/symbol", 3, "/quantities/alone/symbol: 3: must be a name"},
      {"/quantities/alone/estimator", "median",
       "/quantities/alone/estimator: \"median\": must be one of: mean, ratio, share"},
      {"/quantities/noise/estimator", "share", "must be left out unless estimator is mean"},
      {"/quantities/g/denominator", nullptr, "/quantities/g/denominator: null: must be a name"},
      {"/quantities/g/denominator", "more", "/mean/g/more: is missing"},
      {"/mean/g/ideal", {1, 2, 3}, "/mean/g/ideal: must be a number, or lists"},
      {"/mean/profile/velocity", {1, 2}, "/mean/profile/velocity: must be a number, or lists"},
      {"/mean/profile/velocity", 1, "/mean/profile/velocity: must be a number, or lists"},
      {"/mean/alone", "7", "/mean/alone: must be a number, null, a list or an object"},
      {"/mean/noise/0", "7", "/mean/noise/0: must be a number, null, a list or an object"},
      {"/quantities/noise/axes/0/values", Json::array(),
       "/quantities/noise/axes/0/values: []: must be an array of 1 or more"},
      {"/quantities/noise/axes/0/values/1", true,
       "/quantities/noise/axes/0/values/1: true: must be a number, or a name"},
      {"/quantities/alone/control",
       {{"quantity", "noise"}, {"mean", 0}},
       "/quantities/alone/control/quantity"},
      {"/quantities/noise/control", {{"quantity", "nothing"}, {"mean", 0}}, "must be another quantity"},
      {"/quantities/alone/control", {{"quantity", "alone"}, {"mean", 0}}, "must be another quantity"},
      {"/quantities/alone/symbol", "a\nb", "must be a name of 1 to 120 bytes"}};
  for (const Fault& fault : faults) {
    Json result = described_result();
    result[Json::json_pointer(fault.place)] = fault.value;
    try {
      parse_result(result.dump());
      ADD_FAILURE() << fault.place;
    } catch (const ResultError& error) {
      EXPECT_NE(std::string(error.what()).find(fault.complaint), std::string::npos) << error.what();
    }
  }
  Json empty = described_result();
  empty["mean"]["profile"]["velocity"] = nullptr;  // there was nothing to measure
  EXPECT_TRUE(std::isnan(observe(parse_result(empty.dump()).document, "profile/velocity/1").value));
}

// 64 axes of two values each describe 2^64 numbers, a product that is 0 in 64 bits.
TEST(RealisationResult, ADescriptionMayNotAskForMoreRoomThanThereIs) {
  for (const std::size_t axes : {3U, 64U}) {
    Json result = described_result();
    const Json values(std::vector<int>(axes == 3 ? 1000 : 2, 1));
    result["mean"]["alone"] = nullptr;
    result["quantities"]["alone"] = {
        {"symbol", ""}, {"unit", "1"}, {"estimator", "mean"}, {"axes", Json::array()}};
    for (std::size_t axis = 0; axis < axes; ++axis) {
      result["quantities"]["alone"]["axes"].push_back({{"name", "x"}, {"unit", "1"}, {"values", values}});
    }
    try {
      parse_result(result.dump());
      ADD_FAILURE() << axes;
    } catch (const ResultError& error) {
      EXPECT_NE(std::string(error.what()).find("must not make more than 4194304 numbers"), std::string::npos)
          << error.what();
    }
  }
}

// Another engine may describe no numbers: then each of them is a quantity, by its own name.
TEST(RealisationResult, WithoutDescriptionsIsWithEmptyOnes) {
  Json lost = plain_result(sha256("point"), 0, 10);
  lost["ending"]["cause"] = "overlap";
  lost["mean"] = lost["blocks"] = nullptr;
  lost["quantities"] = Json::object();
  EXPECT_EQ(parse_result(lost.dump()).cause, "overlap");
  Json empty = plain_result(sha256("point"), 0, 10), absent = empty;
  empty["quantities"] = Json::object();
  absent.erase("quantities");
  for (const Json& result : {empty, absent}) {
    std::vector<std::string> names;
    for (const Quantity& quantity : quantities_of(parse_result(result.dump()).document)) {
      names.push_back(quantity.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"control_variates/brownian_pairwise", "pressure",
                                               "relative_viscosity"}));
  }
}

// Another engine may use such a name.
TEST(RealisationResult, ANameMayHoldASlash) {
  Json result = plain_result(sha256("point"), 0, 10);
  result.erase("quantities");
  result["mean"]["P/P0"] = 3.5;
  result["blocks"]["P/P0"] = {1, 2, 3, 8};
  const Json document = parse_result(result.dump()).document;
  EXPECT_TRUE(has_observable(document["mean"], "P/P0"));
  EXPECT_EQ(observe(document, "P/P0").value, 3.5);
  EXPECT_EQ(observe(document, "P/P0").first_half, 1.5);
  result["mean"]["P"] = {{"P0", 4}};
  try {
    parse_result(result.dump());
    ADD_FAILURE();
  } catch (const ResultError& error) {
    EXPECT_NE(std::string(error.what()).find("/mean/P/P0: must not be there in two ways"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace peclet::runner
