// The verb `peclet restore`: a backup takes the place of a database that is lost or damaged, here or on
// another machine.
#pragma once

#include <filesystem>
#include <string>

#include "runner/store/campaign_directory.h"

namespace peclet::runner {

struct RestoreOptions {
  std::filesystem::path backup;    // a folder of backups, or one file
  std::filesystem::path campaign;  // file or folder, which need not exist
  std::filesystem::path directory;
  bool force = false;  // also in the place of a sound database that is as new
};

// Puts the newest sound backup in place, with the checkpoints and results beside it, and writes the campaign
// file when there is none. What was there is kept in aside/. Says what it did. Throws InputError when there
// is nothing to restore or something better in its place, OwnedByAnother, IntegrityError when no backup is
// sound.
std::string restore_campaign(const RestoreOptions& options);

}  // namespace peclet::runner
