// The sections of a report, each a piece of HTML that begins with its heading; "" for one that has nothing to
// say.
#pragma once

#include <string>
#include <vector>

#include "runner/database/database.h"
#include "runner/reports/status.h"

namespace peclet::runner {

// What was asked: observable, tolerance, what the sweep varies, what all scenes share.
std::string question_section(const CampaignStatus& status);
// The table of the points, and its chart.
std::string results_section(const CampaignStatus& status);
// What went wrong or may be doubted: lost seeds by cause, and what every mark in the table means.
std::string losses_section(const CampaignStatus& status);
std::string remarks_section(const CampaignStatus& status, const std::vector<Json>& warnings);
// Where the numbers come from, and the commands that make them again. `canonical_sha256` is that of the
// canonical export.
std::string provenance_section(Database& database, const CampaignStatus& status,
                               const std::string& canonical_sha256);

}  // namespace peclet::runner
