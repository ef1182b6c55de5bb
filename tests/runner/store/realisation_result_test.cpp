#include "runner/store/realisation_result.h"

#include <gtest/gtest.h>

#include <functional>

#include "contract/sha256.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

const std::string point = sha256("point");

TEST(RealisationResult, TakesAWellFormedOne) {
  const RealisationResult result = parse_result(plain_result(point, 3, 12.5).dump());
  EXPECT_EQ(result.point, point);
  EXPECT_EQ(result.seed, 3);
  EXPECT_TRUE(result.completed());
}

TEST(RealisationResult, RefusesEverythingElse) {
  struct Fault {
    const char* what;
    std::function<void(Json&)> inflict;
  };
  const std::vector<Fault> faults{
      {"no version", [](Json& r) { r.erase("schema_version"); }},
      {"another version", [](Json& r) { r["schema_version"] = 2; }},
      {"no point", [](Json& r) { r.erase("point"); }},
      {"a point that is no hash", [](Json& r) { r["point"] = "peclet=1"; }},
      {"a negative seed", [](Json& r) { r["seed"] = -1; }},
      {"a broken seed", [](Json& r) { r["seed"] = 1.5; }},
      {"an enormous seed", [](Json& r) { r["seed"] = 1LL << 40; }},
      {"an ending that is no word", [](Json& r) { r["ending"]["cause"] = "Out of memory?"; }},
      {"a nameless ending", [](Json& r) { r["ending"]["cause"] = ""; }},
      {"an ending that is no object", [](Json& r) { r["ending"] = "completed"; }},
      {"no mean", [](Json& r) { r["mean"] = nullptr; }},
      {"no blocks", [](Json& r) { r.erase("blocks"); }},
      {"a number after a blow-up", [](Json& r) { r["ending"]["cause"] = "overlap"; }},
      {"no cost", [](Json& r) { r.erase("cost"); }},
      {"a cost in words", [](Json& r) { r["cost"]["cpu_seconds"] = "little"; }},
      {"no final state", [](Json& r) { r["final_state_sha256"] = nullptr; }},
      {"no engine", [](Json& r) { r.erase("engine"); }},
      {"an engine without its binary", [](Json& r) { r["engine"].erase("binary_sha256"); }},
      {"an engine without its instruction set", [](Json& r) { r["engine"].erase("instruction_set"); }},
      {"a list", [](Json& r) { r = Json::array(); }},
      {"a seed that no campaign can have", [](Json& r) { r["seed"] = 1'000'000; }},
      {"the largest seed of an int", [](Json& r) { r["seed"] = 2147483647; }},
      {"a cause without end", [](Json& r) { r["ending"]["cause"] = std::string(65, 'a'); }},
      {"an ending in a list", [](Json& r) { r["ending"]["message"] = Json::array(); }},
      {"a state in numbers", [](Json& r) { r["ending"]["state"] = 1; }},
      {"half a step", [](Json& r) { r["ending"]["step"] = 0.5; }},
      {"a step beyond counting", [](Json& r) { r["ending"]["step"] = 1e300; }},
      {"steps in a list",
       [](Json& r) {
         r["steps"] = Json::array({1, 2});
       }},
      {"a negative number of steps", [](Json& r) { r["steps"]["production"] = -1; }},
      {"steps in words", [](Json& r) { r["steps"]["production"] = "many"; }},
      {"strain in words", [](Json& r) { r["strain"]["production"] = "much"; }},
      {"no strain at all", [](Json& r) { r["strain"] = nullptr; }},
      {"a time step in words", [](Json& r) { r["timestep"] = "short"; }},
      {"an overlap in words", [](Json& r) { r["largest_overlap"] = "large"; }},
      {"an inefficiency in a list", [](Json& r) { r["statistical_inefficiency"] = Json::array(); }},
      {"derived numbers in words", [](Json& r) { r["derived"]["stokes"] = "small"; }},
      {"derived numbers in a list", [](Json& r) { r["derived"] = Json::array(); }},
      {"warnings in words", [](Json& r) { r["warnings"] = "none"; }},
      {"a warning in words", [](Json& r) { r["warnings"] = {"overlap"}; }},
      {"a warning without a code",
       [](Json& r) {
         r["warnings"] = {{{"message", "x"}}};
       }},
      {"a warning whose code is a number",
       [](Json& r) {
         r["warnings"] = {{{"code", 1}, {"message", "x"}}};
       }},
      {"a warning whose code is a text",
       [](Json& r) {
         r["warnings"] = {{{"code", "A b"}, {"message", "x"}}};
       }},
      {"a warning without words",
       [](Json& r) {
         r["warnings"] = {{{"code", "overlap"}}};
       }},
      {"a control variate in words",
       [](Json& r) { r["mean"]["control_variates"]["brownian_pairwise"] = "0"; }},
      {"a mean in a list", [](Json& r) { r["mean"] = Json::array(); }},
      {"a mean with words", [](Json& r) { r["mean"]["pressure"] = "12"; }},
      {"a mean with a truth", [](Json& r) { r["mean"]["pressure"] = true; }},
      {"a mean whose name rings", [](Json& r) { r["mean"]["a\x07"] = 1; }},
      {"a mean whose name has no end", [](Json& r) { r["mean"][std::string(121, 'a')] = 1; }},
      {"a gate in words", [](Json& r) { r["gate"] = "open"; }},
      {"a method in numbers", [](Json& r) { r["method"] = 1; }},
      {"units in numbers", [](Json& r) { r["units"] = 1; }},
      {"a cost below nothing", [](Json& r) { r["cost"]["cpu_seconds"] = -1; }},
      {"a cost in a list",
       [](Json& r) {
         r["cost"] = Json::array({1, 2});
       }},
      {"a version in numbers", [](Json& r) { r["engine"]["version"] = 1; }},
      {"a version that moves the cursor", [](Json& r) { r["engine"]["version"] = "1\x1b[2J"; }},
      {"a version without end", [](Json& r) { r["engine"]["version"] = std::string(121, '1'); }},
      {"a binary that is no hash", [](Json& r) { r["engine"]["binary_sha256"] = "peclet-engine"; }},
      {"a value whose square is none", [](Json& r) { r["mean"]["relative_viscosity"] = 1e155; }},
      {"the largest number there is", [](Json& r) { r["mean"]["pressure"] = -1.7976931348623157e308; }},
      {"a block that is too large", [](Json& r) { r["blocks"]["relative_viscosity"][31] = 1.1e100; }},
      {"a cost that is too large", [](Json& r) { r["cost"]["cpu_seconds"] = 1e101; }},
  };
  for (const Fault& fault : faults) {
    Json result = plain_result(point, 3, 12.5);
    fault.inflict(result);
    EXPECT_THROW(parse_result(result.dump()), ResultError) << fault.what;
  }
}

