// The verb `peclet backup`: copies of a campaign's database from which it can go on, here or elsewhere.
//
// A folder of backups holds two generations: backup.db, and backup.previous.db from before it. Each is a
// sound SQLite database in one file, beside copies of the files that realisations left (file_copies.h).
// Whoever writes there holds a flock on the folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "contract/json.h"
#include "runner/care/file_copies.h"
#include "runner/store/backups.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

struct BackupOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::filesystem::path target;  // "": the campaign's own folder of backups
  bool checkpoints = false;      // copy checkpoints and spool, too
  bool json = false;
};

struct Backup {
  std::filesystem::path file;
  std::int64_t results = 0;
  std::uintmax_t bytes = 0;
  double seconds = 0;
  FileCopies files;                      // that realisations have left
  int spool_files = 0, checkpoints = 0;  // copied beside it
  bool beside_campaign = false;          // although it was to be elsewhere, it is on the same file system
};

// Adds a generation to `folder`, which is made when there is none, in a folder that must be there. Throws
// InputError when that is not there or the folder holds backups of another campaign, IntegrityError when the
// database is damaged, DatabaseError, std::system_error; the generations that were there are then still
// there.
Backup make_backup(const CampaignDirectory& directory, const std::filesystem::path& folder, bool checkpoints);

// The verb: what was done, for people or as JSON.
std::string backup_campaign(const BackupOptions& options);

}  // namespace peclet::runner
