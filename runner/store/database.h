// Database opens a campaign's database safely and reads it.
//
// One process writes: it holds campaign.lock and opens with open_owner(). Any number of others read with
// open_reader(). The stores write: point_store, seed_store, result_store and others. The tables are those of
// schema/campaign.sql; no other folder has SQL.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "contract/json.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/statistics/forecast.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// Texts of schema/*.sql.
extern const char* const campaign_sql;  // tables
extern const char* const views_sql;     // views for people

enum class SeedState { queued, running, done, failed, quarantined };
const char* to_string(SeedState state);
SeedState seed_state(const std::string& text);

struct PointRecord {
  std::int64_t id = 0;
  std::optional<int> place;  // in the sweep; absent if it is no longer part of it
  std::string hash;
  Json scene;
  Json settings;
  std::string label;
  std::string engine_identity;  // "" before the first result, unless it was accepted by name
  bool suspect = false;         // a seed gave two different results
  int priority = 0;             // points of higher priority are served first
  bool cancelled = false;       // gets no more seeds
  bool set_aside = false;       // its engine was replaced by name; another row is the scene's point
};

// A seed with the columns taken from its result. Undefined numbers are absent.
struct RealisationRecord {
  int seed = 0;
  SeedState state = SeedState::queued;
  std::string cause;  // "completed", "overlap", ..., "crashed"; empty while queued or running
  std::optional<double> statistical_inefficiency, largest_overlap, cpu_seconds, wall_seconds;
  std::string final_state_sha256, content_sha256;
  std::optional<std::int64_t> engine;
};

struct StateCounts {
  int queued = 0, running = 0, done = 0, failed = 0, quarantined = 0;
  double cpu_seconds = 0;  // processor time of the seeds that have ended
  int& of(SeedState state) {
    return *std::array{&queued, &running, &done, &failed, &quarantined}.at(static_cast<std::size_t>(state));
  }
  int terminal() const { return done + failed + quarantined; }
};

struct AttemptRecord {
  int seed = 0;
  int worker = 0;
  std::int64_t process = 0;
  std::string host, started_at, ended_at;  // ended_at is empty while it runs
  std::string outcome;                     // listed in schema/campaign.sql
  bool blamed = false;
  bool pardoned = false;  // made before a retry: no longer counts
  std::int64_t step = 0;
  std::optional<std::int64_t> exit_status, signal;
  std::string message;
};

// Time span of an attempt. A running one ends at its last news.
struct AttemptSpan {
  std::int64_t point = 0;
  int seed = 0, worker = 0;
  std::string host, began, ended, outcome;
};

struct MeanSteps {
  double equilibration = 0, production = 0;
};

struct LeaseRecord {
  int seed = 0;
  int worker = 0;
  std::string phase;
  std::int64_t step = 0, steps = 0;
  double strain = 0;
  std::string renewed_at;
};

struct TargetRecord {
  std::int64_t id = 0;
  Target target;
  int minimum = 0, maximum = 0;

  // Returns the confidence level of every interval that is shown for a point.
  double level() const { return adjusted_confidence(target.confidence, minimum, maximum); }
};

struct StopTestRecord {
  TargetRecord target;
  StopTest stop_test;
  std::string made_at;
};

// A prediction that was stored before the seeds ran, to be compared with what they gave.
struct StoredPrediction {
  int pilot = 0;           // seeds used
  Expected<int> seeds;     // seeds of the deciding stop test
  double cpu_seconds = 0;  // processor time of one seed
  std::string made_at;

  double likely_cpu_seconds() const { return seeds.likely * cpu_seconds; }
  bool holds(int decided_after) const { return seeds.lower <= decided_after && decided_after <= seeds.upper; }
};

struct EventRecord {
  std::string at, kind;
  std::optional<std::int64_t> point;
  std::optional<int> seed;
  std::string message;
};

struct EngineRecord {
  std::int64_t id = 0;
  std::string identity;
  Json provenance;
};

// Results of a scene that no longer belong to the campaign.
struct SetAside {
  std::string engine;  // identity
  int results = 0;
};

struct CampaignRecord {
  std::string name;
  Json document;
  TargetRecord target;  // the present one
  std::string created_at, updated_at;
};

// True if the database is a campaign's, of any version.
bool is_campaign_database(Connection& connection);
// Returns a message if the tables have a version that this program does not know; "" otherwise.
std::string other_version(Connection& connection);

