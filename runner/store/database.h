// The campaign's database: opening it safely, and reading it.
//
// One process writes (it holds campaign.lock and opens with open_owner); any number of others read with
// open_reader. The stores write it: point_store, seed_store, result_store and the like. The tables are those
// of schema/campaign.sql; no other folder has SQL.
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

// The texts of schema/*.sql.
extern const char* const campaign_sql;  // the tables
extern const char* const views_sql;     // what people read

enum class SeedState { queued, running, done, failed, quarantined };
const char* to_string(SeedState state);
SeedState seed_state(const std::string& text);

struct PointRecord {
  std::int64_t id = 0;
  std::optional<int> place;  // in the sweep; none: no longer part of it
  std::string hash;
  Json scene;
  Json settings;
  std::string label;
  std::string engine_identity;  // "" before the first result, unless it was accepted by name
  bool suspect = false;         // a seed gave two different results
  int priority = 0;             // points of a higher one are served first
  bool cancelled = false;       // gets no more seeds
  bool set_aside = false;       // its engine was replaced by name; another row is the scene's
};

// A seed with the columns that were taken from its result. Numbers that do not exist are absent.
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
  double cpu_seconds = 0;  // of done and failed together
  int& of(SeedState state) {
    return *std::array{&queued, &running, &done, &failed, &quarantined}.at(static_cast<std::size_t>(state));
  }
  int terminal() const { return done + failed + quarantined; }
};

struct AttemptRecord {
  int seed = 0;
  int worker = 0;
  std::int64_t process = 0;
  std::string host, started_at, ended_at;  // ended_at empty: still running
  std::string outcome;                     // the list is in schema/campaign.sql
  bool blamed = false;
  bool pardoned = false;  // from before a retry: no longer counts
  std::int64_t step = 0;
  std::optional<std::int64_t> exit_status, signal;
  std::string message;
};

// From when to when an attempt lasted. One that runs has no end but when it was last heard of.
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

  // The confidence level of every interval that is shown of a point.
  double level() const { return adjusted_confidence(target.confidence, minimum, maximum); }
};

struct StopTestRecord {
  TargetRecord target;
  StopTest stop_test;
  std::string made_at;
};

// A prediction that was stored before the seeds came, to be judged by what became of them.
struct StoredPrediction {
  int pilot = 0;           // seeds that it was made from
  Expected<int> seeds;     // of the deciding stop test
  double cpu_seconds = 0;  // of one seed
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

// Results of a scene that are no part of the campaign any more.
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

// Whether a file that SQLite can open is a campaign's database, of whatever version.
bool is_campaign_database(Connection& connection);
// Says that the tables of a campaign's database are of a version that this program does not know; ""
// otherwise.
std::string other_version(Connection& connection);

// Whether a reader reads this database without locks and without a log: there is no log, and its folder may
// not be written, so that a run of ours cannot write it. Its owner may: what is read while a run begins may
// then look damaged.
bool is_frozen_for_us(const fs::path& path);

// A file that calls itself a campaign's database may have been made by anybody: where a table should be there
// may be a view that never ends, and a trigger may write what nobody asked for. Nothing of such a file is
// read. Requires that its kind and version are known. Throws IntegrityError.
void check_tables(Connection& connection);

// A database that its owner has made, and not yet filled.
// For whoever can wait, which takes moments.
class BeingSetUp : public InputError {
 public:
  explicit BeingSetUp(
      const std::string& database,
      const std::string& how = "the campaign is only just being set up; try again in a moment")
      : InputError(database, "", "", how) {}
};

class Database {
 public:
  // Opens or creates the database for its owner. Requires the campaign's lock.
  // Throws IntegrityError for a file that is no campaign database or is damaged, InputError for one of
  // another version, and DatabaseError.
  static Database open_owner(const fs::path& path);
  // Opens it for reading. All that one Database reads is one snapshot, taken at the first read.
  // In a folder that may not be written, and without a log, the file is read as it is. Throws as above;
  // InputError when there is no such file, or a log beside it that cannot be read there.
  static Database open_reader(const fs::path& path);

  CampaignRecord campaign();
  // The points that the sweep contains, in its order.
  std::vector<PointRecord> points();
  // Points of earlier versions of the sweep, and those that are set aside, in order of their first
  // appearance.
  std::vector<PointRecord> inactive_points();

  // The stop tests of each point for the present target, by PointRecord::id.
  std::map<std::int64_t, std::vector<StopTest>> stop_tests_by_point();

  // All functions below take PointRecord::id. Lists are in order of the seeds (then of time).
  StateCounts counts(std::int64_t point);
  std::vector<RealisationRecord> realisations(std::int64_t point);
  // Index is the seed; as long as the largest seed asks for that a campaign can have. The input of
  // replay_stop_tests(). Throws IntegrityError if the numbers are not as their layout says.
  std::vector<std::optional<Outcome>> outcomes(std::int64_t point);
  // The text of a result as the engine wrote it; nothing for a seed without one. Throws IntegrityError.
  std::optional<std::string> result_text(std::int64_t point, int seed);
  // The same, read.
  std::optional<Json> result(std::int64_t point, int seed);
  // The results of the seeds below `end`, one at a time.
  void for_each_result(std::int64_t point, int end, const std::function<void(int seed, const Json&)>& visit);
  std::vector<AttemptRecord> attempts(std::int64_t point);
  // The process that makes, or has made, an attempt; nothing for an attempt that never was.
  std::optional<std::int64_t> process_of(std::int64_t attempt);
  // The most recent attempts at all points, at most `limit`, in the order in which they began.
  std::vector<AttemptSpan> last_attempts(int limit);
  // Machines that have made attempts, by name.
  std::vector<std::string> hosts();
  // When a seed last ended; before the first one "".
  std::string last_end();
  // The seeds below `end` that have completed.
  std::vector<int> completed(std::int64_t point, int end);
  // Mean steps of the seeds that are done; NaN without one.
  MeanSteps mean_steps(std::int64_t point);
  std::vector<LeaseRecord> leases(std::int64_t point);
  // The seeds that workers were running when they last gave news, by PointRecord::id.
  std::map<std::int64_t, std::vector<Unfinished>> unfinished();
  // How many workers the last run had, as far as they were needed; 0 where nothing was run here.
  int last_workers();
  // Predictions for the present target, by PointRecord::id.
  std::map<std::int64_t, StoredPrediction> predictions();
  // Looks for the present target, by number of seeds.
  std::vector<StopTestRecord> stop_tests(std::int64_t point);
  // The most recent `limit` events, oldest first.
  std::vector<EventRecord> events(int limit);
  // What became of a request; nothing while it waits.
  std::optional<EventRecord> event_of(const std::string& request);
  std::vector<EngineRecord> engines();
  // What other engines did for the scene of that hash before another one was accepted.
  std::vector<SetAside> set_aside(const std::string& hash);

  Connection& connection() { return *connection_; }

 private:
  explicit Database(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Transaction> snapshot_;  // of a reader
};

}  // namespace peclet::runner
