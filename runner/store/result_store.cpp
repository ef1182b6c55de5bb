#include "runner/store/result_store.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <new>
#include <stdexcept>

#include "contract/errors.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/number_store.h"

namespace peclet::runner {
namespace {

// zlib only reads its input, but takes it as a pointer to mutable bytes.
Bytef* bytes_of(std::string_view text) {
  return const_cast<Bytef*>(reinterpret_cast<const Bytef*>(text.data()));
}

uInt size_of(std::string_view text) { return static_cast<uInt>(text.size()); }

class Deflation {
 public:
  Deflation() {
    // Digits repeat by chance; such short matches are no gain, and the filtered strategy leaves them out.
    if (deflateInit2(&stream_, 5, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL - 1, Z_FILTERED) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Deflation() { deflateEnd(&stream_); }
  Deflation& operator=(Deflation&&) = delete;

  // Deflates as a stream does that has never run before.
  std::string run(std::string_view text, std::string_view dictionary) {
    if (deflateReset(&stream_) != Z_OK) throw std::logic_error("zlib cannot begin anew");
    if (!dictionary.empty() &&
        deflateSetDictionary(&stream_, bytes_of(dictionary), size_of(dictionary)) != Z_OK) {
      throw std::logic_error("zlib refuses a dictionary");
    }
    std::string bytes(deflateBound(&stream_, text.size()), '\0');
    stream_.next_in = bytes_of(text);
    stream_.avail_in = size_of(text);
    stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_out = size_of(bytes);
    if (deflate(&stream_, Z_FINISH) != Z_STREAM_END) {
      throw std::logic_error("zlib needs more than its own bound");
    }
    bytes.resize(stream_.total_out);
    return bytes;
  }

 private:
  z_stream stream_{};
};

class Inflation {
 public:
  Inflation() {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation& operator=(Inflation&&) = delete;

  std::string run(std::string_view bytes, std::string_view dictionary) {
    std::string text;
    std::array<char, 1 << 14> part{};
    stream_.next_in = bytes_of(bytes);
    stream_.avail_in = size_of(bytes);
    for (;;) {
      stream_.next_out = reinterpret_cast<Bytef*>(part.data());
      stream_.avail_out = static_cast<uInt>(part.size());
      const int code = inflate(&stream_, Z_NO_FLUSH);
      text.append(part.data(), part.size() - stream_.avail_out);
      if (text.size() > largest_result) {
        throw IntegrityError(fmt::format("inflates to more than {} bytes", largest_result));
      }
      if (code == Z_STREAM_END && stream_.avail_in == 0) return text;
      if (code == Z_NEED_DICT && is_taken(dictionary)) continue;
      if (code != Z_OK) throw IntegrityError(fmt::format("cannot be inflated: {}", reason(code)));
    }
  }

 private:
  // Gives the stream its dictionary. Returns false if the bytes were deflated with another one.
  bool is_taken(std::string_view dictionary) {
    return inflateSetDictionary(&stream_, bytes_of(dictionary), size_of(dictionary)) == Z_OK;
  }
  const char* reason(int code) const {
    if (code == Z_NEED_DICT) return "its point's dictionary is not the one that it was made with";
    if (code == Z_STREAM_END) return "something follows its end";
    if (code == Z_BUF_ERROR) return "its end is missing";
    return stream_.msg != nullptr ? stream_.msg : zError(code);
  }

  z_stream stream_{};
};

template <typename Number>
std::optional<Number> number_at(const Json& document, const char* pointer) {
  const Json::json_pointer where(pointer);
  if (!document.contains(where) || !document.at(where).is_number()) return std::nullopt;
  return document.at(where).get<Number>();
}

}  // namespace

std::string deflated(std::string_view text, std::string_view dictionary) {
  // A stream takes a quarter of a megabyte. If it were allocated for each result, the process would give its
  // memory back and fault it in again.
  thread_local Deflation deflation;
  return deflation.run(text, dictionary);
}

std::string inflated(std::string_view bytes, std::string_view dictionary) {
  return Inflation().run(bytes, dictionary);
}

// RFC 1950, 2.2: bit 5 of the second byte says that four more follow, with the dictionary's checksum.
bool was_deflated_with(std::string_view bytes, std::string_view dictionary) {
  constexpr std::size_t header = 6;
  constexpr unsigned has_dictionary = 0x20;
  if (bytes.size() < header || (static_cast<unsigned char>(bytes[1]) & has_dictionary) == 0) return true;
  uLong checksum = 0;
  for (std::size_t i = 2; i < header; ++i) checksum = checksum << 8U | static_cast<unsigned char>(bytes[i]);
  return checksum == adler32(adler32(0, nullptr, 0), bytes_of(dictionary), size_of(dictionary));
}

void store_result_text(Connection& connection, std::int64_t point, int seed, std::string_view text,
                       bool completed) {
  Statement known(connection, "SELECT text FROM dictionary WHERE point_id = ?", point);
  std::string dictionary;
  if (known.step()) {
    dictionary = known.text(0);
    known.step();
  } else if (completed) {
    dictionary = text;
    connection.run("INSERT INTO dictionary (point_id, text) VALUES (?, ?)", point, text);
  }
  const std::string bytes = deflated(text, dictionary);
  Statement(connection, "INSERT INTO result (point_id, seed, document) VALUES (?, ?, ?)", point, seed)
      .bind_blob(bytes)
      .run();
}

std::string result_text(const Statement& query, int document, int dictionary) {
  std::string text = inflated(query.text(document), query.text(dictionary));
  if (const std::string excess = excess_of(text); !excess.empty()) {
    throw IntegrityError("exceeds what this program stores: " + excess);
  }
  return text;
}

StoredResult ResultStore::store(const RealisationResult& result, const Target& target) {
  const std::string& identity = result.engine;
  Statement known(
      connection_,
      "SELECT point.point_id, coalesce(engine_identity, ''), content_sha256, state, set_aside FROM point "
      "LEFT JOIN realisation ON realisation.point_id = point.point_id AND seed = ? WHERE hash = ? AND "
      "(set_aside = 0 OR engine_identity = ?) ORDER BY set_aside DESC",
      result.seed, result.point, identity);
  if (!known.step()) return {Stored::unknown_point};
  const std::int64_t point = known.integer(0);
  const bool apart = known.flag(4);
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
    connection_.run("UPDATE point SET suspect = 1 WHERE point_id = ?", point);
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
  connection_.run("UPDATE point SET engine_identity = ? WHERE point_id = ?", identity, point);
  return stored;
}

void ResultStore::store_columns(std::int64_t point, const RealisationResult& result,
                                const StoredResult& stored) {
  const Json& document = result.document;
  const Json& final_state = document.at("final_state_sha256");
  connection_.run(
      "INSERT OR REPLACE INTO realisation (point_id, seed, state, cause, timestep, equilibration_steps, "
      "production_steps, production_strain, statistical_inefficiency, largest_overlap, cpu_seconds, "
      "wall_seconds, final_state_sha256, content_sha256, engine_id) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, ?, ?, ?)",
      point, result.seed, state_of(stored.outcome), stored.cause, number_at<double>(document, "/timestep"),
      number_at<std::int64_t>(document, "/steps/equilibration"),
      number_at<std::int64_t>(document, "/steps/production"),
      number_at<double>(document, "/strain/production"),
      number_at<double>(document, "/statistical_inefficiency"),
      number_at<double>(document, "/largest_overlap"), number_at<double>(document, "/cost/cpu_seconds"),
      number_at<double>(document, "/cost/wall_seconds"),
      final_state.is_string() ? std::optional(final_state.get<std::string>()) : std::nullopt,
      result.content_sha256, engine_row(database_, document.at("engine")));
}

void ResultStore::withdraw(std::int64_t point, int seed) {
  for (const char* const sql :
       {"DELETE FROM result WHERE point_id = ? AND seed = ?",
        "DELETE FROM numbers WHERE point_id = ? AND seed = ?",
        "DELETE FROM file WHERE point_id = ? AND seed = ?",
        "UPDATE realisation SET state = 'queued', cause = NULL, content_sha256 = NULL, "
        "final_state_sha256 = NULL WHERE point_id = ? AND seed = ?"}) {
    connection_.run(sql, point, seed);
  }
}

void ResultStore::store_stop_tests(std::int64_t point, const std::vector<StopTest>& stop_tests) {
  // Stop tests only grow in number, unless a late result replaces a quarantined seed; then they are made
  // again.
  connection_.run(
      "DELETE FROM stop_test WHERE point_id = ? AND target_id = (SELECT target_id FROM campaign) AND seeds > "
      "?",
      point, stop_tests.empty() ? 0 : stop_tests.back().seeds);
  Statement insert(
      connection_,
      "INSERT INTO stop_test (point_id, target_id, seeds, lost, count, mean, standard_error, half_width, "
      "plain_mean, plain_standard_error, plain_half_width, verdict, made_at, skewness, "
      "transient, observables) SELECT ?1, target_id, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, "
      "?14, ?15 FROM campaign WHERE true ON CONFLICT DO UPDATE SET lost = ?3, count = ?4, mean = ?5, "
      "standard_error = ?6, "
      "half_width = ?7, plain_mean = ?8, plain_standard_error = ?9, plain_half_width = "
      "?10, verdict = ?11, made_at = ?12, skewness = ?13, transient = ?14, observables = ?15 WHERE count != "
      "?4 OR lost != ?3 OR "
      "mean IS NOT ?5 OR half_width IS NOT ?7 OR plain_mean IS NOT ?8 OR plain_half_width IS "
      "NOT ?10 OR verdict != ?11 OR skewness IS NOT ?13 OR transient != ?14 OR observables IS NOT ?15");
  const std::string now = utc_now();
  for (const StopTest& stop_test : stop_tests) {
    insert.run(point, stop_test.seeds, stop_test.lost, stop_test.estimate.count, stop_test.controlled.mean,
               stop_test.controlled.standard_error, stop_test.controlled_half_width, stop_test.estimate.mean,
               stop_test.estimate.standard_error, stop_test.half_width, to_string(stop_test.verdict), now,
               stop_test.skewness, stop_test.transient,
               stop_test.each.empty() ? std::nullopt : std::optional(observables_json(stop_test).dump()));
  }
}

std::int64_t engine_row(Database& database, const Json& provenance) {
  Connection& connection = database.connection();
  const std::string text = canonical_json(provenance);
  Statement known(connection, "SELECT engine_id FROM engine WHERE provenance = ?", text);
  if (known.step()) return known.integer(0);
  connection.run("INSERT INTO engine (identity, provenance) VALUES (?, ?)", engine_identity(provenance),
                 text);
  return connection.last_insert_id();
}

}  // namespace peclet::runner
