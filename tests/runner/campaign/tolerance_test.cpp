#include "runner/campaign/tolerance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contract/input_error.h"

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

TEST(Tolerance, IsWrittenAsItIsRead) {
  for (const char* const text : {R"({"relative_tolerance":0.05})", R"({"absolute_tolerance":12.5})",
                                 R"({"relative_to":"pressure","relative_tolerance":0.05})"}) {
    EXPECT_EQ(to_json(tolerance_of(Json::parse(text))).dump(), text);
  }
  EXPECT_EQ(to_string(Tolerance(0.05)), "5 %");
  EXPECT_EQ(to_string(Tolerance::absolute(12.5)), "12.5");
  EXPECT_THROW(tolerance_of(Json::parse(R"({"tolerance": 1})")), InputError);
  const Json measured = Json::parse(R"({"relative_to":"pressure","relative_tolerance":0.05})");
  EXPECT_EQ(to_string(tolerance_of(measured)), "5 % of pressure");
}

}  // namespace
}  // namespace peclet::runner