// True if a reader opens this database without locks and without a log: there is no log, and this user may
// not write its folder. The owner of the folder may write it; what is read while his run begins may look
// damaged.
bool is_frozen_for_us(const fs::path& path);

// Checks tables, columns and triggers before anything is read. A file from outside may have a view that never
// ends in the place of a table, or a trigger that writes. Requires that kind and version are known. Throws
// IntegrityError.
void check_tables(Connection& connection);

// Thrown if an owner has made the database but not filled it yet, which takes moments. The caller may wait.
class BeingSetUp : public InputError {
 public:
  explicit BeingSetUp(
      const std::string& database,
      const std::string& how = "the campaign is only just being set up; try again in a moment")
      : InputError(database, "", "", how) {}
};

class Database {
 public:
  // Opens or creates the database for its owner. Requires the campaign's lock. Throws IntegrityError if the
  // file is not a campaign's database or is damaged, InputError if it has another version, DatabaseError.
  static Database open_owner(const fs::path& path);
  // Opens it for reading. Everything that one Database reads is one snapshot, taken at the first read.
  // Without a log, in a folder that may not be written, the file is read as it is. Throws as open_owner();
  // InputError also if there is no file, or its log cannot be read there.
  static Database open_reader(const fs::path& path);

  CampaignRecord campaign();
  // Returns the points of the sweep, in its order.
  std::vector<PointRecord> points();
  // Returns the points of earlier sweeps and those that are set aside, in order of their first appearance.
  std::vector<PointRecord> inactive_points();

  // Returns the stop tests of each point for the present target, by PointRecord::id.
  std::map<std::int64_t, std::vector<StopTest>> stop_tests_by_point();

  // The functions below take PointRecord::id. Their lists are in order of the seeds, then of time.
  StateCounts counts(std::int64_t point);
  std::vector<RealisationRecord> realisations(std::int64_t point);
  // Returns how each seed has ended, for replay_stop_tests(). The index is the seed; the last one is the
  // largest that has ended. Throws IntegrityError if the numbers do not match their layout.
  std::vector<std::optional<Outcome>> outcomes(std::int64_t point);
  // Returns the engine's text of a result, without white space, if there is a result. Throws IntegrityError.
  std::optional<std::string> result_text(std::int64_t point, int seed);
  // Returns result_text() as JSON.
  std::optional<Json> result(std::int64_t point, int seed);
  // Visits the results of the seeds below `end`, one at a time.
  void for_each_result(std::int64_t point, int end, const std::function<void(int seed, const Json&)>& visit);
  std::vector<AttemptRecord> attempts(std::int64_t point);
  // Returns the process of an attempt; nothing if the attempt is unknown.
  std::optional<std::int64_t> process_of(std::int64_t attempt);
  // Returns the last `limit` attempts at all points, in the order in which they began.
  std::vector<AttemptSpan> last_attempts(int limit);
  // Returns the names of the machines that made attempts, sorted.
  std::vector<std::string> hosts();
  // Returns when an attempt last ended; "" before the first.
  std::string last_end();
  // Returns the seeds below `end` that have completed.
  std::vector<int> completed(std::int64_t point, int end);
  // Returns the mean steps of the seeds that are done; NaN if there are none.
  MeanSteps mean_steps(std::int64_t point);
  std::vector<LeaseRecord> leases(std::int64_t point);
  // Returns the running seeds as of their workers' last news, by PointRecord::id.
  std::map<std::int64_t, std::vector<Unfinished>> unfinished();
  // Returns how many seeds the workers ran when the last attempt began, at least one each; 0 before it.
  int last_workers();
  // Returns the predictions for the present target, by PointRecord::id.
  std::map<std::int64_t, StoredPrediction> predictions();
  // Returns the stop tests for the present target, by number of seeds.
  std::vector<StopTestRecord> stop_tests(std::int64_t point);
  // Returns the last `limit` events, oldest first.
  std::vector<EventRecord> events(int limit);
  // Returns the event that answered a request; nothing while it waits.
  std::optional<EventRecord> event_of(const std::string& request);
  std::vector<EngineRecord> engines();
  // Returns the results of the scene with that hash that were set aside, by engine.
  std::vector<SetAside> set_aside(const std::string& hash);

  Connection& connection() { return *connection_; }

 private:
  explicit Database(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Transaction> snapshot_;  // present if opened for reading
};

}  // namespace peclet::runner
