#include "runner/maintenance/backup.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <chrono>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "runner/store/point_store.h"
#include "runner/store/spool.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

fs::path copy_of(const FileRecord& record, const fs::path& backups) {
  return CampaignDirectory(backups).files() / record.file.sha256;
}

bool is_what_it_was(const fs::path& path, const FileRecord& record) {
  return fault_of_file(path, record.file.bytes, record.file.sha256).empty();
}

void link_or_copy(const fs::path& place, const fs::path& copy) {
  const fs::path next = copy.string() + ".next";
  fs::remove(next);
  std::error_code no_link;
  fs::create_hard_link(place, next, no_link);
  if (no_link) return copy_regular(place, copy, largest_left_file);
  rename_durably(next, copy);
}

}  // namespace

FileCopies copy_files_of(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                         const fs::path& backups) {
  FileCopies copies;
  require_own_folder(CampaignDirectory(backups).files());
  for (const FileRecord& record : records) {
    if (!record.kept) continue;
    const fs::path target = copy_of(record, backups), place = record.place(directory);
    // Only whole files get such a name.
    const bool is_there = kind_of(target) == "a regular file" && fs::file_size(target) == record.file.bytes;
    if (!is_there && !is_what_it_was(place, record)) {
      ++copies.lacking;
      continue;
    }
    ++copies.there;
    if (is_there) continue;
    create_folders_durably(target.parent_path());
    link_or_copy(place, target);
  }
  return copies;
}

bool is_sound(const FileRecord& record, const CampaignDirectory& directory) {
  return is_what_it_was(record.place(directory), record);
}

bool has_copy(const FileRecord& record, const fs::path& backups) {
  return is_what_it_was(copy_of(record, backups), record);
}

FileCopies bring_files_back(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                            const fs::path& backups) {
  FileCopies copies;
  for (const FileRecord& record : records) {
    if (!record.kept || is_sound(record, directory)) continue;
    if (!has_copy(record, backups)) {
      ++copies.lacking;
      continue;
    }
    const fs::path place = record.place(directory);
    create_folders_durably(place.parent_path());
    copy_regular(copy_of(record, backups), place, largest_left_file);
    ++copies.there;
  }
  return copies;
}

namespace {

void refuse_unsuitable_folder(const CampaignDirectory& directory, const fs::path& folder) {
  // A path that leads through a disk that is not mounted would be made on the one above it, unnoticed.
  if (!fs::is_directory(folder.parent_path())) {
    throw InputError(folder.string(), "", "",
                     fmt::format("there is no folder {}: mount its disk, or make it (of a backup's path only "
                                 "the last folder is made)",
                                 folder.parent_path().string()));
  }
  if (folder == directory.backup()) require_own_folder(folder);
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(folder.string(), "", "", "must be a folder for backups");
  }
  if (!kind_of(CampaignDirectory(folder).lock()).empty()) {
    throw InputError(folder.string(), "", "", "is the folder of a campaign; backups need one of their own");
  }
  if (kind_of(newest_backup(folder)).empty()) return;
  // Damage is found when the copy is made; here only those are told apart that can still be read.
  const Contents here = campaign_in(directory.database());
  const Contents there = campaign_in(newest_backup(folder));
  if (here.origin.empty() || there.origin.empty() || there.same_campaign(here)) return;
  throw InputError(folder.string(), "", fmt::format("{}, created at {}", there.name, there.created_at),
                   "holds backups of another campaign; choose another folder");
}

// A file may go while we look: its result was committed, and then it is in the database.
bool copy_file_that_may_go(const fs::path& from, const fs::path& folder) {
  try {
    copy_regular(from, folder / from.filename(), largest_copied_file);
    return true;
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory) return false;
    throw;
  }
}

int copy_files(const fs::path& from, const fs::path& to) {
  if (kind_of(from) != "a folder") return 0;
  if (kind_of(to) == "a link") fs::remove(to);  // it would lead the copies elsewhere
  fs::create_directories(to);
  int copied = 0;
  for (const fs::path& file : whole_files(from)) {
    if (copy_file_that_may_go(file, to) && !is_growing(file)) ++copied;
  }
  return copied;
}

dev_t device_of(const fs::path& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) fail_to("cannot examine", path);
  return about.st_dev;
}

