#include "runner/store/seed_store.h"

#include <fmt/format.h>

#include "runner/campaign/number_text.h"
#include "runner/store/blame.h"
#include "runner/store/locks.h"
#include "runner/store/result_store.h"

namespace peclet::runner {

int SeedStore::recover() {
  Transaction recovery(connection_);
  connection_.execute("DELETE FROM lease");
  Statement(connection_, "UPDATE attempt SET outcome = 'abandoned', ended_at = ? WHERE outcome = 'running'")
      .bind(utc_now())
      .run();
  connection_.execute("UPDATE realisation SET state = 'queued' WHERE state = 'running'");
  const int count = connection_.changes();
  if (count > 0) {
    events_.write("recovered", std::nullopt, std::nullopt,
                  fmt::format("{} seeds of an owner that died are queued again", count));
  }
  recovery.commit();
  return count;
}

void SeedStore::enqueue(std::int64_t point, int end) {
  Statement(
      connection_,
      "WITH RECURSIVE seeds(seed) AS (SELECT 0 UNION ALL SELECT seed + 1 FROM seeds WHERE seed + 1 < ?) "
      "INSERT OR IGNORE INTO realisation (point_id, seed, state) SELECT ?, seed, 'queued' FROM seeds")
      .bind(end)
      .bind(point)
      .run();
}

std::int64_t SeedStore::begin_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                                      std::int64_t engine) {
  const std::string now = utc_now();
  Statement(connection_,
            "INSERT INTO realisation (point_id, seed, state) VALUES (?, ?, 'running') "
            "ON CONFLICT DO UPDATE SET state = 'running', cause = NULL")
      .bind(point)
      .bind(seed)
      .run();
  Statement(connection_,
            "INSERT INTO attempt (point_id, seed, worker, process, host, engine_id, started_at) "
            "VALUES (?, ?, ?, ?, ?, ?, ?)")
      .bind(point)
      .bind(seed)
      .bind(worker)
      .bind(process)
      .bind(host_name())
      .bind(engine)
      .bind(now)
      .run();
  const std::int64_t attempt = connection_.last_insert_id();
  Statement(connection_,
            "INSERT INTO lease (point_id, seed, attempt_id, worker, phase, step, steps, strain, "
            "renewed_at) VALUES (?, ?, ?, ?, 'starting', 0, 0, 0, ?)")
      .bind(point)
      .bind(seed)
      .bind(attempt)
      .bind(worker)
      .bind(now)
      .run();
  return attempt;
}

void SeedStore::attempt_elsewhere(std::int64_t point, int seed, int task, const AttemptReport& report) {
  Statement(
      connection_,
      "INSERT INTO attempt (point_id, seed, worker, process, host, engine_id, started_at, ended_at, outcome, "
      "blamed, step, exit_status, signal, message) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(point)
      .bind(seed)
      .bind(task)
      .bind(report.process)
      .bind(report.host)
      .bind(engine_row(database_, report.engine))
      .bind(report.started_at)
      .bind(utc_now())
      .bind(to_string(report.outcome))
      .bind(is_blamed(report.outcome))
      .bind(report.step)
      .bind(report.ending.status)
      .bind(report.ending.signal)
      .bind(report.message.empty() ? std::nullopt : std::optional<std::string>(report.message))
      .run();
}

void SeedStore::renew_lease(std::int64_t attempt, const char* phase, std::int64_t step, std::int64_t steps,
                            double strain) {
  Statement(
      connection_,
      "UPDATE lease SET phase = ?, step = ?, steps = ?, strain = ?, renewed_at = ? WHERE attempt_id = ?")
      .bind(phase)
      .bind(step)
      .bind(steps)
      .bind(strain)
      .bind(utc_now())
      .bind(attempt)
      .run();
}

void SeedStore::end_attempt(std::int64_t attempt, const AttemptEnd& end) {
  Statement(connection_,
            "UPDATE attempt SET outcome = ?, blamed = ?, ended_at = ?, step = ?, exit_status = ?, "
            "signal = ?, message = ? WHERE attempt_id = ?")
      .bind(to_string(end.outcome))
      .bind(is_blamed(end.outcome))
      .bind(utc_now())
      .bind(end.step)
      .bind(end.ending.status)
      .bind(end.ending.signal)
      .bind(end.message.empty() ? std::nullopt : std::optional<std::string>(end.message))
      .bind(attempt)
      .run();
  Statement(connection_, "DELETE FROM lease WHERE attempt_id = ?").bind(attempt).run();
}

std::vector<PastAttempt> SeedStore::history(std::int64_t point, int seed) {
  Statement query(
      connection_,
      "SELECT outcome, step FROM attempt WHERE point_id = ? AND seed = ? AND pardoned = 0 ORDER BY "
      "attempt_id");
  query.bind(point).bind(seed);
  std::vector<PastAttempt> history;
  while (query.step()) history.push_back({attempt_outcome(query.text(0)), query.integer(1)});
  return history;
}

bool SeedStore::has_ended(std::int64_t point, int seed) {
  Statement query(connection_,
                  "SELECT 1 FROM realisation WHERE point_id = ? AND seed = ? AND state IN ('done', 'failed', "
                  "'quarantined')");
  return query.bind(point).bind(seed).step();
}

void SeedStore::requeue(std::int64_t point, int seed) {
  Statement(connection_,
            "UPDATE realisation SET state = 'queued' WHERE point_id = ? AND seed = ? AND state = 'running'")
      .bind(point)
      .bind(seed)
      .run();
}

void SeedStore::quarantine(std::int64_t point, int seed, const std::string& cause) {
  Statement(
      connection_,
      "UPDATE realisation SET state = 'quarantined', cause = ? WHERE point_id = ? AND seed = ? AND state IN "
      "('queued', 'running')")
      .bind(cause)
      .bind(point)
      .bind(seed)
      .run();
  events_.write("quarantined", point, seed, "given up: " + cause);
}

bool SeedStore::retry(std::int64_t point, int seed) {
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

}  // namespace peclet::runner
