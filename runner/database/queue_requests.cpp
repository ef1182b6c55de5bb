// What people ask of single points and seeds, in the database.
#include <fmt/format.h>

#include "runner/database/queue.h"

namespace peclet::runner {

void Queue::set_priority(std::int64_t point, int priority) {
  Statement(connection_, "UPDATE point SET priority = ? WHERE point_id = ?").bind(priority).bind(point).run();
}

void Queue::set_cancelled(std::int64_t point, bool cancelled) {
  Statement(connection_, "UPDATE point SET cancelled = ? WHERE point_id = ?")
      .bind(cancelled)
      .bind(point)
      .run();
}

bool Queue::retry(std::int64_t point, int seed) {
  Statement(
      connection_,
      "UPDATE realisation SET state = 'queued', cause = NULL WHERE point_id = ? AND seed = ? AND state = "
      "'quarantined'")
      .bind(point)
      .bind(seed)
      .run();
  if (connection_.changes() == 0) return false;
  Statement(connection_, "UPDATE attempt SET pardoned = 1 WHERE point_id = ? AND seed = ?")
      .bind(point)
      .bind(seed)
      .run();
  return true;
}

void Queue::keep_apart(const PointRecord& point, const std::string& engine) {
  Statement(connection_, "UPDATE point SET place = NULL, kept_apart = 1 WHERE point_id = ?")
      .bind(point.id)
      .run();
  // What the engine did for the scene before, if it did, is the campaign's again. The row is the engine's
  // from now on, not only from its first result on: the one that was replaced must not take it up.
  Statement(connection_,
            "INSERT INTO point (hash, scene, settings, label, place, engine_identity, priority, cancelled) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT (hash, engine_identity) DO UPDATE SET "
            "kept_apart = 0, settings = ?3, label = ?4, place = ?5, priority = ?7, cancelled = ?8")
      .bind(point.hash)
      .bind(canonical_json(point.scene))
      .bind(canonical_json(point.settings))
      .bind(point.label)
      .bind(*point.place)
      .bind(engine)
      .bind(point.priority)
      .bind(point.cancelled)
      .run();
  event("engine-accepted", point.id, std::nullopt,
        fmt::format("results of engine {} are kept apart; engine {} takes the point up",
                    point.engine_identity, engine));
}

bool Queue::has_answered(const std::string& request) {
  Statement query(connection_, "SELECT 1 FROM event WHERE request = ?");
  return query.bind(request).step();
}

}  // namespace peclet::runner
