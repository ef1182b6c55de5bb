#include <gtest/gtest.h>

#include "contract/text.h"

namespace peclet {
namespace {

const std::vector<std::string> keys{"particles", "volume_fraction", "fluid", "flow", "contact"};

TEST(NearestName, IsTheOneWithFewestMistakes) {
  EXPECT_EQ(nearest_name("volume_fracton", keys), "volume_fraction");    // a letter is missing
  EXPECT_EQ(nearest_name("volume_fractionn", keys), "volume_fraction");  // one too many
  EXPECT_EQ(nearest_name("partikles", keys), "particles");               // a wrong one
  EXPECT_EQ(nearest_name("contcat", keys), "contact");                   // two swapped
  EXPECT_EQ(nearest_name("flwo", keys), "flow");                         // one mistake, a third of 4 letters
  EXPECT_EQ(nearest_name("run", {"ran", "rum"}), "ran");                 // first of equals
}

TEST(NearestName, NothingFarFetchedIsOffered) {
  EXPECT_EQ(nearest_name("seeds", keys), "");
  EXPECT_EQ(nearest_name("fl", keys), "");
  EXPECT_EQ(nearest_name("", keys), "");
  EXPECT_EQ(nearest_name("flow", {}), "");
  EXPECT_EQ(suggestion("seeds", keys), "");
  EXPECT_EQ(suggestion("fliud", keys), "; did you mean fluid?");
}

}  // namespace
}  // namespace peclet
