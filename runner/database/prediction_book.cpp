#include "runner/database/prediction_book.h"

#include "runner/statistics/prediction.h"

namespace peclet::runner {

std::map<std::int64_t, StoredPrediction> stored_predictions(Connection& connection) {
  Statement query(connection,
                  "SELECT point_id, pilot, seeds, lower, upper, cpu_seconds, made_at FROM prediction WHERE "
                  "target_id = (SELECT target_id FROM campaign)");
  std::map<std::int64_t, StoredPrediction> stored;
  while (query.step()) {
    const auto number = [&](int column) { return static_cast<int>(query.integer(column)); };
    stored[query.integer(0)] = {number(1), {number(2), number(3), number(4)}, query.real(5), query.text(6)};
  }
  return stored;
}

void store_prediction(Connection& connection, std::int64_t point, const Prediction& prediction,
                      double cpu_seconds) {
  Statement(connection,
            "INSERT OR IGNORE INTO prediction (point_id, target_id, made_at, pilot, seeds, lower, upper, "
            "cpu_seconds) SELECT ?, target_id, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ? FROM "
            "campaign")
      .bind(point)
      .bind(prediction.pilot)
      .bind(prediction.seeds.likely)
      .bind(prediction.seeds.lower)
      .bind(prediction.seeds.upper)
      .bind(cpu_seconds)
      .run();
}

}  // namespace peclet::runner
