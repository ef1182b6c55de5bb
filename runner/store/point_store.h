// Stores the campaign, its points, its events and its engine's vocabulary in the database.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/store/database.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// EventStore records what happened to a campaign, for good.
class EventStore {
 public:
  // Requires a connection that may write, which must outlive it. write() is for use inside a Transaction of
  // the caller.
  explicit EventStore(Connection& connection) : connection_(connection) {}

  // `request` is the name of the request that caused the event; "" if none did.
  void write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
             const std::string& message, const std::string& request = "");
  void write(const std::string& kind, const std::string& message) {
    write(kind, std::nullopt, std::nullopt, message);
  }
  // True if the request has been carried out or refused.
  bool has_answered(const std::string& request);

 private:
  Connection& connection_;
};

struct Prediction;

// PointStore applies a campaign file to a database that may have seen earlier versions of it.
class PointStore {
 public:
  // Requires a Database of open_owner(), which must outlive it. adopt() commits by itself; the others are for
  // use inside a Transaction of the caller.
  explicit PointStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Returns the campaign with the values that runs have chosen for its curves (keeping_chosen_values()).
  Campaign with_chosen_values(Campaign campaign);
  // Stores the campaign, its points in their order and its target. Points that are no longer in the sweep
  // stay, inactive. Throws InputError, with nothing written, if finished realisations lack the observable.
  void adopt(const Campaign& campaign);
  // Does as adopt() within the caller's transaction, which is to be rolled back if it throws.
  void take_over(const Campaign& campaign);
  void set_priority(std::int64_t point, int priority);
  void set_cancelled(std::int64_t point, bool cancelled);
  // Stores the first prediction of a point for the present target; later ones are ignored, because they know
  // more. Requires a prediction without an obstacle.
  void store_prediction(std::int64_t point, const Prediction& prediction, double cpu_seconds);
  // Sets the point's results aside: they stay stored, but no longer belong to the campaign. A row of `engine`
  // takes its place in the sweep; an earlier row of that engine is used again.
  void set_aside(const PointRecord& point, const std::string& engine);

 private:
  bool is_first() { return connection_.integer("SELECT count(*) FROM campaign") == 0; }
  std::int64_t adopt_target(const Campaign& campaign);
  void adopt_points(const Campaign& campaign);
  void observe_again(const Campaign& campaign);

  Database& database_;
  Connection& connection_;
  EventStore events_;
};

// Vocabulary holds the words, symbols and units that an engine gives for keys of the scene and derived
// numbers.
class Vocabulary {
 public:
  // Makes an empty vocabulary.
  Vocabulary() = default;
  // Takes the members "scene_schema" and "derived" of a checked_frame(), both optional, and leaves others
  // out.
  explicit Vocabulary(const Json& hello);

  // Returns {"pointer", "words", "symbol", "unit", "meaning"}: texts, "" where the engine says nothing.
  Json key(const std::string& pointer) const;
  // Returns the derived numbers in the order in which people look for them: [{"name", "words", "symbol",
  // "unit"}].
  Json derived() const { return document_.value("derived", Json::array()); }

  // Returns the two members as they are stored.
  const Json& document() const { return document_; }

 private:
  Json document_ = Json::object();
};

// Replaces the stored vocabulary, in a Transaction of its own.
void keep_vocabulary(Database& database, const Vocabulary& vocabulary);

// Returns the stored vocabulary; an empty one if no engine has given any.
Vocabulary kept_vocabulary(Database& database);

}  // namespace peclet::runner
