// A campaign file under a new name has no folder, although its results are there under the old one.
#pragma once

#include <filesystem>

#include "runner/campaign/campaign.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// Requires `directory` to be the one that follows from the file's name. Throws InputError when nothing has
// been run in it, but a folder beside it has results of the campaign's points and no file of its own any
// more.
void refuse_renamed_file(const Campaign& campaign, const std::filesystem::path& file,
                         const CampaignDirectory& directory);

}  // namespace peclet::runner
