// Tests the points of a sweep and their labels.
#include "runner/campaign/sweep.h"

#include <gtest/gtest.h>

#include "contract/sha256.h"

namespace peclet::runner {
namespace {

const Json scene = Json::parse(
    R"({"fluid": {"viscosity": 1}, "species": [{"radius": 1}, {"radius": 1.4}], "volume_fraction": 0.5})");

std::vector<StatePoint> points(const char* sweep) {
  return sweep_points(scene, read_sweep(Json::parse(sweep), "campaign.json"), "flow-curve", "campaign.json");
}

std::vector<std::string> labels(const char* sweep) {
  std::vector<std::string> found;
  for (const StatePoint& point : points(sweep)) found.push_back(point.label);
  return found;
}

TEST(Sweep, AGridVariesItsLastEntryFastest) {
  EXPECT_EQ(
      labels(R"([{"set": "/peclet", "values": [1, 10]}, {"set": "/volume_fraction", "values": [0.4, 0.5]}])"),
      (std::vector<std::string>{"peclet=1 volume_fraction=0.4", "peclet=1 volume_fraction=0.5",
                                "peclet=10 volume_fraction=0.4", "peclet=10 volume_fraction=0.5"}));
}

TEST(Sweep, PointersOfOneEntryAreSetInStep) {
  const std::vector<StatePoint> found =
      points(R"([{"set": ["/peclet", "/volume_fraction"], "values": [[1, 0.4], [10, 0.3]]}])");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].scene["peclet"], 10);
  EXPECT_EQ(found[1].scene["volume_fraction"], 0.3);
  EXPECT_EQ(found[1].settings, Json::parse(R"({"/peclet": 10, "/volume_fraction": 0.3})"));
  EXPECT_EQ(found[1].label, "peclet=10 volume_fraction=0.3");
}

// The expected values are those of numpy.geomspace and numpy.linspace, to six digits.
TEST(Sweep, ARangeIsTheListOfItsValues) {
  Json sweep = Json::parse(R"([
    {"set": "/peclet", "values": {"from": 0.01, "to": 1e4, "points": 5, "spaced": "log"}},
    {"set": "/contact/friction", "values": {"from": 1, "to": 0, "points": 4, "spaced": "linear"}},
    {"set": "/volume_fraction", "values": [0.4]},
    {"set": "/flow/uniaxial_rate", "values": {"from": -2, "to": 0.4, "points": 7, "spaced": "linear"}},
    {"set": "/fluid/viscosity", "values": {"from": 1e-200, "to": 1e200, "points": 3, "spaced": "log"}}])");
  sweep = without_ranges(sweep, "campaign.json");
  EXPECT_EQ(sweep[0]["values"].dump(), "[0.01,0.316228,10,316.228,10000.0]");
  EXPECT_EQ(sweep[1]["values"].dump(), "[1,0.666667,0.333333,0]");
  EXPECT_EQ(sweep[2]["values"].dump(), "[0.4]");
  EXPECT_EQ(sweep[3]["values"], Json::parse("[-2, -1.6, -1.2, -0.8, -0.4, 0, 0.4]"));
  EXPECT_EQ(sweep[4]["values"][1], 1);
}

TEST(Sweep, MissingObjectsAreMadeAndElementsOfArraysAreFound) {
  const std::vector<StatePoint> found =
      points(R"([{"set": ["/limits/shear_rate", "/species/1/radius"], "values": [[0.009, 2]]}])");
  EXPECT_EQ(found[0].scene["limits"], Json::parse(R"({"shear_rate": 0.009})"));
  EXPECT_EQ(found[0].scene["species"], Json::parse(R"([{"radius": 1}, {"radius": 2}])"));
}

TEST(Sweep, EscapedKeysAreReadAsRfc6901Says) {
  EXPECT_EQ(points(R"([{"set": "/a~1b/m~0n", "values": [3]}])")[0].scene["a/b"]["m~n"], 3);
}

