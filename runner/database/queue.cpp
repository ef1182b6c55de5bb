#include "runner/database/queue.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>

#include "runner/database/result_text.h"
#include "runner/engines/attempt_report.h"
#include "runner/text/host_name.h"
#include "runner/text/utc_time.h"

namespace peclet::runner {
namespace {

template <typename Number>
std::optional<Number> number_at(const Json& document, const char* pointer) {
  const Json::json_pointer where(pointer);
  if (!document.contains(where) || !document.at(where).is_number()) return std::nullopt;
  return document.at(where).get<Number>();
}

}  // namespace

int Queue::recover() {
  Transaction recovery(connection_);
  connection_.execute("DELETE FROM lease");
  Statement(connection_, "UPDATE attempt SET outcome = 'abandoned', ended_at = ? WHERE outcome = 'running'")
      .bind(utc_now())
      .run();
  connection_.execute("UPDATE realisation SET state = 'queued' WHERE state = 'running'");
  const int count = connection_.changes();
  if (count > 0) {
    event("recovered", std::nullopt, std::nullopt,
          fmt::format("{} seeds of an owner that died are queued again", count));
  }
  recovery.commit();
  return count;
}

void Queue::enqueue(std::int64_t point, int end) {
  Statement(
      connection_,
      "WITH RECURSIVE seeds(seed) AS (SELECT 0 UNION ALL SELECT seed + 1 FROM seeds WHERE seed + 1 < ?) "
      "INSERT OR IGNORE INTO realisation (point_id, seed, state) SELECT ?, seed, 'queued' FROM seeds")
      .bind(end)
      .bind(point)
      .run();
}

std::int64_t Queue::begin_attempt(std::int64_t point, int seed, int worker, std::int64_t process,
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

void Queue::attempt_elsewhere(std::int64_t point, int seed, int task, const AttemptReport& report) {
  Statement(
      connection_,
      "INSERT INTO attempt (point_id, seed, worker, process, host, engine_id, started_at, ended_at, outcome, "
      "blamed, step, exit_status, signal, message) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(point)
      .bind(seed)
      .bind(task)
      .bind(report.process)
      .bind(report.host)
      .bind(engine(report.engine))
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

void Queue::renew_lease(std::int64_t attempt, const char* phase, std::int64_t step, std::int64_t steps,
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

void Queue::end_attempt(std::int64_t attempt, const AttemptEnd& end) {
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

std::vector<PastAttempt> Queue::history(std::int64_t point, int seed) {
  Statement query(
      connection_,
      "SELECT outcome, step FROM attempt WHERE point_id = ? AND seed = ? AND pardoned = 0 ORDER BY "
      "attempt_id");
  query.bind(point).bind(seed);
  std::vector<PastAttempt> history;
  while (query.step()) history.push_back({attempt_outcome(query.text(0)), query.integer(1)});
  return history;
}

bool Queue::has_ended(std::int64_t point, int seed) {
  Statement query(connection_,
                  "SELECT 1 FROM realisation WHERE point_id = ? AND seed = ? AND state IN ('done', 'failed', "
                  "'quarantined')");
  return query.bind(point).bind(seed).step();
}

void Queue::requeue(std::int64_t point, int seed) {
  Statement(connection_,
            "UPDATE realisation SET state = 'queued' WHERE point_id = ? AND seed = ? AND state = 'running'")
      .bind(point)
      .bind(seed)
      .run();
}

void Queue::quarantine(std::int64_t point, int seed, const std::string& cause) {
  Statement(
      connection_,
      "UPDATE realisation SET state = 'quarantined', cause = ? WHERE point_id = ? AND seed = ? AND state IN "
      "('queued', 'running')")
      .bind(cause)
      .bind(point)
      .bind(seed)
      .run();
  event("quarantined", point, seed, "given up: " + cause);
}

Stored Queue::store(const RealisationResult& result, const std::string& observable) {
  Statement known(
      connection_,
      "SELECT point.point_id, coalesce(engine_identity, ''), content_sha256, state, kept_apart FROM point "
      "LEFT JOIN realisation ON realisation.point_id = point.point_id AND seed = ? WHERE hash = ? AND "
      "(kept_apart = 0 OR engine_identity = ?) ORDER BY kept_apart DESC");
  const std::string identity = engine_identity(result.document.at("engine"));
  known.bind(result.seed).bind(result.point).bind(identity);
  if (!known.step()) return Stored::unknown_point;
  const std::int64_t point = known.integer(0);
  const bool apart = known.integer(4) != 0;
  const std::string other = known.text(1);
  if (!other.empty() && other != identity) {
    event("mixed-engine", point, result.seed,
          fmt::format("a result of engine {} is not taken: the point has results of {}", identity, other));
    return Stored::mixed_engine;
  }
  if (!known.is_null(2)) {
    if (known.text(2) == result.content_sha256) return apart ? Stored::stored_apart : Stored::duplicate;
    Statement(connection_, "UPDATE point SET suspect = 1 WHERE point_id = ?").bind(point).run();
    event("suspect", point, result.seed, "two runs of the same seed gave different results");
    return Stored::conflict;
  }
  if (known.text(3) == "quarantined")
    event("late-result", point, result.seed, "a quarantined seed has a result");
  store_numbers(point, result, observable, engine(result.document.at("engine")));
  for (const std::string& code : flags_of(result)) event("flag", point, result.seed, code);
  Statement(connection_, "UPDATE point SET engine_identity = ? WHERE point_id = ?")
      .bind(identity)
      .bind(point)
      .run();
  return apart ? Stored::stored_apart : Stored::stored;
}

void Queue::store_numbers(std::int64_t point, const RealisationResult& result, const std::string& observable,
                          std::int64_t engine) {
  const Json& document = result.document;
  const Observed observed = observe(document, observable);
  const Json& final_state = document.at("final_state_sha256");
  Statement(
      connection_,
      "INSERT OR REPLACE INTO realisation (point_id, seed, state, cause, value, control, timestep, "
      "equilibration_steps, production_steps, production_strain, statistical_inefficiency, largest_overlap, "
      "cpu_seconds, wall_seconds, final_state_sha256, content_sha256, engine_id, first_quarter, first_half) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(point)
      .bind(result.seed)
      .bind(to_string(observed.value ? SeedState::done : SeedState::failed))
      .bind(cause_of(result, observed))
      .bind(observed.value)
      .bind(observed.control)
      .bind(number_at<double>(document, "/timestep"))
      .bind(number_at<std::int64_t>(document, "/steps/equilibration"))
      .bind(number_at<std::int64_t>(document, "/steps/production"))
      .bind(number_at<double>(document, "/strain/production"))
      .bind(number_at<double>(document, "/statistical_inefficiency"))
      .bind(number_at<double>(document, "/largest_overlap"))
      .bind(number_at<double>(document, "/cost/cpu_seconds"))
      .bind(number_at<double>(document, "/cost/wall_seconds"))
      .bind(final_state.is_string() ? std::optional(final_state.get<std::string>()) : std::nullopt)
      .bind(result.content_sha256)
      .bind(engine)
      .bind(observed.first_quarter)
      .bind(observed.first_half)
      .run();
  Json without_engine = document;
  without_engine.erase("engine");
  store_result_text(connection_, point, result.seed, without_engine.dump(), result.completed());
}

void Queue::store_looks(std::int64_t point, const std::vector<Look>& looks) {
  // Looks only ever grow, except when a late result replaces a quarantined seed: then they are made again.
  Statement(connection_,
            "DELETE FROM look WHERE point_id = ? AND target_id = (SELECT target_id FROM campaign) AND "
            "seeds > ?")
      .bind(point)
      .bind(looks.empty() ? 0 : looks.back().seeds)
      .run();
  Statement insert(
      connection_,
      "INSERT INTO look (point_id, target_id, seeds, lost, count, mean, standard_error, half_width, "
      "uncontrolled_mean, uncontrolled_standard_error, uncontrolled_half_width, verdict, made_at, skewness, "
      "transient) SELECT ?1, target_id, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14 FROM "
      "campaign WHERE true ON CONFLICT DO UPDATE SET lost = ?3, count = ?4, mean = ?5, standard_error = ?6, "
      "half_width = ?7, uncontrolled_mean = ?8, uncontrolled_standard_error = ?9, uncontrolled_half_width = "
      "?10, verdict = ?11, made_at = ?12, skewness = ?13, transient = ?14 WHERE count != ?4 OR lost != ?3 OR "
      "mean IS NOT ?5 OR half_width IS NOT ?7 OR uncontrolled_mean IS NOT ?8 OR uncontrolled_half_width IS "
      "NOT ?10 OR verdict != ?11 OR skewness IS NOT ?13 OR transient != ?14");
  const std::string now = utc_now();
  for (const Look& look : looks) {
    insert.bind(point)
        .bind(look.seeds)
        .bind(look.lost)
        .bind(look.estimate.count)
        .bind(look.controlled.mean)
        .bind(look.controlled.standard_error)
        .bind(look.controlled_half_width)
        .bind(look.estimate.mean)
        .bind(look.estimate.standard_error)
        .bind(look.half_width)
        .bind(to_string(look.verdict))
        .bind(now)
        .bind(look.skewness)
        .bind(look.transient)
        .run();
  }
}

std::int64_t Queue::engine(const Json& provenance) {
  const std::string text = canonical_json(provenance);
  Statement known(connection_, "SELECT engine_id FROM engine WHERE provenance = ?");
  if (known.bind(text).step()) return known.integer(0);
  Statement(connection_, "INSERT INTO engine (identity, provenance) VALUES (?, ?)")
      .bind(engine_identity(provenance))
      .bind(text)
      .run();
  return connection_.last_insert_id();
}

void Queue::event(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
                  const std::string& message, const std::string& request) {
  Statement(connection_,
            "INSERT INTO event (at, kind, point_id, seed, message, request) VALUES (?, ?, ?, ?, ?, ?)")
      .bind(utc_now())
      .bind(kind)
      .bind(point)
      .bind(seed)
      .bind(message)
      .bind(request.empty() ? std::nullopt : std::optional<std::string>(request))
      .run();
}

}  // namespace peclet::runner
