#include "runner/store/database_audit.h"

#include "contract/integrity_error.h"
#include "runner/store/result_text.h"

namespace peclet::runner {

int unreadable_results(Database& database, std::int64_t point) {
  Statement stored(
      database.connection(),
      "SELECT document, text FROM result LEFT JOIN dictionary USING (point_id) WHERE point_id = ?");
  stored.bind(point);
  int unreadable = 0;
  while (stored.step()) {
    if (!was_deflated_with(stored.text(0), stored.text(1))) ++unreadable;
  }
  return unreadable;
}

std::string readable_result(Database& database, std::int64_t point, int seed) {
  Statement stored(
      database.connection(),
      "SELECT document, text FROM result LEFT JOIN dictionary USING (point_id) WHERE point_id = ? "
      "AND seed = ?");
  if (!stored.bind(point).bind(seed).step()) return "";
  try {
    return result_text(stored, 0, 1);
  } catch (const IntegrityError&) {
    return stored.text(0);
  }
}

StateFaults state_faults(Database& database) {
  Connection& connection = database.connection();
  return {
      connection.integer("SELECT count(*) FROM result JOIN realisation USING (point_id, seed) WHERE state "
                         "NOT IN ('done', 'failed')"),
      connection.integer(
          "SELECT (SELECT count(*) FROM lease LEFT JOIN realisation USING (point_id, seed) WHERE state IS "
          "NOT 'running') + (SELECT count(*) FROM realisation LEFT JOIN lease USING (point_id, seed) WHERE "
          "state = 'running' AND attempt_id IS NULL)"),
      connection.integer("SELECT count(*) FROM realisation WHERE state = 'running'")};
}

ClockFaults clock_faults(Database& database, const std::string& now) {
  Connection& connection = database.connection();
  Statement future(connection,
                   "SELECT (SELECT count(*) FROM event WHERE at > ?1) + (SELECT count(*) FROM attempt WHERE "
                   "started_at > ?1)");
  future.bind(now).step();
  return {connection.integer(
              "SELECT count(*) FROM event a JOIN event b ON b.event_id = a.event_id + 1 WHERE b.at < a.at"),
          connection.integer("SELECT count(*) FROM attempt WHERE ended_at < started_at"), future.integer(0)};
}

}  // namespace peclet::runner
