// The verb `peclet explain`: why a point is where it is, and what would bring it further.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runner/store/campaign_directory.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {

// Throws InputError for a name that no point, or more than one, has.
std::string explain(Database& database, const CampaignDirectory& directory, const std::string& point);
// The same as schema/README.md describes it.
Json explain_json(Database& database, const CampaignDirectory& directory, const std::string& point);

// What it says of an estimate: how far its interval can be trusted, what the control variate does for it, and
// whether longer windows would be cheaper than more seeds.
//
// Lines of the last stop test at a point; nothing before the first one.
std::string estimate_text(Database& database, const PointSummary& point, const TargetRecord& target);

// Seeds that are lost, by cause.
std::map<std::string, std::vector<int>> lost_seeds(Database& database, std::int64_t point);
// "  lost: 2 overlap (seeds 3, 17)" for every cause, and why in the line below; nothing when no seed is lost.
std::string losses_text(Database& database, const PointSummary& point);

// How many attempts ended how, and the latest ones that count against their seed.
std::string attempts_text(Database& database, std::int64_t point);

}  // namespace peclet::runner
