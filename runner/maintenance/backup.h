// The verbs `peclet backup`, copies of a campaign's database from which it can go on, here or elsewhere, and
// `peclet restore`, by which one takes the place of a database that is lost or damaged.
//
// A folder of backups holds two generations: backup.db, and backup.previous.db from before it. Each is a
// sound SQLite database in one file, beside copies of the files that realisations left.
// Whoever writes there holds a flock on the folder.
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

// Copies of the files that realisations left, in a folder of backups: files/HASH, by the SHA-256 of the
// bytes.
//
// A copy is there once and stays, whatever generations of the database refer to it; so an unchanged file is
// not copied again. On one file system it is another name of the same bytes, which nobody changes.
struct FileCopies {
  int there = 0;    // that were copied, or already there
  int lacking = 0;  // that are absent or damaged where they should come from
};

// Whether a file lies in its place and is what its row says.
bool is_sound(const FileRecord& record, const CampaignDirectory& directory);
bool has_copy(const FileRecord& record, const fs::path& backups);

// Brings what is kept of these, and not sound, back into its place.
FileCopies bring_files_back(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                            const fs::path& backups);

struct BackupOptions {
  fs::path campaign;  // file or folder
  fs::path directory;
  fs::path target;           // "": the campaign's own folder of backups
  bool checkpoints = false;  // copy checkpoints and spool, too
  bool json = false;
};

struct Backup {
  fs::path file;
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
Backup make_backup(const CampaignDirectory& directory, const fs::path& folder, bool checkpoints);

// The verb: what was done, for people or as JSON.
std::string backup_campaign(const BackupOptions& options);

// Backups of a campaign while it runs, in a thread of their own: the dispatcher never waits for one.
//
// All functions are for the owner's thread. A backup that fails is a warning; the next one is tried all the
// same, and the generations that were there stay.
class PeriodicBackup {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `listener` must outlive it.
  PeriodicBackup(CampaignDirectory directory, std::chrono::duration<double> interval, RunListener& listener,
                 Time now);
  // Waits for a backup that is being made.
  ~PeriodicBackup();
  PeriodicBackup& operator=(PeriodicBackup&&) = delete;

  // Starts a backup when one is due, and tells what became of the last one.
  void attend(Time now);
  // The backup at the end of a run: waits for one that is being made, then makes another.
  void finish();

 private:
  void start();
  void tell();

  CampaignDirectory directory_;
  std::chrono::duration<double> interval_;
  RunListener& listener_;
  Time last_;
  std::future<Backup> running_;
  std::string complaint_;  // the last one: the same is not made twice
};

struct RestoreOptions {
  fs::path backup;    // a folder of backups, or one file
  fs::path campaign;  // file or folder, which need not exist
  fs::path directory;
  bool force = false;  // also in the place of a sound database that is as new
};

// Puts the newest sound backup in place, with the checkpoints and results beside it, and writes the campaign
// file when there is none. What was there is kept in aside/. Says what it did. Throws InputError when there
// is nothing to restore or something better in its place, OwnedByAnother, IntegrityError when no backup is
// sound.
std::string restore_campaign(const RestoreOptions& options);

}  // namespace peclet::runner
