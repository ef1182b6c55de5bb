// Species of a scene chosen from a measured table, and tables as instruments, spreadsheets and people save
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "contract/durable_file.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/schedule.h"
#include "engine/scene/measured_sizes.h"
#include "tests/contract/refusal.h"
#include "tests/engine/small_scene.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// Fourteen sieves, with tails below a percent of the volume.
const char* const sieves =
    "0.5 0.05\n0.6 0.3\n0.7 1.2\n0.8 4\n0.9 9.5\n1.0 16\n1.1 20.5\n1.2 19.3\n1.3 14\n"
    "1.4 8.3\n1.5 4.2\n1.6 1.8\n1.7 0.6\n1.8 0.25\n";

class SizeChoice : public testing::Test {
 protected:
  WrittenKeys answer(std::size_t count, const char* text = sieves, const char* sizes = "radius") const {
    write_durably(folder_ / "s.txt", text);
    return choose_sizes({.file = (folder_ / "s.txt").string(),
                         .sizes = sizes,
                         .shares = "volume",
                         .columns = "",
                         .count = count});
  }
  static Json distribution(const WrittenKeys& answer) {
    return Json::parse("{" + answer.block + "}").at("species")[0].at("distribution");
  }
  // Returns the refusal of a scene with these species and this many spheres, or nothing.
  static std::string fault_of(const WrittenKeys& answer, std::size_t count) {
    Json scene = small_scene();
    scene["particles"]["species"] = Json::parse("{" + answer.block + "}").at("species");
    scene["particles"]["count"] = count;
    scene["integrator"] = {{"method", "implicit"}};  // any sizes
    return refusal_by([&] {
      const Scene read = read_scene(scene, "scene.json");
      check_fit(read, make_schedule(read, "scene.json"), "scene.json");
    });
  }

  TemporaryFolder folder_;
};

TEST_F(SizeChoice, OfAllSizesSaysTheCountThatAScenePasses) {
  const WrittenKeys all = answer(0);
  EXPECT_EQ(distribution(all).at("radii").size(), 14U);
  std::size_t size = 0, spheres = 0;
  std::sscanf(all.remarks.c_str() + all.remarks.find('\n'), "%zu %zu", &size, &spheres);
  EXPECT_EQ(size, 14U) << all.remarks;
  // The rarest size, of the largest radius, has one sphere.
  double sum = 0;
  std::istringstream table(sieves);
  for (double radius = 0, share = 0; table >> radius >> share;) sum += share / std::pow(radius, 3);
  EXPECT_NEAR(static_cast<double>(spheres), sum * std::pow(1.8, 3) / 0.25, 1);
  for (const std::size_t count : {spheres, spheres + 1, spheres + 100, 2 * spheres})
    EXPECT_EQ(fault_of(all, count), "");
  EXPECT_TRUE(contains(fault_of(all, 60), std::to_string(spheres) + " would do for all sizes"));
}

TEST_F(SizeChoice, MergesThinSizesUntilEachHasASphere) {
  for (const std::size_t count : {1U, 20U, 300U, 1000U}) {
    const WrittenKeys some = answer(count);
    // Few spheres make too small a box for a scene; one size exists at any count.
    EXPECT_EQ(fault_of(some, count == 1 ? 60 : count), "") << some.block;
    // Number and volume of all spheres are those of the table: the mean of a^-3 over the volume, inverted.
    double number = 0, volume = 0, expected = 0, whole = 0;
    const Json found = distribution(some);
    for (std::size_t i = 0; i < found["radii"].size(); ++i) {
      volume += found["shares"][i].get<double>();
      number += found["shares"][i].get<double>() / std::pow(found["radii"][i].get<double>(), 3);
    }
    std::istringstream table(sieves);
    for (double radius = 0, share = 0; table >> radius >> share;) {
      whole += share;
      expected += share / std::pow(radius, 3);
    }
    EXPECT_NEAR(number / volume, expected / whole, 1e-5 * expected / whole);
  }
  EXPECT_EQ(distribution(answer(1)).at("radii").size(), 1U);
  EXPECT_LT(distribution(answer(300)).at("radii").size(), distribution(answer(1000)).at("radii").size());
}

