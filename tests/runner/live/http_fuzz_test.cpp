// The short form of the fuzzer of the live server; the long one is tests/fuzz/http_fuzz.cpp.
#include <gtest/gtest.h>

#include "tests/fuzz/http_fuzzing.h"

namespace peclet::runner {
namespace {

TEST(LiveServer, AnswersWhateverIsAskedOfIt) {
  const FuzzReport report =
      fuzz_live_server(1, [](const FuzzReport& so_far) { return so_far.requests < 4000; });
  for (const std::string& finding : report.findings) ADD_FAILURE() << finding;
  EXPECT_GE(report.answers, 6U);  // of eight statuses; else it asks the same again and again
}

}  // namespace
}  // namespace peclet::runner
