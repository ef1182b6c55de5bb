#include "runner/maintenance/restore.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/maintenance/backup.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "runner/store/point_store.h"
#include "runner/store/spool.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

struct Source {
  fs::path file;
  Contents contents;
  std::string remarks;  // why it is not a newer one
};

// The newest sound one. A damaged generation is a reason to look at the one before it, not to give up.
Source find_backup(const fs::path& given) {
  std::error_code absent;
  const fs::path target = fs::canonical(given, absent);  // a person may name a link to it
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

// What the present database holds; nothing when it is absent or damaged, and then `damage` says how.
std::optional<Contents> examine_present(const fs::path& database, std::string& damage) {
  if (kind_of(database).empty()) return std::nullopt;
  try {
    return examine(database);
  } catch (const IntegrityError& error) {
    damage = error.what();
  } catch (const DatabaseError& error) {
    damage = error.what();
  } catch (const UnsuitableFile& error) {  // it is kept aside as it is
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

// The database first: until the backup has taken its place there is none, and nothing can go on with half of
// it. Its write-ahead log must never meet another database.
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
  fs::path file;  // the campaign's
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
  EventStore(database.connection())
      .write("restored", std::nullopt, std::nullopt, "from " + source.file.string());
  booking.commit();
}

// What was restored is what counts now, also where the campaign's own last backup knows more, or is
// damaged: that becomes the one before.
bool leave_newer_backup_behind(const CampaignDirectory& directory, const Source& source) {
  const fs::path newest = newest_backup(directory.backup());
  if (kind_of(newest).empty() || fs::equivalent(newest, source.file)) return false;
  try {
    if (examine(newest).attempts <= source.contents.attempts) return false;
  } catch (
      const IntegrityError&) {  // why an older one was restored; what can be read of it may still be newer
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
  } catch (const InputError&) {  // `peclet run` will say what is wrong with it
  }
  return fmt::format("{} was there, is not what was run last, and is not touched\n", file.string());
}

}  // namespace

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
  const std::string& made_at = source.contents.backed_up_at;  // not of a database that is no backup
  text += fmt::format("{}: restored from {}{}, with {} results\n", directory.root().string(),
                      source.file.string(), made_at.empty() ? "" : ", made at " + made_at,
                      source.contents.results);
  if (spooled + checkpoints > 0) {
    text += fmt::format("with it came {} checkpoints and {} results on their way\n", checkpoints, spooled);
  }
  if (files.there > 0) text += fmt::format("with it came {} files of realisations\n", files.there);
  if (files.lacking > 0) {
    text += fmt::format(
        "{} files of realisations are neither here nor beside the backup: `peclet doctor` names "
        "them\n",
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
