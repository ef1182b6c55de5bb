#include "runner/migration.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>

#include "contract/durable_file.h"
#include "runner/campaign_sql.h"
#include "runner/realisation_result.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Through SQLite, so that what is still in the write-ahead log is part of the copy.
void copy_database(Connection& source, const fs::path& target) {
  if (fs::exists(target)) return;
  const fs::path unfinished = target.string() + ".tmp";
  fs::remove(unfinished);
  {
    Connection copy(unfinished.string(), Connection::Access::create, 0);
    sqlite3_backup* const backup = sqlite3_backup_init(copy.handle(), "main", source.handle(), "main");
    if (backup != nullptr) sqlite3_backup_step(backup, -1);
    if (backup == nullptr || sqlite3_backup_finish(backup) != SQLITE_OK) {
      throw DatabaseError(fmt::format("{}: {}", unfinished.string(), sqlite3_errmsg(copy.handle())),
                          sqlite3_extended_errcode(copy.handle()));
    }
  }
  rename_durably(unfinished, target);
}

void remake_views(Connection& connection) {
  for (const char* const view : {"points", "realisations", "estimates"}) {
    connection.execute(fmt::format("DROP VIEW {}", view));
  }
  connection.execute(views_sql);
}

// What version 1 did not take from the results.
void take_parts_of_windows(Connection& connection) {
  Statement done(connection,
                 "SELECT point_id, seed, document, (SELECT observable FROM campaign JOIN target USING "
                 "(target_id)) FROM result JOIN realisation USING (point_id, seed) WHERE state = 'done'");
  Statement change(
      connection, "UPDATE realisation SET first_quarter = ?, first_half = ? WHERE point_id = ? AND seed = ?");
  while (done.step()) {
    const Observed observed = observe(Json::parse(done.text(2)), done.text(3));
    change.bind(observed.first_quarter)
        .bind(observed.first_half)
        .bind(done.integer(0))
        .bind(done.integer(1))
        .run();
  }
}

}  // namespace

void migrate(Connection& connection, std::int64_t from) {
  copy_database(connection, fmt::format("{}.version-{}", connection.path(), from));
  Transaction migration(connection);
  if (from < 2) {
    connection.execute(version_2_sql);
    take_parts_of_windows(connection);
  }
  remake_views(connection);
  migration.commit();
}

}  // namespace peclet::runner