TEST_F(SizeChoice, KnowsDiameters) {
  EXPECT_EQ(
      distribution(answer(0, "2;30\n2,8;70\n", "diameter")),
      Json::parse(R"({"form": "histogram", "by": "volume", "radii": [1.0, 1.4], "shares": [30.0, 70.0]})"));
}

// By volume 1 : 8 at radii 1 and 2 are equal numbers, of the mean 1.5.
TEST_F(SizeChoice, GivesTheMeanRadiusByNumberAsReference) {
  EXPECT_EQ(Json::parse("{" + answer(0, "1 1\n2 8\n").block + "}").at("reference_radius"), 1.5);
}

TEST(SizeClasses, OfTheThinnestAreMergedWithTheThinnerNeighbour) {
  const std::vector<SizeClass> merged = with_one_size_less({{1, 0.6}, {2, 0.1}, {3, 0.3}});
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].radius, 1);
  EXPECT_DOUBLE_EQ(merged[1].number, 0.4);
  EXPECT_DOUBLE_EQ(std::pow(merged[1].radius, 3), (0.1 * 8 + 0.3 * 27) / 0.4);
  EXPECT_DOUBLE_EQ(with_one_size_less({{1, 0.1}, {2, 0.9}})[0].number, 1);
  EXPECT_DOUBLE_EQ(with_one_size_less({{1, 0.9}, {2, 0.1}})[0].number, 1);
}

std::string text_of(const std::vector<MeasuredSize>& sizes) {
  std::string text;
  for (const MeasuredSize& one : sizes)
    text += std::to_string(one.size).substr(0, 4) + " " + std::to_string(one.share).substr(0, 4) + "; ";
  return text;
}

TEST(MeasuredSizes, AreReadInEveryDialect) {
  for (const char* text : {
           "1.0 10\n1.4 20\n",
           "1.4 20\n1.0 10",  // descending
           "\xef\xbb\xbf"
           "1.0 10\r\n1.4 20\r\n\r\n",
           "Size;Share\n1,0;10\n1,4;20\n",  // a spreadsheet with decimal commas
           "\"1,0\";\"10\"\n\"1,4\";\"20\"",
           "Instrument 7\nSample: No. 3\nd [um]\tq3 [%]\n\n1,0\t10\n1,4\t20\n", "1.0,10\n1.4,20\n",
           "1.0, 10\n1.4, 20\n", "1.0;10;\n1.4;20;\n", "+1,0 10\n1,4 +20,0\n",
           "0.9 0\n1.0 10\n1.4 20\n1.6 0\n",  // empty classes
       }) {
    EXPECT_EQ(text_of(measured_sizes(text, "s.txt")), "1.00 10.0; 1.40 20.0; ") << text;
  }
  EXPECT_EQ(text_of(measured_sizes("a;b;c\n5;1;10\n15;1,4;20", "s.txt", {2, 3})), "1.00 10.0; 1.40 20.0; ");
}

TEST(MeasuredSizes, ThatAreNotPlainAreRefused) {
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "s.txt: must have a line of a size and its share"},
           {"size share\n", "must have a line of a size"},
           {"1 0\n2 0\n", "must have a line of a size"},
           {"1 10\n2\n", "line 2: \"2\": must be a size and its share"},
           {"1,5,20\n", "line 1: \"1,5,20\": has 3 columns: --columns must name"},
           {"x;y;z\n1;2;3\n", "line 2: \"1;2;3\": has 3 columns"},
           {"1 10\n-2 10\n", "line 2: \"-2 10\": must have a size > 0"},
           {"1 10\n2 -10\n", "must have a share >= 0"},
           {"1 10\n2 1e999\n", "must have a share >= 0"},
           {"1 10\nTotal 10\n", "line 2: \"Total 10\": must have a size > 0"},
           {"1.000,5;10\n", "must have a size > 0"},
           {"1 10\n1.0 20\n", "size 1: must be there once"},
           {"1 0\n2 40\n3 100\n", "as those of a cumulative curve"},
           {"1 1\n2 0.4\n3 0\n", "as those of a cumulative curve"}}) {
    EXPECT_TRUE(contains(refusal_by([&text = text] { measured_sizes(text, "s.txt"); }), reason)) << text;
  }
}

}  // namespace
}  // namespace peclet::engine
