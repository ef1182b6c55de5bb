// Finds and opens a campaign that has been run, for programs that only read it.
#pragma once

#include <string>

#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Throws InputError if the campaign file seems to have been renamed: its folder does not exist, but a folder
// beside it has results of the campaign's points and no campaign file. Requires `directory` to be the one
// that follows from the file's name.
void refuse_renamed_file(const Campaign& campaign, const fs::path& file, const CampaignDirectory& directory);

struct OpenCampaign {
  CampaignDirectory directory;
  Database database;  // opened for reading
};

// Returns the folder of a campaign that has been run, also if its database is gone but has backups. `given`
// and `chosen` are as in open_campaign(). Throws InputError if no campaign has been run there.
CampaignDirectory find_campaign(const fs::path& given, const fs::path& chosen);

// True if `given` is a file whose campaign has not been run.
bool awaits_its_first_run(const fs::path& given, const fs::path& chosen);

// Reads the file of a campaign that awaits its first run. Throws InputError as read_campaign(), and if the
// file was renamed since its campaign was run.
Campaign read_new_campaign(const fs::path& given, const fs::path& chosen);

// Opens a campaign for reading. `given` is its folder or its file; the folder of a file is `chosen`, or
// beside it if that is empty. Throws InputError if no campaign has been run there, IntegrityError,
// DatabaseError.
OpenCampaign open_campaign(const fs::path& given, const fs::path& chosen);

// Returns a sentence if the campaign file differs from what was run last, or has a fault; "" otherwise.
std::string difference_from_file(const fs::path& given, const fs::path& chosen,
                                 const CampaignRecord& campaign);

}  // namespace peclet::runner