TEST(Sweep, NothingButWhatIsSetDiffersFromTheScene) {
  Json expected = scene;
  expected["peclet"] = 5;
  const StatePoint point = points(R"([{"set": "/peclet", "values": [5]}])")[0];
  EXPECT_EQ(point.scene, expected);
  EXPECT_EQ(point.hash, sha256(canonical_json(expected)));
}

/// The expected hash is that of coreutils' sha256sum for
/// {"fluid":{"viscosity":1},"peclet":5,"species":[{"radius":1},{"radius":1.4}],"volume_fraction":0.5}
TEST(Sweep, TheHashIsThatOfTheCanonicalText) {
  EXPECT_EQ(points(R"([{"set": "/peclet", "values": [5.0]}])")[0].hash,
            "0012771b251d2d6200575c815f2ea200fa8553d2a032df0bc5920602fdb96973");
}

TEST(Sweep, ACampaignWithoutOneHasOnePointOfItsOwnName) {
  const std::vector<StatePoint> found = points("[]");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].scene, scene);
  EXPECT_EQ(found[0].settings, Json::object());
  EXPECT_EQ(found[0].label, "flow-curve");
}

TEST(Sweep, EqualLastStepsAndBareIndicesAreLabelledWithTheWholePointer) {
  EXPECT_EQ(labels(R"([{"set": ["/species/0/radius", "/species/1/radius"], "values": [[1, 2]]}])")[0],
            "/species/0/radius=1 /species/1/radius=2");
  EXPECT_EQ(labels(R"([{"set": "/species/0", "values": [{"radius": 3}]}])")[0], "/species/0={\"radius\":3}");
}

TEST(Sweep, HasACurveForEachValueOfTheOtherEntries) {
  const std::vector<SweepEntry> sweep = read_sweep(Json::parse(R"([
      {"set": "/a", "values": [10, 20]}, {"set": ["/x", "/w"], "values": [[4, 0], [1, 0], [2, 1], [3, 1]]},
      {"set": "/b", "values": ["p", "q"]}])"),
                                                   "f");
  const std::vector<Curve> curves = curves_over("/x", Json::object(), sweep, "f", "/target/curve/over");
  ASSERT_EQ(curves.size(), 4);
  EXPECT_EQ(curves[0].points, (std::vector<std::size_t>{0, 2, 4, 6}));
  EXPECT_EQ(curves[0].axis, (std::vector<double>{4, 1, 2, 3}));
  EXPECT_EQ(curves[1].points, (std::vector<std::size_t>{1, 3, 5, 7}));
  EXPECT_EQ(curves[3].points, (std::vector<std::size_t>{9, 11, 13, 15}));
  EXPECT_EQ(curves[0].spheres, (std::vector<double>{1, 1, 1, 1}));
}

TEST(Sweep, KnowsTheSpheresOfThePointsOfACurve) {
  const Json base = {{"particles", {{"count", 50}}}};
  const auto spheres = [&](const char* text) {
    return curves_over("/x", base, read_sweep(Json::parse(text), "f"), "f", "/target/curve/over")[0].spheres;
  };
  EXPECT_EQ(spheres(R"([{"set": "/x", "values": [1, 2, 3, 4]}])"), (std::vector<double>{50, 50, 50, 50}));
  EXPECT_EQ(spheres(R"([{"set": ["/x", "/particles/count"], "values": [[1, 9], [2, 8], [3, 7], [4, 6]]}])"),
            (std::vector<double>{9, 8, 7, 6}));
  EXPECT_EQ(
      spheres(R"([{"set": "/x", "values": [1, 2, 3, 4]}, {"set": "/particles", "values": [{"count": 5}]}])"),
      (std::vector<double>{5, 5, 5, 5}));
}

TEST(Sweep, LongValuesAreLabelledByTheirPlace) {
  EXPECT_EQ(labels(R"([{"set": "/lubrication", "values": [
                       {"form": "kim-karrila", "inner_gap": 0.001}, {"form": "kim-karrila", "inner_gap": 0.01}]}])"),
            (std::vector<std::string>{"lubrication=#1", "lubrication=#2"}));
}

}  // namespace
}  // namespace peclet::runner
