// Implements the verb `peclet status`: the progress and the present result of every point.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/text_table.h"
#include "runner/store/bundle_store.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {

struct CampaignStatus {
  CampaignRecord campaign;
  std::vector<PointSummary> points;
  std::vector<PointForecast> forecasts{};  // of each point
  std::vector<HandedOver> handed_over;     // seeds that a batch system has, by job
  std::optional<std::int64_t> owner;       // process that runs the campaign now
  // The time with the workers of the last run; none before a seed has ended, or if a batch system has seeds.
  std::optional<TimeToGo> to_go{};
};

// Reads the status of a campaign that the process `owner` runs now, if any.
CampaignStatus read_status(Database& database, std::optional<std::int64_t> owner = std::nullopt);

// The sums over all points.
struct CampaignTotals {
  int decided = 0, workers = 0;
  int ended = 0, running = 0, lost = 0, extra = 0, handed_over = 0;  // seeds
  double cpu_seconds = 0;
  std::map<std::string, int> states;  // points by state_word()
  std::map<std::string, int> losses;  // seeds by cause
};
CampaignTotals totals_of(const CampaignStatus& status);

// Returns the exit code of `peclet status --check`:
//   0  every point converged or complete
//   3  every point decided or cancelled, but some capped, failed, cancelled or with losses
//   4  not finished
//   6  some point is suspect: a seed gave two different results
int exit_code_of(const CampaignStatus& status);
// Returns the exit code of a process that has run the campaign: exit_code_of(), or 75 if it did not finish.
int ending(const CampaignStatus& status, bool finished);

// Returns "3 points: 1 capped, 2 open".
std::string point_totals(const CampaignStatus& status);

// Returns the settings whose pointers are named, as in a label: "peclet=10 volume_fraction=0.5".
std::string settings_text(const Json& settings, const std::function<bool(const std::string&)>& is_named);

// Returns the verdict in a word; "open" or "cancelled" without one.
std::string state_word(const PointSummary& point);

// Returns the verdict with losses and reservations: "converged-with-losses(2)", "capped, 2 lost", "open,
// suspect".
std::string verdict_text(const PointSummary& point);
// Returns the reservations against an estimate: "jammed", "transient", "no-transient-test", "skewed",
// "near-maximum", "equal-values", "repeated-seeds", "2 flagged timestep", "suspect". "earlier-stop-test"
// means that a loosened target is met by a stop test before the largest one that was made.
std::vector<std::string> reservations(const PointSummary& point);

// Returns the table with its totals, as the owning process prints them at the end. A narrow table leaves out
// the least important columns; the verdict is always whole.
std::string status_table(const CampaignStatus& status, std::size_t width = unlimited_width);
// Returns the owner and the progress of its workers; "" if no process runs the campaign and it is finished.
std::string workers_text(const CampaignStatus& status, std::size_t width = unlimited_width);
Json status_json(const CampaignStatus& status);
// Returns [{"engine", "results"}].
Json to_json(const std::vector<SetAside>& results);

// Comparison with the predictions of `peclet plan --pilot`.

// Returns a line for the decided points with a prediction and one for the open ones; "" without predictions.
std::string predictions_text(const std::vector<PointSummary>& points);

// Returns a line for one point; "" without a prediction.
std::string prediction_text(const PointSummary& point);

// Returns null without a prediction.
Json prediction_json(const PointSummary& point);
// Returns {"expected", "lower", "upper"}.
template <typename Number>
Json range_json(const Expected<Number>& range) {
  return {{"expected", range.likely}, {"lower", range.lower}, {"upper", range.upper}};
}

// Returns a curve for terminals: the present mean over the swept parameter with the most values. Each
// combination of the other parameters has a line, "volume_fraction=0.45  ▁▁▂▂▄▄  5.39 to 8.52". All lines
// have one scale, logarithmic if the means span a factor of five. A dot marks a point without a mean, × a
// jammed one. Returns "" for fewer than three means, and if the lines are longer than `width`.
std::string curve_text(const CampaignStatus& status, std::size_t width);

}  // namespace peclet::runner
