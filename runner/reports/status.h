// The verb `peclet status`: how far every point is, and with what result so far.
#pragma once

#include <cstdint>
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
  std::vector<HandedOver> handed_over;     // seeds in the hands of a batch system, by job
  std::optional<std::int64_t> owner;       // process that runs it now
  // With the workers of the last run; nothing before a seed has ended, and where a batch system has seeds.
  std::optional<TimeToGo> to_go{};
};

// `owner`: the process that runs it now.
CampaignStatus read_status(Database& database, std::optional<std::int64_t> owner = std::nullopt);

// What all points have together.
struct CampaignTotals {
  int decided = 0, workers = 0;
  int ended = 0, running = 0, lost = 0, extra = 0, handed_over = 0;  // seeds
  double cpu_seconds = 0;
  std::map<std::string, int> states;  // points by state_word()
  std::map<std::string, int> losses;  // seeds by cause
};
CampaignTotals totals_of(const CampaignStatus& status);

// 0 every point converged or complete; 3 decided, but some capped, failed, cancelled or with losses; 4 not
// finished; 6 some point is suspect: a seed gave two different results.
int exit_code_of(const CampaignStatus& status);
// The exit code of a process that has run it: exit_code_of(), or 75 when it did not finish what it was to do.
int ending(const CampaignStatus& status, bool finished);

// "3 points: 1 capped, 2 open"
std::string point_totals(const CampaignStatus& status);

// The verdict in a word; "open" or "cancelled" without one.
std::string state_word(const PointSummary& point);

// "converged", "converged-with-losses(2)", "complete", "capped, 2 lost", "failed, 10 lost", "open"; "open,
// suspect"; "cancelled".
std::string verdict_text(const PointSummary& point);
// What speaks against its estimate: "jammed", "transient", "no-transient-test", "skewed", "near-maximum",
// "equal-values", "repeated-seeds", "2 flagged timestep", "suspect"; and "earlier-stop-test" where a target
// that was loosened is met by an earlier stop test than there are seeds for.
std::vector<std::string> reservations(const PointSummary& point);

// The table and its totals; as the process that owns the campaign prints them at the end. In few columns of a
// terminal it does without what matters least; the verdict is always whole.
std::string status_table(const CampaignStatus& status, std::size_t width = unlimited_width);
// Who runs it and how far the workers are; nothing when the campaign is decided and nobody runs it.
std::string workers_text(const CampaignStatus& status, std::size_t width = unlimited_width);
Json status_json(const CampaignStatus& status);
// [{"engine", "results"}]
Json to_json(const std::vector<SetAside>& results);

// How good the predictions of `peclet plan --pilot` were.
//
// One line for all points; nothing when there is no prediction.
//
// "predictions: 2 of 2 points within their range; 43 seeds (37 expected), processor time 12 s (10 s); open 1:
// 20 seeds, 5 s to come"
std::string predictions_text(const std::vector<PointSummary>& points);

// A line for one point; nothing without a prediction.
std::string prediction_text(const PointSummary& point);

// null without a prediction.
Json prediction_json(const PointSummary& point);
// {"expected", "lower", "upper"}
template <typename Number>
Json range_json(const Expected<Number>& range) {
  return {{"expected", range.likely}, {"lower", range.lower}, {"upper", range.upper}};
}

// A curve in lines of text, for terminals.
//
// The mean so far over the swept parameter that has the most values, a line for each combination of the
// others
// ("volume_fraction=0.45  ▁▁▂▂▄▄  5.39 to 8.52"), all on one scale, logarithmic where the means span a factor
// of five; a dot where there is no mean yet, × where the point has jammed. "" where there are fewer than
// three numbers to draw, or where the lines are longer than `width`.
std::string curve_text(const CampaignStatus& status, std::size_t width);

}  // namespace peclet::runner
