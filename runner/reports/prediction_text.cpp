#include "runner/reports/prediction_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "runner/campaign/number_text.h"

namespace peclet::runner {
namespace {

// Seeds that an open point still needs, if it needs as many as expected; its next look in any case.
int seeds_to_come(const PointSummary& point) {
  return std::max(point.wanted, point.prediction->seeds.likely) - point.wanted_ended;
}

}  // namespace

std::string predictions_text(const std::vector<PointSummary>& points) {
  int decided = 0, within = 0, seeds = 0, expected_seeds = 0, open = 0, to_come = 0;
  double seconds = 0, expected_seconds = 0, seconds_to_come = 0;
  for (const PointSummary& point : points) {
    if (!point.prediction) continue;
    if (point.decided) {
      ++decided;
      within += point.prediction->holds(point.wanted) ? 1 : 0;
      seeds += point.wanted;
      expected_seeds += point.prediction->seeds.likely;
      seconds += point.wanted_cpu_seconds;
      expected_seconds += point.prediction->likely_cpu_seconds();
    } else {
      ++open;
      to_come += seeds_to_come(point);
      seconds_to_come += seeds_to_come(point) * point.prediction->cpu_seconds;
    }
  }
  std::string text;
  if (decided > 0) {
    text = fmt::format(
        "predictions: {} of {} within {} range; {} seeds ({} expected), processor time {} ({} expected)\n",
        within, decided, decided == 1 ? "its" : "their", seeds, expected_seeds, duration_text(seconds),
        duration_text(expected_seconds));
  }
  if (open > 0) {
    text += fmt::format("predicted for {} open: {} seeds and {} of processor time to come\n", open, to_come,
                        duration_text(seconds_to_come));
  }
  return text;
}

std::string prediction_text(const PointSummary& point) {
  if (!point.prediction) return "";
  const StoredPrediction& made = *point.prediction;
  const std::string expected = fmt::format("  predicted from {} seeds: {} ({} .. {}), processor time {}",
                                           made.pilot, made.seeds.likely, made.seeds.lower, made.seeds.upper,
                                           duration_text(made.likely_cpu_seconds()));
  if (!point.decided) {
    return expected + fmt::format("; {} and {} to come\n", seeds_to_come(point),
                                  duration_text(seeds_to_come(point) * made.cpu_seconds));
  }
  return expected + fmt::format("; it took {}, {} that range, and {}\n", point.wanted,
                                made.holds(point.wanted) ? "within" : "outside",
                                duration_text(point.wanted_cpu_seconds));
}

Json prediction_json(const PointSummary& point) {
  if (!point.prediction) return nullptr;
  const StoredPrediction& made = *point.prediction;
  Json json{
      {"made_at", made.made_at},
      {"pilot", made.pilot},
      {"seeds", {{"expected", made.seeds.likely}, {"lower", made.seeds.lower}, {"upper", made.seeds.upper}}},
      {"cpu_seconds", made.likely_cpu_seconds()},
      {"within_range", nullptr},
      {"taken", nullptr},
      {"to_come", nullptr}};
  if (point.decided) {
    json["within_range"] = made.holds(point.wanted);
    json["taken"] = {{"seeds", point.wanted}, {"cpu_seconds", point.wanted_cpu_seconds}};
  } else {
    json["to_come"] = {{"seeds", seeds_to_come(point)},
                       {"cpu_seconds", seeds_to_come(point) * made.cpu_seconds}};
  }
  return json;
}

}  // namespace peclet::runner
