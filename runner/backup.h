// The verb `peclet backup`: copies of a campaign's database from which it can go on, here or elsewhere.
//
// A folder of backups holds two generations: backup.db, and backup.previous.db from before it. Each is a
// sound SQLite database in one file. Whoever writes there holds a flock on the folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "contract/json.h"
#include "runner/campaign_directory.h"
#include "runner/sqlite.h"

namespace peclet::runner {

struct BackupOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::filesystem::path target;  // "": the campaign's own folder of backups
  bool checkpoints = false;      // copy checkpoints and spool, too
  bool json = false;
};

std::filesystem::path newest_backup(const std::filesystem::path& folder);
std::filesystem::path previous_backup(const std::filesystem::path& folder);

// What a database holds, of whatever version its tables are.
struct Contents {
  std::string name, created_at;  // of the campaign
  std::string origin;            // tells campaigns apart, whatever they are called since
  Json document;
  std::int64_t results = 0, attempts = 0;
  std::string backed_up_at;  // of a backup; empty otherwise
  bool same_campaign(const Contents& other) const { return origin == other.origin; }
};

// Checks a whole database and says what it holds. Throws IntegrityError, DatabaseError.
Contents examine(const std::filesystem::path& database);

struct Backup {
  std::filesystem::path file;
  std::int64_t results = 0;
  std::uintmax_t bytes = 0;
  double seconds = 0;
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
