// Results, and the stop tests at them.
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

// The texts of results as engines wrote them, deflated (zlib, RFC 1950) against an earlier result of
// their point, of which they repeat every name and most of what does not fluctuate.
//
// `dictionary`: the other result, or nothing.
std::string deflated(std::string_view text, std::string_view dictionary);
// Throws IntegrityError when the bytes are not what deflated() made of some text with the same dictionary, or
// when the text exceeds what a result may have (excess_of()).
std::string inflated(std::string_view bytes, std::string_view dictionary);

// Stores the text of a result that has none yet. That of the first completed realisation becomes its point's
// dictionary, which stays for good, whatever becomes of that realisation.
void store_result_text(Connection& connection, std::int64_t point, int seed, std::string_view text,
                       bool completed);

// Whether the bytes were made with this dictionary, or with none.
bool was_deflated_with(std::string_view bytes, std::string_view dictionary);

// Returns the text of a result, from a query of `document` and `dictionary` of
// result LEFT JOIN dictionary USING (point_id), in these columns. Throws IntegrityError.
std::string result_text(const Statement& query, int document, int dictionary);

// What became of a result that was offered.
enum class Stored {
  stored,
  stored_apart,  // in the row of an engine that another one has replaced, now or before: no part of the
                 // campaign
  duplicate,     // the seed has this very content already
  conflict,      // the seed has another content: the point is now suspect
  mixed_engine,  // the point has results of another engine
  unknown_point
};

// The same, and what the result counts for; of a result that is stored only.
struct StoredResult {
  Stored what;
  Outcome outcome{};
  std::string cause{};     // see cause_of()
  std::int64_t point = 0;  // the row of its point, where it has one
  bool is_new = false;     // not known before
  std::string reason{};    // of a loss, in the engine's words
};

// The cause of a completed realisation that has no number for the campaign's observable: it is lost to its
// point as one that blew up is.
inline constexpr const char* no_value = "no-value";

// Returns how a realisation with this ending counts for a campaign that has seen this outcome in it.
inline std::string cause_of(const std::string& ending, const Outcome& outcome) {
  return has_results(ending) && outcome.is_lost() ? no_value : ending;
}
inline const char* state_of(const Outcome& outcome) {
  return to_string(outcome.is_lost() ? SeedState::failed : SeedState::done);
}

// The engine's row, new when it was never seen before; inside a Transaction of the caller. Throws ResultError
// when the provenance does not say what the engine is.
std::int64_t engine_row(Database& database, const Json& provenance);

class ResultStore {
 public:
  // Requires a Database of open_owner, which must outlive it. All is for use inside a Transaction of the
  // caller.
  explicit ResultStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // One without a number for the leading observable is lost with the cause no_value.
  StoredResult store(const RealisationResult& result, const Target& target);
  // The seed of a stored result is queued again; nothing of the result stays.
  void withdraw(std::int64_t point, int seed);
  // The stop tests at a point for the present target, in place of those that are stored.
  void store_stop_tests(std::int64_t point, const std::vector<StopTest>& stop_tests);

 private:
  void store_columns(std::int64_t point, const RealisationResult& result, const StoredResult& stored);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

}  // namespace peclet::runner
