#include "runner/store/result_store.h"

#include <fmt/format.h>

#include "runner/statistics/look_json.h"
#include "runner/store/number_store.h"
#include "runner/store/result_text.h"
#include "runner/text/plain_text.h"
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

StoredResult ResultStore::store(const RealisationResult& result, const Target& target) {
  Statement known(
      connection_,
      "SELECT point.point_id, coalesce(engine_identity, ''), content_sha256, state, kept_apart FROM point "
      "LEFT JOIN realisation ON realisation.point_id = point.point_id AND seed = ? WHERE hash = ? AND "
      "(kept_apart = 0 OR engine_identity = ?) ORDER BY kept_apart DESC");
  const std::string& identity = result.engine;
  known.bind(result.seed).bind(result.point).bind(identity);
  if (!known.step()) return {Stored::unknown_point};
  const std::int64_t point = known.integer(0);
  const bool apart = known.integer(4) != 0;
  const std::string other = known.text(1);
  if (!other.empty() && other != identity) {
    events_.write(
        "mixed-engine", point, result.seed,
        fmt::format("a result of engine {} is not taken: the point has results of {}", identity, other));
    return {Stored::mixed_engine};
  }
  if (!known.is_null(2)) {
    if (known.text(2) == result.content_sha256)
      return {apart ? Stored::stored_apart : Stored::duplicate, {}, "", point};
    Statement(connection_, "UPDATE point SET suspect = 1 WHERE point_id = ?").bind(point).run();
    events_.write("suspect", point, result.seed, "two runs of the same seed gave different results");
    return {Stored::conflict};
  }
  if (known.text(3) == "quarantined")
    events_.write("late-result", point, result.seed, "a quarantined seed has a result");
  const ResultNumbers numbers = numbers_of(result.document, target.observables());
  StoredResult stored{apart ? Stored::stored_apart : Stored::stored, numbers.outcome,
                      cause_of(result.cause, numbers.outcome), point, true};
  store_columns(point, result, stored);
  store_result_text(connection_, point, result.seed, result.text, result.completed());
  store_numbers(connection_, point, result.seed, numbers);
  if (stored.outcome.is_lost()) {
    stored.reason = plain(result.document.at("ending").value("message", ""));
    if (!stored.reason.empty()) events_.write("lost", point, result.seed, stored.reason);
  }
  for (const std::string& code : flags_of(result)) events_.write("flag", point, result.seed, code);
  Statement(connection_, "UPDATE point SET engine_identity = ? WHERE point_id = ?")
      .bind(identity)
      .bind(point)
      .run();
  return stored;
}

void ResultStore::store_columns(std::int64_t point, const RealisationResult& result,
                                const StoredResult& stored) {
  const Json& document = result.document;
  const Json& final_state = document.at("final_state_sha256");
  Statement(
      connection_,
      "INSERT OR REPLACE INTO realisation (point_id, seed, state, cause, timestep, equilibration_steps, "
      "production_steps, production_strain, statistical_inefficiency, largest_overlap, cpu_seconds, "
      "wall_seconds, final_state_sha256, content_sha256, engine_id) VALUES (?, ?, ?, ?, ?, ?, ?, ?, "
      "?, ?, ?, ?, ?, ?, ?)")
      .bind(point)
      .bind(result.seed)
      .bind(state_of(stored.outcome))
      .bind(stored.cause)
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
      .bind(engine_row(database_, document.at("engine")))
      .run();
}

void ResultStore::withdraw(std::int64_t point, int seed) {
  for (const char* const sql :
       {"DELETE FROM result WHERE point_id = ? AND seed = ?",
        "DELETE FROM numbers WHERE point_id = ? AND seed = ?",
        "DELETE FROM file WHERE point_id = ? AND seed = ?",
        "UPDATE realisation SET state = 'queued', cause = NULL, content_sha256 = NULL, "
        "final_state_sha256 = NULL WHERE point_id = ? AND seed = ?"}) {
    Statement(connection_, sql).bind(point).bind(seed).run();
  }
}

void ResultStore::store_looks(std::int64_t point, const std::vector<Look>& looks) {
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
      "transient, observables) SELECT ?1, target_id, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, "
      "?14, ?15 FROM campaign WHERE true ON CONFLICT DO UPDATE SET lost = ?3, count = ?4, mean = ?5, "
      "standard_error = ?6, "
      "half_width = ?7, uncontrolled_mean = ?8, uncontrolled_standard_error = ?9, uncontrolled_half_width = "
      "?10, verdict = ?11, made_at = ?12, skewness = ?13, transient = ?14, observables = ?15 WHERE count != "
      "?4 OR lost != ?3 OR "
      "mean IS NOT ?5 OR half_width IS NOT ?7 OR uncontrolled_mean IS NOT ?8 OR uncontrolled_half_width IS "
      "NOT ?10 OR verdict != ?11 OR skewness IS NOT ?13 OR transient != ?14 OR observables IS NOT ?15");
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
        .bind(look.each.empty() ? std::nullopt : std::optional(observables_json(look).dump()))
        .run();
  }
}

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
