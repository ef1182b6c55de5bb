// Finding and opening a campaign that has been run, for those who only look at it.
#pragma once

#include <string>

#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// A campaign file under a new name has no folder, although its results are there under the old one.
//
// Requires `directory` to be the one that follows from the file's name. Throws InputError when nothing has
// been run in it, but a folder beside it has results of the campaign's points and no file of its own any
// more.
void refuse_renamed_file(const Campaign& campaign, const fs::path& file, const CampaignDirectory& directory);

struct OpenCampaign {
  CampaignDirectory directory;
  Database database;  // a reader's
};

// The folder of a campaign that has been run. Also when its database is gone, but not its backups.
CampaignDirectory find_campaign(const fs::path& given, const fs::path& chosen);

// Whether `given` is a file, of which there may be a campaign once it is run.
bool awaits_its_first_run(const fs::path& given, const fs::path& chosen);

// Reads the file of a campaign that awaits its first run. Throws InputError as read_campaign(), and for a
// file that was renamed since its campaign was run.
Campaign read_new_campaign(const fs::path& given, const fs::path& chosen);

// `given` is a campaign's folder, or its file (whose folder is `chosen`, or beside it when that is empty).
// Throws InputError when there is no campaign there that has been run, IntegrityError, DatabaseError.
OpenCampaign open_campaign(const fs::path& given, const fs::path& chosen);

// What a person should know when the campaign file is no longer what was run: a sentence, or nothing.
std::string difference_from_file(const fs::path& given, const fs::path& chosen,
                                 const CampaignRecord& campaign);

}  // namespace peclet::runner