fs::path without_slash(const fs::path& path) {
  const fs::path folder = fs::absolute(path).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

Json as_json(const Backup& backup) {
  return {{"schema_version", 1},
          {"file", backup.file.string()},
          {"results", backup.results},
          {"bytes", backup.bytes},
          {"seconds", backup.seconds},
          {"files", backup.files.there},
          {"files_lacking", backup.files.lacking},
          {"spool_files", backup.spool_files},
          {"checkpoints", backup.checkpoints}};
}

std::string as_text(const Backup& backup, const CampaignDirectory& directory, bool checkpoints) {
  std::string text = fmt::format("{}: {} results, {:.1f} MB, checked, in {:.1f} s\n", backup.file.string(),
                                 backup.results, 1e-6 * static_cast<double>(backup.bytes), backup.seconds);
  text += "in it: the campaign as last run and every committed result, attempt, look and event\n";
  if (backup.files.there > 0)
    text += fmt::format("beside it: {} files of realisations\n", backup.files.there);
  if (backup.files.lacking > 0) {
    text +=
        fmt::format("{} of these files are absent or damaged, and not copied: `peclet doctor` names them\n",
                    backup.files.lacking);
  }
  if (checkpoints) {
    text += fmt::format("beside it: {} checkpoints and {} results on their way\n", backup.checkpoints,
                        backup.spool_files);
  }
  if (backup.beside_campaign) {
    text += "on the same file system as the campaign: what destroys one may destroy both\n";
  }
  text += fmt::format("not in it: {}states of blow-ups, logs, the engine\n",
                      checkpoints ? "" : "checkpoints and spool (--checkpoints), ");
  return text + fmt::format("go on from it with: peclet restore {} {}\n",
                            shell_word(backup.file.parent_path().string()),
                            shell_word(directory.root().filename().string()));
}

}  // namespace

Backup make_backup(const CampaignDirectory& directory, const fs::path& folder, bool checkpoints) {
  const auto started = std::chrono::steady_clock::now();
  refuse_unsuitable_folder(directory, folder);
  fs::create_directory(folder);
  const FolderLock lock(folder);  // `peclet backup` and the campaign's own backups may meet
  remove_unfinished_files(folder);
  Backup backup;
  if (checkpoints) {
    // Before the database: a result that is committed in between is in both, and counts once.
    backup.spool_files = copy_files(directory.spool(), folder / "spool");
    copy_files(directory.left(), CampaignDirectory(folder).left());  // after the results that list them
    backup.checkpoints = copy_files(directory.checkpoints(), folder / "checkpoints");
  }
  const fs::path next = folder / "backup.next.db";
  std::vector<FileRecord> files;
  copy_database(directory.database(), next, [&](Connection& copy) {
    // Whoever restores the copy can say when and where it was made.
    EventStore(copy).write("backup", std::nullopt, std::nullopt,
                           "copied from " + directory.database().string());
    files = files_in(copy);
    backup.results = extent_of(copy).results;
  });
  backup.files = copy_files_of(files, directory, folder);  // before the generation that refers to them
  backup.file = newest_backup(folder);
  if (!kind_of(backup.file).empty()) fs::rename(backup.file, previous_backup(folder));
  rename_durably(next, backup.file);
  backup.bytes = fs::file_size(backup.file);
  backup.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return backup;
}

std::string backup_campaign(const BackupOptions& options) {
  const OpenCampaign open = open_campaign(options.campaign, options.directory);
  const bool is_elsewhere = !options.target.empty();
  const fs::path folder = is_elsewhere ? without_slash(options.target) : open.directory.backup();
  Backup backup = make_backup(open.directory, folder, options.checkpoints);
  backup.beside_campaign = is_elsewhere && device_of(folder) == device_of(open.directory.root());
  return options.json ? as_json(backup).dump(2) + '\n' : as_text(backup, open.directory, options.checkpoints);
}

namespace {

// A backup must not be what fills the disk: beside it, there has to be room for as much again.
void refuse_to_fill_the_disk(const CampaignDirectory& directory) {
  const std::uintmax_t size = fs::file_size(directory.database());
  const std::uintmax_t available = fs::space(directory.backup()).available;
  if (available >= 2 * size) return;
  throw std::runtime_error(fmt::format(
      "{}: {:.1f} MB are free, and a backup needs twice the {:.1f} MB of the database",
      directory.backup().string(), 1e-6 * static_cast<double>(available), 1e-6 * static_cast<double>(size)));
}

Backup back_up(const CampaignDirectory& directory) {
  fs::create_directories(directory.backup());
  refuse_to_fill_the_disk(directory);
  return make_backup(directory, directory.backup(), false);
}

}  // namespace

PeriodicBackup::PeriodicBackup(CampaignDirectory directory, std::chrono::duration<double> interval,
                               RunListener& listener, Time now)
    : directory_(std::move(directory)), interval_(interval), listener_(listener), last_(now) {}

PeriodicBackup::~PeriodicBackup() {
  if (running_.valid()) running_.wait();
}

void PeriodicBackup::attend(Time now) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    tell();
    last_ = now;
  }
  if (now - last_ >= interval_) start();
}

void PeriodicBackup::finish() {
  if (running_.valid()) tell();
  start();
  tell();
}

void PeriodicBackup::start() {
  running_ = std::async(std::launch::async, [directory = directory_] { return back_up(directory); });
}

void PeriodicBackup::tell() {
  try {
    running_.get();
    complaint_.clear();
  } catch (const std::exception& error) {
    if (complaint_ == error.what()) return;
    complaint_ = error.what();
    listener_.warn("no backup could be made, which is tried again: " + complaint_);
  }
}

}  // namespace peclet::runner
