// How good the predictions of `peclet plan --pilot` were.
#pragma once

#include <string>

#include "contract/json.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {

// One line for all points; nothing when there is no prediction.
//
// "predictions: 2 of 2 points within their range; 43 seeds (37 expected), processor time 12 s (10 s); open 1:
// 20 seeds, 5 s to come"
std::string predictions_text(const std::vector<PointSummary>& points);

// A line for one point; nothing without a prediction.
std::string prediction_text(const PointSummary& point);

// null without a prediction.
Json prediction_json(const PointSummary& point);

}  // namespace peclet::runner
