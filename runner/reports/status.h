// The verb `peclet status`: how far every point is, and with what result so far.
#pragma once

#include <cstdint>
#include <filesystem>
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

CampaignStatus read_status(Database& database);

// 0 every point converged or complete; 3 decided, but some capped, failed, cancelled or with losses; 4 not
// finished; 6 some point is suspect: a seed gave two different results.
int standing(const CampaignStatus& status);
// The exit code of a process that has run it: standing(), or 75 when it did not finish what it was to do.
int ending(const CampaignStatus& status, bool finished);

// "3 points: 1 capped, 2 open"
std::string point_totals(const CampaignStatus& status);

// The verdict in a word; "open" or "cancelled" without one.
std::string standing_word(const PointSummary& point);

// "converged", "converged-with-losses(2)", "complete", "capped, 2 lost", "failed, 10 lost", "open"; "open,
// suspect"; "cancelled".
std::string verdict_text(const PointSummary& point);
// What speaks against its estimate: "jammed", "transient", "no-transient-test", "skewed", "near-maximum",
// "equal-values", "repeated-seeds", "2 flagged timestep", "suspect"; and "earlier-look" where a target that
// was loosened is met by an earlier look than there are seeds for.
std::vector<std::string> reservations(const PointSummary& point);

// The table and its totals; as the process that owns the campaign prints them at the end. In few columns of a
// terminal it does without what matters least; the verdict is always whole.
std::string status_table(Database& database, std::int64_t owner);
std::string status_table(const CampaignStatus& status, std::size_t width = unlimited_width);
// Who runs it and how far the workers are; nothing when the campaign is decided and nobody runs it.
std::string workers_text(const CampaignStatus& status, std::size_t width = unlimited_width);
Json status_json(const CampaignStatus& status);

}  // namespace peclet::runner
