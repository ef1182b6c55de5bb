// The verb `peclet explain`: why a point is where it is, and what would bring it further.
#pragma once

#include <filesystem>
#include <string>

#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Throws InputError for a name that no point, or more than one, has.
std::string explain(Database& database, const CampaignDirectory& directory, const std::string& point);
// The same as schema/README.md describes it.
Json explain_json(Database& database, const CampaignDirectory& directory, const std::string& point);

}  // namespace peclet::runner
