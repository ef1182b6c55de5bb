// The verbs `peclet backup`, which copies a campaign's database so that the campaign can continue from it,
// here or elsewhere, and `peclet restore`, which puts such a copy in the place of a lost or damaged database.
//
// A folder of backups holds two generations: backup.db, and backup.previous.db from before it. Each is a
// sound SQLite database in one file, beside copies of the files that realisations left. A process that writes
// there holds a flock on the folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <string>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/owner/run_listener.h"
#include "runner/store/backups.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

// Number of copies of files that realisations left. A folder of backups has them as files/HASH, by the
// SHA-256 of the bytes. A copy stays, whatever generations of the database refer to it, so an unchanged file
// is not copied again. On one file system the copy is another name of the same bytes, which are never
// changed.
struct FileCopies {
  int there = 0;    // copied now or before
  int lacking = 0;  // absent or damaged where they should come from
};

// True if a file lies in its place and matches its row.
bool is_sound(const FileRecord& record, const CampaignDirectory& directory);
bool has_copy(const FileRecord& record, const fs::path& backups);

// Copies kept files that are not sound from `backups` back into their places.
FileCopies bring_files_back(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                            const fs::path& backups);

struct BackupOptions {
  fs::path campaign;  // file or folder
  fs::path directory;
  fs::path target;           // "" for the campaign's own folder of backups
  bool checkpoints = false;  // also copy checkpoints and spool
  bool json = false;
};

struct Backup {
  fs::path file;
  std::int64_t results = 0;
  std::uintmax_t bytes = 0;
  double seconds = 0;
  FileCopies files;                      // files that realisations have left
  int spool_files = 0, checkpoints = 0;  // copied beside it
  bool beside_campaign = false;          // on the same file system, although it was to be elsewhere
};

// Adds a generation to `folder`, which is made if needed; its parent must exist. Throws InputError if the
// parent is absent or the folder holds backups of another campaign, IntegrityError if the database is
// damaged, DatabaseError, std::system_error. Earlier generations are kept then.
Backup make_backup(const CampaignDirectory& directory, const fs::path& folder, bool checkpoints);

// Runs the verb. Returns what was done, for people or as JSON.
std::string backup_campaign(const BackupOptions& options);

// PeriodicBackup makes backups of a running campaign in a thread of its own, so the dispatcher never waits
// for one. All functions are for the owner's thread. A failed backup is a warning; the next one is tried all
// the same, and earlier generations are kept.
class PeriodicBackup {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `listener` must outlive it.
  PeriodicBackup(CampaignDirectory directory, std::chrono::duration<double> interval, RunListener& listener,
                 Time now);
  // Waits for a backup that is being made.
  ~PeriodicBackup();
  PeriodicBackup& operator=(PeriodicBackup&&) = delete;

  // Starts a backup if one is due, and tells what became of the last one.
  void attend(Time now);
  // Makes the backup at the end of a run, after waiting for one that is being made.
  void finish();

 private:
  void start();
  void tell();

  CampaignDirectory directory_;
  std::chrono::duration<double> interval_;
  RunListener& listener_;
  Time last_;
  std::future<Backup> running_;
  std::string complaint_;  // the last one, so that it is not repeated
};

struct RestoreOptions {
  fs::path backup;    // a folder of backups, or one file
  fs::path campaign;  // file or folder, which need not exist
  fs::path directory;
  bool force = false;  // also replace a sound database that is as new
};

// Puts the newest sound backup in place, with the checkpoints and results beside it, and writes the campaign
// file if there is none. What was there is kept in aside/. Returns what was done. Throws InputError if there
// is nothing to restore or something better in its place, OwnedByAnother, IntegrityError if no backup is
// sound.
std::string restore_campaign(const RestoreOptions& options);

}  // namespace peclet::runner
