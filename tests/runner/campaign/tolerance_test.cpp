#include "runner/campaign/tolerance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contract/errors.h"

namespace peclet::runner {
namespace {

TEST(Tolerance, IsAShareOfTheMeanOrANumberOfItsOwn) {
  const Tolerance share = 0.05;
  EXPECT_DOUBLE_EQ(share.half_width(-8), 0.4);
  EXPECT_DOUBLE_EQ(share.share(0.2, -8), 0.5);
  EXPECT_TRUE(std::isinf(share.share(0.2, 0)));
  const Tolerance number = Tolerance::absolute(0.4);
  EXPECT_EQ(number.half_width(0), 0.4);
  EXPECT_DOUBLE_EQ(number.share(0.2, 0), 0.5);
}

// 5 % of 8 is 0.4, above the floor of 0.1. 5 % of 1 is below it.
TEST(Tolerance, OfASmallMeanHasAFloor) {
  Tolerance tolerance = 0.05;
  EXPECT_TRUE(tolerance.needs_a_mean());
  tolerance.floor = 0.1;
  EXPECT_FALSE(tolerance.needs_a_mean());
  EXPECT_DOUBLE_EQ(tolerance.half_width(8), 0.4);
  EXPECT_DOUBLE_EQ(tolerance.half_width(-1), 0.1);
  EXPECT_DOUBLE_EQ(tolerance.share(0.2, 8), 0.5);
  EXPECT_DOUBLE_EQ(tolerance.share(0.2, 1), 2);
  EXPECT_DOUBLE_EQ(tolerance.share(0.2, 0), 2);
  EXPECT_EQ(width_text(tolerance, 0.2, 8), "2.5 %");
  EXPECT_EQ(width_text(tolerance, 0.2, 1), "0.2");
  EXPECT_EQ(to_string(tolerance), "5 % or 0.1");
}

TEST(Tolerance, IsWrittenAsItIsRead) {
  for (const char* const text : {R"({"relative_tolerance":0.05})", R"({"absolute_tolerance":12.5})",
                                 R"({"relative_to":"pressure","relative_tolerance":0.05})",
                                 R"({"absolute_floor":0.1,"relative_tolerance":0.05})",
                                 R"({"curve":{"over":"/peclet","relative_tolerance":0.05}})",
                                 R"({"curve":{"even":true,"over":"/peclet","relative_tolerance":0.05}})"}) {
    EXPECT_EQ(to_json(tolerance_of(Json::parse(text))).dump(), text);
  }
  EXPECT_EQ(to_string(Tolerance(0.05)), "5 %");
  EXPECT_EQ(to_string(Tolerance::absolute(12.5)), "12.5");
  EXPECT_EQ(tolerance_of(to_json(Tolerance::none())).kind, Tolerance::Kind::none);
  EXPECT_THROW(tolerance_of(Json::parse(R"({"absolute_tolerance": "wide"})")), Json::exception);
  const Json measured = Json::parse(R"({"relative_to":"pressure","relative_tolerance":0.05})");
  EXPECT_EQ(to_string(tolerance_of(measured)), "5 % of pressure");
  const Json along = Json::parse(R"({"curve":{"over":"/peclet","relative_tolerance":0.05}})");
  EXPECT_EQ(to_string(tolerance_of(along)), "5 % along /peclet");
  EXPECT_STREQ(key_of(tolerance_of(along)), "curve/relative_tolerance");
}

}  // namespace
}  // namespace peclet::runner
