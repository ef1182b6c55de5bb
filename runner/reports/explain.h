// Implements the verb `peclet explain`: why a point has its verdict, and what to do next.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runner/store/campaign_directory.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {

// Returns the explanation of a point as named in find_point(), or of all points if `point` is "". Throws
// InputError if no point, or more than one, has the name.
std::string explain(Database& database, const CampaignDirectory& directory, const std::string& point);
// Returns the explanation as schema/README.md describes it.
Json explain_json(Database& database, const CampaignDirectory& directory, const std::string& point);

// Returns lines on the estimate of the last stop test: how far its interval can be trusted, the effect of the
// control variate, and whether longer windows are cheaper than more seeds. Empty before the first stop test.
std::string estimate_text(Database& database, const PointSummary& point, const TargetRecord& target);

// Returns the lost seeds by cause.
std::map<std::string, std::vector<int>> lost_seeds(Database& database, std::int64_t point);
// Returns "  lost: 2 overlap (seeds 3, 17)" for every cause, and the reason on the next line.
std::string losses_text(Database& database, const PointSummary& point);

// Returns the number of attempts by outcome, and the latest ones that count against their seed.
std::string attempts_text(Database& database, std::int64_t point);

}  // namespace peclet::runner
