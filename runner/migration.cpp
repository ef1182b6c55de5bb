#include "runner/migration.h"

#include <fmt/format.h>

#include <filesystem>

#include "runner/campaign_sql.h"
#include "runner/database_copy.h"
#include "runner/realisation_result.h"

namespace peclet::runner {
namespace {

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
  const std::filesystem::path kept = fmt::format("{}.version-{}", connection.path(), from);
  if (!std::filesystem::exists(kept)) copy_database(connection.path(), kept, [](Connection&) {});
  Transaction migration(connection);
  if (from < 2) {
    connection.execute(version_2_sql);
    take_parts_of_windows(connection);
  }
  remake_views(connection);
  migration.commit();
}

}  // namespace peclet::runner
