#include "runner/store/seed_store.h"

#include <fmt/format.h>

#include "runner/campaign/number_text.h"
#include "runner/store/locks.h"
#include "runner/store/result_store.h"

namespace peclet::runner {

int SeedStore::recover() {
  Transaction recovery(connection_);
  connection_.execute("DELETE FROM lease");
  connection_.run("UPDATE attempt SET outcome = 'abandoned', ended_at = ? WHERE outcome = 'running'",
                  utc_now());
  const int count = connection_.run("UPDATE realisation SET state = 'queued' WHERE state = 'running'");
  if (count > 0) {
    events_.write("recovered", fmt::format("{} seeds of an owner that died are queued again", count));
  }
  recovery.commit();
  return count;
}

void SeedStore::enqueue(std::int64_t point, int end) {
  connection_.run(
      "WITH RECURSIVE seeds(seed) AS (SELECT 0 UNION ALL SELECT seed + 1 FROM seeds WHERE seed + 1 < ?) "
      "INSERT OR IGNORE INTO realisation (point_id, seed, state) SELECT ?, seed, 'queued' FROM seeds",
      end, point);
}

std::int64_t SeedStore::add_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                                    const std::string& host, std::int64_t engine,
                                    const std::string& started_at) {
  connection_.run(
      "INSERT INTO attempt (point_id, seed, worker, process, host, engine_id, started_at) "
      "VALUES (?, ?, ?, ?, ?, ?, ?)",
      point, seed, worker, process, host, engine, started_at);
  return connection_.last_insert_id();
}

std::int64_t SeedStore::begin_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
                                      std::int64_t engine) {
  const std::string now = utc_now();
  connection_.run(
      "INSERT INTO realisation (point_id, seed, state) VALUES (?, ?, 'running') "
      "ON CONFLICT DO UPDATE SET state = 'running', cause = NULL",
      point, seed);
  const std::int64_t attempt = add_attempt(point, seed, worker, process, host_name(), engine, now);
  connection_.run(
      "INSERT INTO lease (point_id, seed, attempt_id, worker, phase, step, steps, strain, "
      "renewed_at) VALUES (?, ?, ?, ?, 'starting', 0, 0, 0, ?)",
      point, seed, attempt, worker, now);
  return attempt;
}

void SeedStore::attempt_elsewhere(std::int64_t point, int seed, int task, const AttemptReport& report) {
  const std::int64_t engine = engine_row(database_, report.engine);
  end_attempt(add_attempt(point, seed, task, report.process, report.host, engine, report.started_at), report);
}

void SeedStore::renew_lease(std::int64_t attempt, const char* phase, std::int64_t step, std::int64_t steps,
                            double strain) {
  connection_.run(
      "UPDATE lease SET phase = ?, step = ?, steps = ?, strain = ?, renewed_at = ? WHERE attempt_id = ?",
      phase, step, steps, strain, utc_now(), attempt);
}

void SeedStore::end_attempt(std::int64_t attempt, const AttemptEnd& end) {
  connection_.run(
      "UPDATE attempt SET outcome = ?, blamed = ?, ended_at = ?, step = ?, exit_status = ?, "
      "signal = ?, message = ? WHERE attempt_id = ?",
      to_string(end.outcome), end.blamed(), utc_now(), end.step, end.ending.status, end.ending.signal,
      unless_empty(end.message), attempt);
  connection_.run("DELETE FROM lease WHERE attempt_id = ?", attempt);
}

std::vector<PastAttempt> SeedStore::history(std::int64_t point, int seed) {
  Statement query(
      connection_,
      "SELECT outcome, step, blamed FROM attempt WHERE point_id = ? AND seed = ? AND pardoned = 0 "
      "ORDER BY attempt_id",
      point, seed);
  return query.rows([](const Statement& row) {
    const AttemptOutcome outcome = attempt_outcome(row.text(0));
    return PastAttempt{outcome, row.integer(1), is_blamed(outcome) && !row.flag(2)};
  });
}

std::vector<KnownSeed> SeedStore::seeds_with_deaths() {
  Statement query(
      connection_,
      "SELECT DISTINCT a.point_id, a.seed FROM attempt a JOIN realisation r USING (point_id, seed) "
      "WHERE a.outcome IN ('crashed', 'hung', 'garbled', 'killed') AND a.pardoned = 0 AND "
      "r.state IN ('queued', 'running')");
  return query.rows([](const Statement& row) { return KnownSeed{row.integer(0), row.number(1)}; });
}

bool SeedStore::has_ended(std::int64_t point, int seed) {
  Statement query(connection_,
                  "SELECT 1 FROM realisation WHERE point_id = ? AND seed = ? AND state IN "
                  "('done', 'failed', 'quarantined')",
                  point, seed);
  return query.step();
}

void SeedStore::requeue(std::int64_t point, int seed) {
  connection_.run(
      "UPDATE realisation SET state = 'queued' WHERE point_id = ? AND seed = ? AND state = 'running'", point,
      seed);
}

void SeedStore::quarantine(std::int64_t point, int seed, const std::string& cause) {
  connection_.run(
      "UPDATE realisation SET state = 'quarantined', cause = ? WHERE point_id = ? AND seed = ? AND state IN "
      "('queued', 'running')",
      cause, point, seed);
  events_.write("quarantined", point, seed, "given up: " + cause);
}

bool SeedStore::retry(std::int64_t point, int seed) {
  const int queued = connection_.run(
      "UPDATE realisation SET state = 'queued', cause = NULL WHERE point_id = ? AND seed = ? AND state = "
      "'quarantined'",
      point, seed);
  if (queued == 0) return false;
  connection_.run("UPDATE attempt SET pardoned = 1 WHERE point_id = ? AND seed = ?", point, seed);
  return true;
}

}  // namespace peclet::runner
