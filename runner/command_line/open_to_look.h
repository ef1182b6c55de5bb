// Opening a campaign for a verb that only looks at it.
#pragma once

#include "runner/owner/open_campaign.h"

namespace peclet::runner {

// As open_campaign(); says on standard error if the database is read as it is, without the locks and the log
// that a running campaign has.
OpenCampaign open_to_look(const std::filesystem::path& given, const std::filesystem::path& chosen);

}  // namespace peclet::runner
