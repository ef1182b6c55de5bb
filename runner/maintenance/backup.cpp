#include "runner/maintenance/backup.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <exception>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/locks.h"
#include "runner/store/point_store.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

namespace {

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

void refuse_unsuitable_folder(const CampaignDirectory& directory, const fs::path& folder) {
  // A path through a disk that is not mounted would be made on the disk above it, unnoticed.
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
  // Damage is found when the copy is made; here only readable databases are compared.
  const Contents here = campaign_in(directory.database());
  const Contents there = campaign_in(newest_backup(folder));
  if (here.origin.empty() || there.origin.empty() || there.same_campaign(here)) return;
  throw InputError(folder.string(), "", fmt::format("{}, created at {}", there.name, there.created_at),
                   "holds backups of another campaign; choose another folder");
}

// Returns false if the file has gone: its result was committed meanwhile and is in the database.
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
  if (kind_of(to) == "a link") fs::remove(to);  // a link would lead the copies elsewhere
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
  text += "in it: the campaign as last run and every committed result, attempt, stop test and event\n";
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

// Throws unless the disk has room for a backup and for as much again, so that a backup does not fill it.
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

struct Source {
  fs::path file;
  Contents contents;
  std::string remarks;  // why newer backups were passed over
};

// Returns the newest sound backup. After a damaged generation the one before it is examined.
Source find_backup(const fs::path& given) {
  std::error_code absent;
  const fs::path target = fs::canonical(given, absent);  // the path may be a link
  std::vector<fs::path> candidates{absent ? given : target};
  if (fs::is_directory(given)) candidates = {newest_backup(given), previous_backup(given)};
  Source source;
  for (const fs::path& file : candidates) {
    if (kind_of(file).empty()) continue;
    try {
      source.contents = examine(file);
      source.file = file;
      return source;
    } catch (const IntegrityError& error) {
      source.remarks += fmt::format("{}\n", error.what());
    }
  }
  if (!source.remarks.empty()) throw IntegrityError("there is no sound backup: " + source.remarks);
  throw InputError(given.string(), "", "", "there is no backup here (a folder with backup.db, or one file)");
}

// Returns what the present database holds; nothing if it is absent, or damaged as `damage` then says.
std::optional<Contents> examine_present(const fs::path& database, std::string& damage) {
  if (kind_of(database).empty()) return std::nullopt;
  try {
    return examine(database);
  } catch (const IntegrityError& error) {
    damage = error.what();
  } catch (const DatabaseError& error) {
    damage = error.what();
  } catch (const UnsuitableFile& error) {  // kept aside as it is
    damage = error.what();
  }
  return std::nullopt;
}

void refuse_to_replace(const CampaignDirectory& directory, const Contents& present, const Contents& backup) {
  const std::string folder = directory.root().string();
  if (!present.same_campaign(backup)) {
    throw InputError(folder, "", present.name,
                     fmt::format("is a sound database of another campaign, created at {}; --force keeps it "
                                 "aside all the same",
                                 present.created_at));
  }
  if (present.results < backup.results || present.attempts < backup.attempts) return;
  throw InputError(folder, "", fmt::format("{} results", present.results),
                   fmt::format("its database is sound and as new as the backup, which has {}; --force keeps "
                               "it aside all the same",
                               backup.results));
}

// Moves the present database to aside/, its main file first: until the backup has taken its place there is
// none, so no program can continue with half of it. Its write-ahead log must never meet another database.
fs::path keep_aside(const CampaignDirectory& directory) {
  fs::path folder;
  for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) {
    const fs::path file = directory.database().string() + suffix;
    if (kind_of(file).empty()) continue;
    if (folder.empty()) folder = make_folder_aside(directory);
    fs::rename(file, folder / file.filename());
  }
  return folder;
}

int bring(const fs::path& from, const fs::path& to) {
  if (kind_of(from) != "a folder") return 0;
  int brought = 0;
  for (const fs::path& file : whole_files(from)) {
    const fs::path target = to / file.filename();
    if (!kind_of(target).empty()) continue;
    copy_regular(file, target, largest_copied_file);
    if (!is_growing(file)) ++brought;
  }
  return brought;
}