TEST(RealisationResult, TakesWhatIsJustWithinTheBounds) {
  Json result = plain_result(point, 999'999, 1e100);
  result["mean"]["pressure"] = -1e100;
  result["steps"]["production"] = 9007199254740991;  // 2^53 - 1
  result["warnings"] = {{{"code", "timestep-2"}, {"message", "ends\nhere"}}};
  EXPECT_EQ(parse_result(result.dump()).seed, 999'999);
  for (const char* const key : {"steps", "strain", "time", "derived", "warnings", "gate", "units", "method"})
    result.erase(key);  // an early engine did not write them
  EXPECT_TRUE(parse_result(result.dump()).completed());
}

TEST(RealisationResult, SaysWhereTheFaultIsInOneShortLine) {
  const auto complaint = [](const Json& result) {
    try {
      parse_result(result.dump());
    } catch (const ResultError& error) {
      return std::string(error.what());
    }
    return std::string("nothing is wrong");
  };
  Json result = plain_result(point, 3, 12.5);
  result["warnings"] = {{{"code", "overlap"}, {"message", ""}}, {{"message", "x"}}};
  EXPECT_EQ(complaint(result),
            "/warnings/1/code: missing: must be a word of at most 64 letters a-z, digits and hyphens");
  result = plain_result(point, 3, 12.5);
  result["mean"]["stress"] = {{"total", {1, 2, 1e200, 4, 5, 6}}};
  EXPECT_EQ(complaint(result), "/mean/stress/total/2: must be a number between -1e+100 and 1e+100");
  result = plain_result(point, 3, 12.5);
  result["derived"][std::string(10'000, '\x1b')] = "x";
  EXPECT_LT(complaint(result).size(), 250U);
  EXPECT_EQ(complaint(result).find('\x1b'), std::string::npos);
}

TEST(RealisationResult, RefusesWhatWouldTakeAllMemory) {
  // 2^22 values, 2^19 lists, objects and keys, and 64 MiB are allowed.
  const auto list = [](const std::string& element, int most = 1 << 19) {
    std::string text = "[" + element;
    for (int i = 0; i < most; ++i) text += "," + element;
    return text + "]";
  };
  for (const std::string& text :
       {list("0", 1 << 22), list("{}"), list("[]"), "\"" + std::string(65 << 20, 'x') + "\"",
        std::string(1000, '[') + std::string(1000, ']')}) {
    EXPECT_NE(excess_of(text), "") << text.substr(0, 20);
    EXPECT_THROW(parse_result(text), ResultError) << text.substr(0, 20);
  }
  EXPECT_EQ(excess_of(R"(["[[[[,,,,\"\\\",,,", {"a": [1, 2]}])"), "");
  EXPECT_EQ(excess_of(std::string(1 << 23, ',') + "\""), "it has more than 4194304 values");
  EXPECT_EQ(excess_of("\"" + std::string(1 << 23, ',') + "\""), "") << "commas of a text";
}

TEST(RealisationResult, AnotherEngineHasItsOwnEndingsAndLacksOthersNumbers) {
  Json lost = plain_result(point, 3, 12.5);
  lost["ending"]["cause"] = "lost-atoms";
  lost["mean"] = lost["blocks"] = nullptr;
  EXPECT_FALSE(parse_result(lost.dump()).completed());
  EXPECT_EQ(parse_result(lost.dump()).cause, "lost-atoms");

  Json plain = plain_result(point, 3, 12.5);
  plain["mean"].erase("control_variates");
  for (const char* const key : {"method", "timestep", "statistical_inefficiency", "largest_overlap", "gate"})
    plain[key] = nullptr;
  plain["strain"] = {{"equilibration", nullptr}, {"production", nullptr}};
  EXPECT_TRUE(parse_result(plain.dump()).completed());
  const NumberLayout layout(plain, {"relative_viscosity"});
  EXPECT_EQ(layout.observation(0, layout.numbers(plain)).value, 12.5);
  EXPECT_TRUE(std::isnan(layout.numbers(plain).at(1)));  // no control variate
}

TEST(RealisationResult, IsKeptAsItIsWrittenButForWhiteSpace) {
  Json result = plain_result(point, 3, 12.5);
  result["ending"]["message"] = R"(a \ " and a \" , : [)";
  const std::string compact = result.dump();
  for (const int indent : {0, 1, 8})
    EXPECT_EQ(parse_result(result.dump(indent) + "\r\n\t").text, compact) << indent;
  std::string other = compact;
  other.replace(other.find("12.5"), 4, "125.0E-1");
  EXPECT_EQ(parse_result(other).text, other);
}

TEST(RealisationResult, RefusesTextThatIsNotJsonOrNotFinite) {
  const std::string whole = plain_result(point, 3, 12.5).dump();
  std::string infinite = whole;
  infinite.replace(infinite.find("12.5"), 4, "1e999");
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), whole + "x", infinite,
                                  std::string("{\"schema_version\": NaN}")}) {
    EXPECT_THROW(parse_result(text), ResultError) << text.substr(0, 60);
  }
}

TEST(RealisationResult, RepetitionsMayDifferInCostMachineAndPlaceOnly) {
  const auto hash = [](const Json& result) { return parse_result(result.dump()).content_sha256; };
  const Json first = plain_result(point, 3, 12.5);
  Json again = first;
  again["cost"] = {{"cpu_seconds", 9.0}, {"wall_seconds", 99.0}};
  again["engine"]["cpu"] = "another";
  EXPECT_EQ(hash(first), hash(again));
  again["mean"]["relative_viscosity"] = 12.500000000000002;
  EXPECT_NE(hash(first), hash(again));
}

}  // namespace
}  // namespace peclet::runner
