#include "runner/database/backup_files.h"

#include <fmt/format.h>

#include <system_error>

#include "contract/guarded_file.h"
#include "contract/integrity_error.h"
#include "runner/database/database.h"
#include "runner/database/database_copy.h"
#include "runner/text/quoting.h"

namespace peclet::runner {

namespace fs = std::filesystem;

namespace {

// When the campaign was set up, and the first point that it ever had, never change.
void read_identity(Connection& database, Contents& contents) {
  contents.name = database.text("SELECT name FROM campaign");
  contents.created_at = database.text("SELECT created_at FROM campaign");
  contents.origin = database.text(
      "SELECT created_at || ' ' || (SELECT hash FROM point ORDER BY point_id LIMIT 1) FROM campaign");
}

}  // namespace

Extent extent_of(Connection& database) {
  return {database.integer("SELECT count(*) FROM result"),
          database.integer("SELECT coalesce(max(attempt_id), 0) FROM attempt")};
}

Contents campaign_in(const fs::path& path) {
  try {
    Contents contents;
    Connection database(path.string(), Connection::Access::read_only, 10'000);
    read_identity(database, contents);
    return contents;
  } catch (const IntegrityError&) {
    return {};
  }
}

Contents examine(const std::filesystem::path& path) {
  Connection database(path.string(), Connection::Access::read_only, 10'000);
  if (!is_campaign_database(database)) {
    throw IntegrityError(path.string() + ": is no database of a peclet campaign");
  }
  if (const std::string why = other_version(database); !why.empty()) {
    throw IntegrityError(fmt::format("{}: {}", path.string(), why));
  }
  if (const std::string found = damage(database); !found.empty()) {
    throw IntegrityError(fmt::format("{}: is damaged: {}", path.string(), found));
  }
  if (database.integer("SELECT count(*) FROM campaign") == 0) {
    throw IntegrityError(path.string() + ": no campaign has been set up in it");
  }
  Contents contents;
  read_identity(database, contents);
  contents.document = Json::parse(database.text("SELECT document FROM campaign"));
  static_cast<Extent&>(contents) = extent_of(database);
  contents.backed_up_at = database.text(
      "SELECT at FROM event WHERE event_id = (SELECT max(event_id) FROM event) AND kind = 'backup'");
  return contents;
}

fs::path newest_backup(const fs::path& folder) { return folder / "backup.db"; }

fs::path previous_backup(const fs::path& folder) { return folder / "backup.previous.db"; }

void refuse_lost_database(const CampaignDirectory& directory) {
  require_regular(directory.database());
  std::error_code absent;
  const std::uintmax_t size = fs::file_size(directory.database(), absent);
  const std::string hint = restore_hint(directory);
  if (hint.empty() || (!absent && size > 0)) return;
  throw IntegrityError(
      fmt::format("{}: is {}, but there are backups of it{}, or move {} away to start afresh",
                  directory.database().string(), absent ? "gone" : "empty", hint, directory.root().string()));
}

// A sound database may be refused for another reason, and there a backup would not help.
std::string hint_if_damaged(const CampaignDirectory& directory) {
  try {
    examine(directory.database());
    return "";
  } catch (const IntegrityError&) {
    return restore_hint(directory);
  }
}

std::string restore_hint(const CampaignDirectory& directory) {
  const fs::path folder = directory.backup();
  if (kind_of(newest_backup(folder)).empty() && kind_of(previous_backup(folder)).empty()) return "";
  return fmt::format("; put the last one back with `peclet restore {} {}`", shell_word(folder.string()),
                     shell_word(directory.root().string()));
}

}  // namespace peclet::runner
