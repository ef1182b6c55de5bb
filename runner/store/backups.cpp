#include "runner/store/backups.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <system_error>
#include <thread>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/store/database.h"

namespace peclet::runner {
namespace {

// Size of a portion and pause after it, because the owner's commits go to the same disk.
constexpr std::int64_t bytes_at_a_time = 1 << 20;
constexpr std::chrono::milliseconds breath{1};

// SQLite's files beside a database.
constexpr std::array<const char*, 4> companions{"", "-journal", "-wal", "-shm"};

// Returns NAME.PROCESS.COUNT.tmp as write_durably() does, so that leftovers of a dead process are found.
fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> count{0};
  return fmt::format("{}.{}.{}.tmp", path.string(), getpid(), count++);
}

void remove_database(const fs::path& path) {
  std::error_code ignored;  // a worse error is on its way
  for (const char* const suffix : companions) fs::remove(path.string() + suffix, ignored);
}

void copy_pages(Connection& from, Connection& to) {
  // One snapshot for all steps: otherwise every commit of the owner would start the copy again.
  const Transaction snapshot(from, Transaction::Kind::snapshot);
  from.integer("SELECT count(*) FROM sqlite_schema");
  errno = 0;  // an older value would be taken for the reason of a failure
  const std::unique_ptr<sqlite3_backup, int (*)(sqlite3_backup*)> backup(
      sqlite3_backup_init(to.handle(), "main", from.handle(), "main"), sqlite3_backup_finish);
  if (!backup) to.fail("copying " + from.path());
  const auto pages = static_cast<int>(bytes_at_a_time / from.integer("PRAGMA page_size"));
  int code = SQLITE_OK;
  for (;;) {
    errno = 0;
    code = sqlite3_backup_step(backup.get(), pages);
    if (code != SQLITE_OK) break;
    std::this_thread::sleep_for(breath);
  }
  if (code != SQLITE_DONE) to.fail("copying " + from.path(), code);
}

void write_copy(Connection& source, const fs::path& to) {
  Connection copy(to.string(), Connection::Access::create, 0);
  // The copy is not read before it is published, and a torn copy is thrown away: it needs no journal.
  copy.execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF");
  copy_pages(source, copy);
}

void finish_copy(const fs::path& path, const std::function<void(Connection&)>& amend) {
  Connection copy(path.string(), Connection::Access::read_write, 0);
  copy.execute("PRAGMA synchronous = OFF; PRAGMA journal_mode = DELETE");
  if (amend) amend(copy);
  if (const std::string found = damage(copy); !found.empty()) {
    throw IntegrityError(fmt::format("the database is damaged, and its copy is not kept: {}", found));
  }
}

// The origin consists of what never changes: the time of setup and the first point.
void read_identity(Connection& database, Contents& contents) {
  contents.name = database.text("SELECT name FROM campaign");
  contents.created_at = database.text("SELECT created_at FROM campaign");
  contents.origin = database.text(
      "SELECT created_at || ' ' || (SELECT hash FROM point ORDER BY point_id LIMIT 1) FROM campaign");
}

}  // namespace

std::string damage(Connection& connection) {
  if (std::string found = connection.text("PRAGMA integrity_check(1)"); found != "ok") {
    std::replace(found.begin(), found.end(), '\n', ' ');
    return found;
  }
  // References can be checked only if all tables are ours.
  try {
    check_tables(connection);
  } catch (const IntegrityError& error) {
    return error.what();
  }
  Statement references(connection, "PRAGMA foreign_key_check");
  if (!references.step()) return "";
  return fmt::format("a row of the table {} refers to one of {} that is not there", references.text(0),
                     references.text(2));
}

void copy_database(const fs::path& from, const fs::path& to,
                   const std::function<void(Connection& copy)>& amend) {
  Connection source(from.string(), Connection::Access::read_only, 10'000);
  copy_database(source, to, amend);
}

void copy_database(Connection& from, const fs::path& to, const std::function<void(Connection& copy)>& amend) {
  const fs::path temporary = temporary_name(to);
  try {
    write_copy(from, temporary);
    finish_copy(temporary, amend);
    rename_durably(temporary, to);
  } catch (...) {
    remove_database(temporary);
    throw;
  }
}

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

Contents examine(const fs::path& path) {
  Connection database(path.string(), Connection::Access::read_only, 10'000);
  if (!is_campaign_database(database)) {
    throw IntegrityError(path.string() + ": is not the database of a peclet campaign");
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

// A sound database may be refused for another reason; a backup would not help then.
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
