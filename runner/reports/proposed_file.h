// Verbs that propose points: their answer, and the campaign file with the points.
#pragma once

#include <string>

#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct Proposal {
  std::string text;     // for standard output
  std::string message;  // for standard error
};

// The campaign file as its author wrote it or, if there is none, as it was last run.
struct CampaignSource {
  fs::path file;
  std::string text;
};
// `given` is the file or folder by which the campaign was named.
CampaignSource source_of(const fs::path& given, const CampaignRecord& campaign);

// Returns the sweep that the author wrote, with lists in the place of ranges. Throws InputError.
Json sweep_of(const CampaignSource& source);

// Throws InputError at --write if the file exists or cannot be written; does nothing for "". Called before
// any work is done.
void check_new_file(const fs::path& file);

// Writes the text as the campaign file `file` and returns a message. Throws InputError if it would be
// invalid.
std::string write_proposed(const fs::path& file, const std::string& text, const CampaignDirectory& directory);

}  // namespace peclet::runner
