// The campaign, its points, its events and the words of its engine in the database.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/store/database.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// What happened to a campaign, for good.
class EventStore {
 public:
  // Requires a connection that may write, which must outlive it. write() is for use inside a Transaction of
  // the caller.
  explicit EventStore(Connection& connection) : connection_(connection) {}

  // `request`: the name of the request that caused it, "" when none did.
  void write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
             const std::string& message, const std::string& request = "");
  void write(const std::string& kind, const std::string& message) {
    write(kind, std::nullopt, std::nullopt, message);
  }
  // Whether the request has been carried out, or refused.
  bool has_answered(const std::string& request);

 private:
  Connection& connection_;
};

// The campaign and its points: what a campaign file means for a database that may have seen earlier versions
// of it.
struct Prediction;

class PointStore {
 public:
  // Requires a Database of open_owner, which must outlive it. adopt() commits by itself; the others are for
  // use inside a Transaction of the caller.
  explicit PointStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Makes the database that of `campaign`: its points in their order, its target. Points that are no longer
  // in the sweep stay, inactive. Throws InputError, with nothing written, when finished realisations lack the
  // observable.
  void adopt(const Campaign& campaign);
  // The same within the caller's transaction, which is to be rolled back when it throws.
  void take_over(const Campaign& campaign);
  void set_priority(std::int64_t point, int priority);
  void set_cancelled(std::int64_t point, bool cancelled);
  // Keeps the first prediction of a point for the present target: one that knows more is no test of the
  // first. Requires a prediction without an obstacle.
  void store_prediction(std::int64_t point, const Prediction& prediction, double cpu_seconds);
  // The point's results stay as they are, but no longer are the campaign's: a row of its own takes its place
  // in the sweep, that of `engine` when there has been one.
  void set_aside(const PointRecord& point, const std::string& engine);

 private:
  std::int64_t adopt_target(const Campaign& campaign);
  void adopt_points(const Campaign& campaign);
  void observe_again(const Campaign& campaign);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

class Vocabulary {
 public:
  // Knows no names.
  Vocabulary() = default;
  // From the members "scene_schema" and "derived" of a checked_frame(), both optional; other members are left
  // out.
  explicit Vocabulary(const Json& hello);

  // {"pointer", "words", "symbol", "unit", "meaning"}: texts, "" where the engine says nothing.
  Json key(const std::string& pointer) const;
  // Numbers by name in the order in which people look for them: [{"name", "words", "symbol", "unit"}].
  Json derived() const { return document_.value("derived", Json::array()); }

  // The two members, as they are kept.
  const Json& document() const { return document_; }

 private:
  Json document_ = Json::object();
};

// Replaces what an earlier engine has said; within a Transaction of its own.
void keep_vocabulary(Database& database, const Vocabulary& vocabulary);

// Knows no names in a campaign that no engine has spoken for.
Vocabulary kept_vocabulary(Database& database);

}  // namespace peclet::runner
