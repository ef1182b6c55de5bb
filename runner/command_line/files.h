// `peclet files`: what realisations have left beside their results.
#pragma once

#include <filesystem>
#include <string>

#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct FilesOptions {
  std::filesystem::path campaign, directory;
  std::string point;  // as find_point() names it; "" for all
  bool paths = false, json = false;
};

// A table; with `paths` the paths of the files that are kept, a line each; with `json` an array of point,
// hash, seed, name, bytes, sha256 and path, which is null of a file that was thrown away. Throws InputError
// for a point that there is not.
std::string list_files(Database& database, const CampaignDirectory& directory, const FilesOptions& options);

}  // namespace peclet::runner
