// The programs of the card that this build has packed.
#include "engine/card/card_ptx.h"

#include <gtest/gtest.h>

#include "contract/sha256.h"

namespace peclet::engine {
namespace {

#ifdef PECLET_CARD_COMPILER
TEST(CardPtx, OfEachVariantIsAKernelWithoutOpenCalls) {
  for (unsigned variant = 0; variant < PECLET_CARD_VARIANTS; ++variant) {
    const std::string_view ptx = card_ptx(variant);
    EXPECT_NE(ptx.find(".visible .entry advance("), ptx.npos) << variant;
    EXPECT_EQ(ptx.find(".extern .func"), ptx.npos) << variant;
    EXPECT_TRUE(ptx.ends_with("}\n")) << variant;
    EXPECT_EQ(*ptx.end(), '\0');
  }
}

TEST(CardPtx, HasOneHashForAllVariants) {
  std::string all;
  for (unsigned variant = 0; variant < PECLET_CARD_VARIANTS; ++variant) all += card_ptx(variant);
  EXPECT_EQ(card_ptx_sha256(), sha256(all));
}
#else
TEST(CardPtx, IsAbsentWithoutClang) {
  EXPECT_EQ(card_ptx(0), "");
  EXPECT_EQ(card_ptx_sha256(), "");
}
#endif

TEST(CardPtx, IsEmptyForAVariantThatThereIsNot) { EXPECT_EQ(card_ptx(PECLET_CARD_VARIANTS), ""); }

}  // namespace
}  // namespace peclet::engine
