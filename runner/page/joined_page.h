// The page of several campaigns, as JSON.
#pragma once

#include <vector>

#include "contract/json.h"
#include "runner/page/swept.h"

namespace peclet::runner {

// Returns one document of the points of all campaigns, for the page of one, without their workers. Their
// names are a parameter, "campaign", and begin the labels of their points. A parameter that a campaign does
// not sweep has the value of its scene there, or null if the scene has none. Keys of scenes that differ have
// the value of each. "documents" are in the place of "document". Throws InputError at --with for a campaign
// with another target or confidence than the first; throws IntegrityError.
Json joined_page(const std::vector<NamedCampaign>& sources);

}  // namespace peclet::runner
