// Predictions that were stored before the seeds came, to be judged by what became of them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "runner/database/sqlite.h"
#include "runner/statistics/expected.h"

namespace peclet::runner {

struct Prediction;

struct StoredPrediction {
  int pilot = 0;           // seeds that it was made from
  Expected<int> seeds;     // of the deciding look
  double cpu_seconds = 0;  // of one seed
  std::string made_at;

  double likely_cpu_seconds() const { return seeds.likely * cpu_seconds; }
  bool holds(int decided_after) const { return seeds.lower <= decided_after && decided_after <= seeds.upper; }
};

// Those for the present target, by PointRecord::id.
std::map<std::int64_t, StoredPrediction> stored_predictions(Connection& connection);

// Keeps the first prediction of a point for the present target: one that knows more is no test of the first.
// Requires a Transaction of the caller and a prediction without an obstacle.
void store_prediction(Connection& connection, std::int64_t point, const Prediction& prediction,
                      double cpu_seconds);

}  // namespace peclet::runner
