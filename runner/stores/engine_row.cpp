#include "runner/stores/engine_row.h"

#include "runner/folder/realisation_result.h"

namespace peclet::runner {

std::int64_t engine_row(Database& database, const Json& provenance) {
  Connection& connection = database.connection();
  const std::string text = canonical_json(provenance);
  Statement known(connection, "SELECT engine_id FROM engine WHERE provenance = ?");
  if (known.bind(text).step()) return known.integer(0);
  Statement(connection, "INSERT INTO engine (identity, provenance) VALUES (?, ?)")
      .bind(engine_identity(provenance))
      .bind(text)
      .run();
  return connection.last_insert_id();
}

}  // namespace peclet::runner
