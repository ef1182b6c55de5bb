#include "runner/database/migration.h"

#include <fmt/format.h>

#include <filesystem>

#include "contract/durable_file.h"
#include "contract/integrity_error.h"
#include "runner/database/campaign_sql.h"
#include "runner/database/database_copy.h"
#include "runner/database/number_book.h"
#include "runner/database/result_text.h"
#include "runner/folder/realisation_result.h"

namespace peclet::runner {
namespace {

void drop_views(Connection& connection) {
  for (const char* const view : {"points", "realisations", "estimates", "files"}) {
    connection.execute(fmt::format("DROP VIEW IF EXISTS {}", view));
  }
}

bool has_column(Connection& connection, const char* table, const char* column) {
  Statement query(connection, "SELECT 1 FROM pragma_table_info(?) WHERE name = ?");
  return query.bind(table).bind(column).step();
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

// What version 6 did not take from the results. One that cannot be read stays without numbers: the doctor
// says so, and has the seed run again.
void take_numbers(Connection& connection) {
  Statement stored(connection,
                   "SELECT document, text, point_id, seed FROM result LEFT JOIN dictionary USING (point_id)");
  while (stored.step()) {
    try {
      const Json result = Json::parse(result_text(stored, 0, 1));
      store_numbers(connection, stored.integer(2), static_cast<int>(stored.integer(3)), result);
    } catch (const IntegrityError&) {
      continue;
    } catch (const Json::exception&) {
      continue;
    }
  }
}

void change_tables(Connection& connection, std::int64_t from) {
  Transaction migration(connection);
  drop_views(connection);
  if (from < 2) {
    connection.execute(version_2_sql);
    take_parts_of_windows(connection);
  }
  if (from < 3) connection.execute(version_3_sql);
  if (from < 4) connection.execute(version_4_sql);
  if (from < 5) connection.execute(version_5_sql);
  if (from < 6) {
    if (has_column(connection, "target", "criterion"))
      connection.execute("ALTER TABLE target RENAME COLUMN criterion TO relative_tolerance");
    connection.execute(version_6_sql);
  }
  if (from < 7) {
    connection.execute(version_7_sql);
    take_numbers(connection);
  }
  connection.execute(views_sql);
  if (const std::string found = damage(connection); !found.empty()) {
    throw IntegrityError(fmt::format("{}: could not be brought up to date: {}", connection.path(), found));
  }
  migration.commit();
}

}  // namespace

void migrate(Connection& connection, std::int64_t from) {
  // An earlier attempt, or an earlier database, may have left a copy.
  copy_database(connection.path(), free_name(fmt::format("{}.version-{}", connection.path(), from)),
                [](Connection&) {});
  // A table is made again under its own name, to which others refer: references are looked at afterwards
  // instead. The setting cannot be changed within a transaction, and is meant for this connection's life.
  connection.execute("PRAGMA foreign_keys = OFF");
  change_tables(connection, from);
  connection.execute("PRAGMA foreign_keys = ON");
}

}  // namespace peclet::runner
