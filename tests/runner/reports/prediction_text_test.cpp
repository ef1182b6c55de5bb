// Tests the texts that compare predictions with the actual numbers.
#include <gtest/gtest.h>

#include "runner/reports/status.h"

namespace peclet::runner {
namespace {

PointSummary summary(bool decided, int wanted, int wanted_ended, double seconds) {
  PointSummary point;
  point.decided = decided;
  point.wanted = wanted;
  point.wanted_ended = wanted_ended;
  point.wanted_cpu_seconds = seconds;
  return point;
}

// Adds a prediction of 16 (8 .. 35) seeds of 2.5 s.
PointSummary predicted(PointSummary point) {
  point.prediction = StoredPrediction{4, {16, 8, 35}, 2.5, "2026-01-01T00:00:00Z"};
  return point;
}

TEST(PredictionText, ComparesDecidedPointsWithWhatWasExpected) {
  EXPECT_EQ(predictions_text({predicted(summary(true, 20, 20, 48)), predicted(summary(true, 44, 44, 100)),
                              summary(true, 1000, 1000, 1000)}),
            "predictions: 1 of 2 points within their range; 64 seeds (32 expected), processor time 2 min (80 "
            "s expected)\n");
}

TEST(PredictionText, OpenPointsHaveSeedsToCome) {
  EXPECT_EQ(predictions_text({predicted(summary(false, 10, 4, 10))}),
            "predicted for the open points (1): 12 seeds and 30 s of processor time to come\n");
  // More seeds are wanted than were predicted: those that the next stop test lacks are to come.
  EXPECT_EQ(predictions_text({predicted(summary(false, 22, 18, 45))}),
            "predicted for the open points (1): 4 seeds and 10 s of processor time to come\n");
}

TEST(PredictionText, IsNothingWithoutPredictions) {
  EXPECT_EQ(predictions_text({summary(true, 20, 20, 48)}), "");
  EXPECT_EQ(prediction_text(summary(true, 20, 20, 48)), "");
  EXPECT_TRUE(prediction_json(summary(true, 20, 20, 48)).is_null());
}

TEST(PredictionText, TheEndsBelongToTheRange) {
  for (const auto& [seeds, within] : {std::pair{7, false}, {8, true}, {35, true}, {36, false}}) {
    const PointSummary point = predicted(summary(true, seeds, seeds, 30));
    EXPECT_EQ(prediction_json(point)["within_range"], within) << seeds;
    EXPECT_EQ(prediction_text(point).find("outside that range") == std::string::npos, within) << seeds;
  }
}

}  // namespace
}  // namespace peclet::runner
