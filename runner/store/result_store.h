// ResultStore stores results and the stop tests of points.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runner/store/database.h"
#include "runner/store/point_store.h"
#include "runner/store/realisation_result.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// Deflates the text of a result (zlib, RFC 1950). `dictionary` is the text of an earlier result of its point,
// or "". Results of a point share every name and most values that do not fluctuate.
std::string deflated(std::string_view text, std::string_view dictionary);
// Returns the text that deflated() was given. Throws IntegrityError if the bytes are damaged, the dictionary
// is another one, or the text is larger than largest_result.
std::string inflated(std::string_view bytes, std::string_view dictionary);

// Stores the text of a result that has none yet. The text of the first completed realisation becomes its
// point's dictionary, which stays even if that realisation is withdrawn.
void store_result_text(Connection& connection, std::int64_t point, int seed, std::string_view text,
                       bool completed);

// True if the bytes were deflated with this dictionary, or without one.
bool was_deflated_with(std::string_view bytes, std::string_view dictionary);

// Returns the text of a result from a query with the columns `document` and `dictionary` of result LEFT JOIN
// dictionary USING (point_id). Throws IntegrityError.
std::string result_text(const Statement& query, int document, int dictionary);

// Fate of an offered result.
enum class Stored {
  stored,
  stored_apart,  // its engine was set aside, so it is not part of the campaign; also for a repetition
  duplicate,     // the seed has this content already
  conflict,      // the seed has another content: the point is now suspect
  mixed_engine,  // the point has results of another engine
  unknown_point
};

// Fate of an offered result, and how it counts if it was stored.
struct StoredResult {
  Stored what;
  Outcome outcome{};
  std::string cause{};     // see cause_of()
  std::int64_t point = 0;  // row of its point, if it has one
  bool is_new = false;     // stored for the first time
  std::string reason{};    // reason of a loss in the engine's words
};

// Cause of a completed realisation without a number for the campaign's observable. It is lost to its point
// like one that blew up.
inline constexpr const char* no_value = "no-value";

// Returns the cause of a realisation with this ending and this outcome for the campaign.
inline std::string cause_of(const std::string& ending, const Outcome& outcome) {
  return has_results(ending) && outcome.is_lost() ? no_value : ending;
}
inline const char* state_of(const Outcome& outcome) {
  return to_string(outcome.is_lost() ? SeedState::failed : SeedState::done);
}

// Returns the row of an engine, a new one if the engine was never seen. For use inside a Transaction of the
// caller. Throws ResultError if the provenance does not say what the engine is.
std::int64_t engine_row(Database& database, const Json& provenance);

class ResultStore {
 public:
  // Requires a Database of open_owner(), which must outlive it. All functions are for use inside a
  // Transaction of the caller.
  explicit ResultStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Stores a result. A completed one without a number for the leading observable is lost with the cause
  // no_value.
  StoredResult store(const RealisationResult& result, const Target& target);
  // Removes the result of a seed and queues the seed again.
  void withdraw(std::int64_t point, int seed);
  // Replaces the stored stop tests of a point for the present target.
  void store_stop_tests(std::int64_t point, const std::vector<StopTest>& stop_tests);

 private:
  void store_columns(std::int64_t point, const RealisationResult& result, const StoredResult& stored);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

}  // namespace peclet::runner
