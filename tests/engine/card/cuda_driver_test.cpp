// Where there is no card, programs say why. tests/device/check.sh tests the rest on a machine with a card.
#include "engine/card/cuda_driver.h"

#include <gtest/gtest.h>

namespace peclet::engine {
namespace {

// Returns what making a card says.
std::string refusal_of_card(int ordinal) {
  try {
    const Card card(ordinal);
    return "";
  } catch (const CardError& error) {
    return error.what();
  }
}

TEST(CudaDriver, SaysInOneSentenceWhyThereIsNoCard) {
  const std::optional<std::string> reason = why_no_card();
  EXPECT_EQ(refusal_of_card(0), reason.value_or(""));
  EXPECT_EQ(why_no_card(), reason);  // a second look finds the same
  if (!reason) return;               // this machine has a card
  EXPECT_GT(reason->size(), 10u);
  EXPECT_EQ(reason->find('\n'), reason->npos);
}

TEST(CudaDriver, RefusesACardThatThereIsNot) { EXPECT_NE(refusal_of_card(1000), ""); }

}  // namespace
}  // namespace peclet::engine