FileCopies bring_files(const CampaignDirectory& directory, const fs::path& backups) {
  Connection database(directory.database().string(), Connection::Access::read_only, 10'000);
  return bring_files_back(files_in(database), directory, backups);
}

struct Place {
  CampaignDirectory directory;
  fs::path file;  // campaign file
  std::string run_arguments;
};

Place place_of(const RestoreOptions& options) {
  if (options.campaign.extension() == ".json") {
    return {campaign_directory(options.campaign, options.directory), options.campaign,
            words_for(options.campaign, options.directory)};
  }
  fs::path root = fs::absolute(options.campaign).lexically_normal();
  if (!root.has_filename()) root = root.parent_path();  // a slash at the end
  if (root.extension() == ".peclet") {
    fs::path file = root;
    file.replace_extension(".json");
    return {CampaignDirectory(root), file, words_for(file, "")};
  }
  const fs::path file = root / "campaign.json";
  return {CampaignDirectory(root), file, words_for(file, root)};
}

void record(const CampaignDirectory& directory, const Source& source) {
  Database database = Database::open_owner(directory.database());
  Transaction booking(database.connection());
  EventStore(database.connection()).write("restored", "from " + source.file.string());
  booking.commit();
}

// Makes a new backup if the campaign's own last one knows more than what was restored, or is damaged. That
// one becomes the previous generation. Returns true if a new one was made.
bool leave_newer_backup_behind(const CampaignDirectory& directory, const Source& source) {
  const fs::path newest = newest_backup(directory.backup());
  if (kind_of(newest).empty() || fs::equivalent(newest, source.file)) return false;
  try {
    if (examine(newest).attempts <= source.contents.attempts) return false;
  } catch (const IntegrityError&) {  // a damaged backup may still be the newer one
  }
  make_backup(directory, directory.backup(), false);
  return true;
}

std::string write_campaign_file(const fs::path& file, const Json& document) {
  if (!fs::exists(file)) {
    write_output(file, document.dump(2) + "\n");
    return fmt::format("{} was written as the campaign was last run\n", file.string());
  }
  try {
    if (read_campaign(file).document == document) return "";
  } catch (const InputError&) {  // `peclet run` will say what is wrong
  }
  return fmt::format("{} differs from what was run last, and is not changed\n", file.string());
}

// Copies the kept files into a folder of backups. Throws NoRoomError, std::system_error, UnsuitableFile.
FileCopies copy_files_of(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                         const fs::path& backups) {
  FileCopies copies;
  require_own_folder(CampaignDirectory(backups).files());
  for (const FileRecord& record : records) {
    if (!record.kept) continue;
    const fs::path target = copy_of(record, backups), place = record.place(directory);
    // Only complete files get such a name.
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

}  // namespace

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

Backup make_backup(const CampaignDirectory& directory, const fs::path& folder, bool checkpoints) {
  const auto started = std::chrono::steady_clock::now();
  refuse_unsuitable_folder(directory, folder);
  fs::create_directory(folder);
  const FileLock lock(folder);  // `peclet backup` and the campaign's own backups may meet
  remove_unfinished_files(folder);
  Backup backup;
  if (checkpoints) {
    // Copied before the database: a result that is committed in between is in both, and counts once.
    backup.spool_files = copy_files(directory.spool(), folder / "spool");
    copy_files(directory.left(), CampaignDirectory(folder).left());  // after the results that list them
    backup.checkpoints = copy_files(directory.checkpoints(), folder / "checkpoints");
  }
  const fs::path next = folder / "backup.next.db";
  std::vector<FileRecord> files;
  copy_database(directory.database(), next, [&](Connection& copy) {
    // The event says when and where the copy was made.
    EventStore(copy).write("backup", "copied from " + directory.database().string());
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
    listener_.warn("no backup could be made; it will be tried again: " + complaint_);
  }
}

std::string restore_campaign(const RestoreOptions& options) {
  const Source source = find_backup(options.backup);
  const Place place = place_of(options);
  const CampaignDirectory& directory = place.directory;
  fs::create_directories(directory.root());
  const OwnerLock lock(directory);
  std::string damage;
  const std::optional<Contents> present = examine_present(directory.database(), damage);
  if (present && !options.force) refuse_to_replace(directory, *present, source.contents);

  create_folders(directory);
  const fs::path aside = keep_aside(directory);
  copy_database(source.file, directory.database(), {});
  record(directory, source);
  const fs::path beside = source.file.parent_path();
  const int spooled = bring(beside / "spool", directory.spool());
  bring(CampaignDirectory(beside).left(), directory.left());
  const int checkpoints = bring(beside / "checkpoints", directory.checkpoints());
  const FileCopies files = bring_files(directory, beside);

  const bool is_older = leave_newer_backup_behind(directory, source);
  std::string text = source.remarks;
  if (!damage.empty()) text += damage + "\n";
  const std::string& made_at = source.contents.backed_up_at;  // empty if it is not a backup
  text += fmt::format("{}: restored from {}{}, with {} results\n", directory.root().string(),
                      source.file.string(), made_at.empty() ? "" : ", made at " + made_at,
                      source.contents.results);
  if (spooled + checkpoints > 0) {
    text += fmt::format("with it came {} checkpoints and {} results on their way\n", checkpoints, spooled);
  }
  if (files.there > 0) text += fmt::format("with it came {} files of realisations\n", files.there);
  if (files.lacking > 0) {
    text += fmt::format(
        "{} files of realisations are neither here nor beside the backup: `peclet doctor` names them\n",
        files.lacking);
  }
  if (is_older) {
    text += fmt::format("the campaign's own last backup has more in it; it is now {}\n",
                        previous_backup(directory.backup()).string());
  }
  if (!aside.empty()) text += fmt::format("the database that was there is kept in {}\n", aside.string());
  text += write_campaign_file(place.file, source.contents.document);
  return text + fmt::format("go on with: peclet run {}\n", place.run_arguments);
}

}  // namespace peclet::runner
