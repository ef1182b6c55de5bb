#include "runner/store/database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <utility>

#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/number_store.h"
#include "runner/store/result_store.h"

namespace peclet::runner {
namespace {

// Columns of each table as "name TYPE", with generated ones marked.
using Tables = std::map<std::string, std::set<std::string>>;

std::set<std::string> columns_of(Connection& connection, const std::string& table) {
  Statement query(connection, "SELECT name, type, hidden FROM pragma_table_xinfo(?)", table);
  std::set<std::string> columns;
  while (query.step()) {
    columns.insert(
        fmt::format("{} {}{}", query.text(0), query.text(1), query.integer(2) == 0 ? "" : " generated"));
  }
  return columns;
}

Tables make_tables() {
  Connection fresh(Connection::in_memory, Connection::Access::create, 0);
  fresh.execute(campaign_sql);
  Statement query(fresh, "SELECT name FROM sqlite_schema WHERE type = 'table'");
  Tables tables;
  while (query.step()) tables[query.text(0)] = columns_of(fresh, query.text(0));
  return tables;
}

[[noreturn]] void refuse(const Connection& connection, const std::string& name, const char* what) {
  throw IntegrityError(fmt::format("{}: {} {}; another program made or changed this file", connection.path(),
                                   plain(name), what));
}

// Values of schema/campaign.sql.
constexpr std::int64_t our_application = 1346587724;
constexpr std::int64_t our_version = 1;

// In the order of SeedState.
constexpr std::array state_names{"queued", "running", "done", "failed", "quarantined"};

// True if the owner died between creating the file and filling it.
bool is_empty(Connection& connection) {
  return connection.integer("PRAGMA application_id") == 0 &&
         connection.integer("SELECT count(*) FROM sqlite_schema") == 0;
}

// True if a campaign was written; the tables are made before.
bool holds_anything(Connection& connection) {
  return connection.integer("SELECT EXISTS (SELECT 1 FROM campaign) OR EXISTS (SELECT 1 FROM point)") != 0;
}

void check_kind(Connection& connection) {
  if (!is_campaign_database(connection)) {
    throw IntegrityError(connection.path() + ": is a database, but not one of a peclet campaign");
  }
  if (const std::string why = other_version(connection); !why.empty()) {
    throw InputError(connection.path(), "", "", why);
  }
  check_tables(connection);
}

void create_tables(Connection& connection) {
  Transaction creation(connection);
  connection.execute(campaign_sql);
  connection.execute(views_sql);
  creation.commit();
  connection.empty_log();  // the database file takes the room of its tables now
}

bool may_write(const fs::path& folder) { return faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0; }

bool may_read(const fs::path& file) { return faccessat(AT_FDCWD, file.c_str(), R_OK, AT_EACCESS) == 0; }

// Returns the pages after which the log is brought into the database: some 4 MB, less on a small disk. On a
// disk that the log has filled there is no room to do that.
int pages_of_log(const fs::path& database) {
  constexpr std::uintmax_t page = 16384, part = 8, least = 8, most = 250;
  const std::uintmax_t available = fs::space(database.parent_path()).available;
  return static_cast<int>(std::clamp(available / (part * page), least, most));
}

// Opens a database for reading. SQLite's index of the log needs a folder that may be written.
std::unique_ptr<Connection> connection_of_reader(const fs::path& path) {
  constexpr int busy_milliseconds = 5'000;
  const bool is_frozen = is_frozen_for_us(path);
  try {
    const auto access = is_frozen ? Connection::Access::frozen : Connection::Access::read_only;
    auto connection = std::make_unique<Connection>(path.string(), access, busy_milliseconds);
    connection->integer("PRAGMA schema_version");  // the first read
    return connection;
  } catch (const DatabaseError& error) {
    const bool has_own_cause = error.is_locked() || error.system_error() == EIO || !may_read(path);
    if (is_frozen || has_own_cause || may_write(path.parent_path())) throw;
    throw InputError(
        path.string(), "", "",
        "has a log beside it (campaign.db-wal) that can be read only where the folder may be written: "
        "copy the folder, or ask its owner for `peclet backup`");
  }
}

constexpr const char* point_columns =
    "SELECT point_id, place, hash, scene, settings, label, engine_identity, suspect, priority, "
    "cancelled, set_aside FROM point ";

Target stored_target(const std::string& observable, const std::string& criterion, double confidence) {
  try {
    return target_of(observable, Json::parse(criterion), confidence);
  } catch (const std::exception&) {
    throw IntegrityError("the database holds an invalid target: " + plain(criterion));
  }
}

Verdict stored_verdict(const std::string& word) {
  const std::optional<Verdict> known = verdict_of(word);
  if (!known) throw IntegrityError("the database holds an unknown verdict: " + word);
  return *known;
}

std::vector<PointRecord> read_points(Connection& connection, const std::string& which) {
  Statement query(connection, point_columns + which);
  return query.rows([](const Statement& row) {
    return PointRecord{row.integer(0),
                       row.optional_number(1),
                       row.text(2),
                       Json::parse(row.text(3)),
                       Json::parse(row.text(4)),
                       row.text(5),
                       row.text(6),
                       row.flag(7),
                       row.number(8),
                       row.flag(9),
                       row.flag(10)};
  });
}

TargetRecord read_target(const Statement& row, int column) {
  return {row.integer(column),
          stored_target(row.text(column + 1), row.text(column + 2), row.real(column + 3)),
          row.number(column + 4), row.number(column + 5)};
}

std::vector<ObservableStopTest> stored_observables(const std::string& text) {
  if (text.empty()) return {};
  try {
    return observables_of(Json::parse(text));
  } catch (const std::exception&) {
    throw IntegrityError("the database holds an invalid stop test: " + plain(text));
  }
}

constexpr const char* stop_test_columns =
    "seeds, lost, count, mean, standard_error, half_width, plain_mean, plain_standard_error, "
    "plain_half_width, verdict, skewness, transient, observables ";

// Reads a row of a query of stop_test_columns.
StopTest read_stop_test(const Statement& query) {
  StopTest stop_test;
  stop_test.seeds = query.number(0);
  stop_test.lost = query.number(1);
  const int count = query.number(2);
  stop_test.controlled = {count, query.real(3), query.real(4)};
  stop_test.controlled_half_width = query.real(5);
  stop_test.estimate = {count, query.real(6), query.real(7)};
  stop_test.half_width = query.real(8);
  stop_test.controlled.values = stored_values(stop_test.controlled, stop_test.controlled_half_width);
  stop_test.estimate.values = stored_values(stop_test.estimate, stop_test.half_width);
  stop_test.verdict = stored_verdict(query.text(9));
  stop_test.skewness = query.real(10);
  stop_test.transient = query.flag(11);
  stop_test.each = stored_observables(query.text(12));
  stop_test.untested = std::any_of(stop_test.each.begin(), stop_test.each.end(),
                                   [](const ObservableStopTest& one) { return one.untested; });
  return stop_test;
}

// Reads a row of a query of result_columns.
std::string read_text(const Statement& query) {
  try {
    return result_text(query, 1, 2);
  } catch (const IntegrityError& error) {
    throw IntegrityError(
        fmt::format("the stored result of seed {} {}; see `peclet doctor`", query.integer(0), error.what()));
  }
}

EventRecord read_event(const Statement& row) {
  return {row.text(0), row.text(1), row.optional_integer(2), row.optional_number(3), row.text(4)};
}

constexpr const char* result_columns =
    "SELECT seed, document, text FROM result LEFT JOIN dictionary USING (point_id) WHERE point_id = ? ";

}  // namespace

bool is_frozen_for_us(const fs::path& path) {
  return kind_of(path.string() + "-wal").empty() && !may_write(path.parent_path());
}

bool is_campaign_database(Connection& connection) {
  return connection.integer("PRAGMA application_id") == our_application;
}

std::string other_version(Connection& connection) {
  const std::int64_t version = connection.integer("PRAGMA user_version");
  if (version == our_version) return "";
  return fmt::format(
      "was written by another peclet: its tables are of version {}, and this program knows version {}; use "
      "the peclet that wrote it",
      version, our_version);
}

void check_tables(Connection& connection) {
  static const Tables ours = make_tables();
  Statement query(connection, "SELECT name, type, sql FROM sqlite_schema");
  std::set<std::string> found;
  while (query.step()) {
    const std::string name = query.text(0), type = query.text(1);
    if (type == "trigger") refuse(connection, name, "is a trigger, and this program makes no triggers");
    if (type != "index" && ours.count(name) != 0) {
      const bool is_plain = type == "table" && query.text(2).starts_with("CREATE TABLE");
      if (!is_plain) refuse(connection, name, "is not the table that this program makes");
      found.insert(name);
    }
  }
  for (const auto& [name, columns] : ours) {
    if (found.count(name) == 0) refuse(connection, name, "is a table that is missing");
    if (columns_of(connection, name) != columns) {
      refuse(connection, name, "does not have the columns that this program gives it");
    }
  }
}

const char* to_string(SeedState state) { return state_names.at(static_cast<std::size_t>(state)); }

SeedState seed_state(const std::string& text) {
  const auto known = std::ranges::find(state_names, text);
  if (known == state_names.end()) throw IntegrityError("the database holds an unknown state: " + text);
  return static_cast<SeedState>(known - state_names.begin());
}

Database::Database(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

Database Database::open_owner(const fs::path& path) {
  // Readers never hold a lock that blocks the writer in WAL mode; only a checkpoint may have to wait.
  Database database(std::make_unique<Connection>(path.string(), Connection::Access::create, 10'000));
  Connection& connection = database.connection();
  const bool fresh = is_empty(connection);
  if (!fresh) check_kind(connection);
  // Results take some 2 kB, and pages of 4 kB would hold one each. Ignored if tables exist.
  connection.execute("PRAGMA page_size = 16384");
  // Journals of statements are a few pages; a file for each would cost as much as the commit.
  connection.execute("PRAGMA temp_store = MEMORY");
  connection.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  connection.execute(fmt::format("PRAGMA wal_autocheckpoint = {}", pages_of_log(path)));
  // The log grows while a reader does not finish; afterwards the file shrinks again.
  connection.execute("PRAGMA journal_size_limit = 8388608");
  if (connection.text("PRAGMA journal_mode") != "wal") {
    throw DatabaseError(connection.path() + ": cannot keep a write-ahead log on this file system", 0);
  }
  if (fresh) {
    create_tables(connection);
  } else if (const std::string verdict = connection.text("PRAGMA quick_check(1)"); verdict != "ok") {
    throw IntegrityError(fmt::format("{}: is damaged: {}", connection.path(), verdict));
  }
  return database;
}

Database Database::open_reader(const fs::path& path) {
  if (kind_of(path).empty()) {
    throw InputError(path.string(), "", "",
                     "there is no database; has the campaign been started with `peclet run`?");
  }
  Database database(connection_of_reader(path));
  database.snapshot_ = std::make_unique<Transaction>(database.connection(), Transaction::Kind::snapshot);
  if (is_empty(database.connection())) throw BeingSetUp(path.string());
  check_kind(database.connection());
  if (!holds_anything(database.connection())) throw BeingSetUp(path.string());
  return database;
}

CampaignRecord Database::campaign() {
  Statement query(*connection_,
                  "SELECT target_id, observable, criterion, confidence, minimum, maximum, name, "
                  "document, created_at, updated_at FROM campaign JOIN target USING (target_id)");
  if (!query.step()) throw IntegrityError(connection_->path() + ": holds no campaign");
  return {query.text(6), Json::parse(query.text(7)), read_target(query, 0), query.text(8), query.text(9)};
}

std::map<std::int64_t, std::vector<StopTest>> Database::stop_tests_by_point() {
  Statement query(*connection_,
                  std::string("SELECT ") + stop_test_columns +
                      ", point_id FROM stop_test WHERE target_id = (SELECT target_id FROM campaign) "
                      "ORDER BY point_id, seeds");
  std::map<std::int64_t, std::vector<StopTest>> stop_tests;
  while (query.step()) stop_tests[query.integer(13)].push_back(read_stop_test(query));
  return stop_tests;
}

std::vector<PointRecord> Database::points() {
  return read_points(*connection_, "WHERE place IS NOT NULL ORDER BY place");
}

std::vector<PointRecord> Database::inactive_points() {
  return read_points(*connection_, "WHERE place IS NULL ORDER BY point_id");
}

StateCounts Database::counts(std::int64_t point) {
  Statement query(
      *connection_,
      "SELECT state, count(*), total(cpu_seconds) FROM realisation WHERE point_id = ? GROUP BY state", point);
  StateCounts counts;
  while (query.step()) {
    counts.of(seed_state(query.text(0))) = query.number(1);
    counts.cpu_seconds += query.real(2);
  }
  return counts;
}

std::vector<RealisationRecord> Database::realisations(std::int64_t point) {
  Statement query(
      *connection_,
      "SELECT seed, state, cause, statistical_inefficiency, largest_overlap, cpu_seconds, wall_seconds, "
      "final_state_sha256, content_sha256, engine_id FROM realisation WHERE point_id = ? ORDER BY seed",
      point);
  return query.rows([](const Statement& row) {
    return RealisationRecord{
        row.number(0),        seed_state(row.text(1)), row.text(2),          row.optional_real(3),
        row.optional_real(4), row.optional_real(5),    row.optional_real(6), row.text(7),
        row.text(8),          row.optional_integer(9)};
  });
}

std::vector<std::optional<Outcome>> Database::outcomes(std::int64_t point) {
  return NumberStore(*connection_).outcomes(point);
}

std::optional<std::string> Database::result_text(std::int64_t point, int seed) {
  Statement query(*connection_, std::string(result_columns) + "AND seed = ?", point, seed);
  return query.step() ? std::optional(read_text(query)) : std::nullopt;
}

std::optional<Json> Database::result(std::int64_t point, int seed) {
  const std::optional<std::string> text = result_text(point, seed);
  return text ? std::optional(Json::parse(*text)) : std::nullopt;
}

void Database::for_each_result(std::int64_t point, int end,
                               const std::function<void(int seed, const Json&)>& visit) {
  Statement query(*connection_, std::string(result_columns) + "AND seed < ? ORDER BY seed", point, end);
  while (query.step()) visit(query.number(0), Json::parse(read_text(query)));
}

std::vector<AttemptRecord> Database::attempts(std::int64_t point) {
  Statement query(
      *connection_,
      "SELECT seed, worker, process, host, started_at, ended_at, outcome, blamed, pardoned, step, "
      "exit_status, signal, message FROM attempt WHERE point_id = ? ORDER BY seed, attempt_id",
      point);
  return query.rows([](const Statement& row) {
    return AttemptRecord{row.number(0),
                         row.number(1),
                         row.integer(2),
                         row.text(3),
                         row.text(4),
                         row.text(5),
                         row.text(6),
                         row.flag(7),
                         row.flag(8),
                         row.integer(9),
                         row.optional_integer(10),
                         row.optional_integer(11),
                         row.text(12)};
  });
}

std::optional<std::int64_t> Database::process_of(std::int64_t attempt) {
  Statement query(*connection_, "SELECT process FROM attempt WHERE attempt_id = ?", attempt);
  return query.step() ? std::optional(query.integer(0)) : std::nullopt;
}

std::vector<AttemptSpan> Database::last_attempts(int limit) {
  Statement query(
      *connection_,
      "SELECT a.point_id, a.seed, a.worker, a.host, a.started_at, coalesce(a.ended_at, l.renewed_at, "
      "a.started_at), a.outcome FROM attempt a LEFT JOIN lease l USING (attempt_id) ORDER BY a.attempt_id "
      "DESC LIMIT ?",
      limit);
  std::vector<AttemptSpan> spans = query.rows([](const Statement& row) {
    return AttemptSpan{row.integer(0), row.number(1), row.number(2), row.text(3),
                       row.text(4),    row.text(5),   row.text(6)};
  });
  std::reverse(spans.begin(), spans.end());
  return spans;
}

std::vector<std::string> Database::hosts() {
  Statement query(*connection_, "SELECT DISTINCT host FROM attempt WHERE host != '' ORDER BY host");
  return query.rows([](const Statement& row) { return row.text(0); });
}

std::string Database::last_end() {
  return connection_->text("SELECT coalesce(max(ended_at), '') FROM attempt");
}

std::vector<int> Database::completed(std::int64_t point, int end) {
  Statement query(*connection_, "SELECT seed FROM numbers WHERE point_id = ? AND seed < ? ORDER BY seed",
                  point, end);
  return query.rows([](const Statement& row) { return row.number(0); });
}

MeanSteps Database::mean_steps(std::int64_t point) {
  Statement query(*connection_,
                  "SELECT avg(equilibration_steps), avg(production_steps) FROM realisation WHERE point_id = "
                  "? AND state = 'done'",
                  point);
  query.step();
  return {query.real(0), query.real(1)};
}

std::vector<LeaseRecord> Database::leases(std::int64_t point) {
  Statement query(*connection_,
                  "SELECT seed, worker, phase, step, steps, strain, renewed_at FROM lease "
                  "WHERE point_id = ? ORDER BY seed",
                  point);
  return query.rows([](const Statement& row) {
    return LeaseRecord{row.number(0),  row.number(1), row.text(2), row.integer(3),
                       row.integer(4), row.real(5),   row.text(6)};
  });
}

std::map<std::int64_t, std::vector<Unfinished>> Database::unfinished() {
  constexpr double shortest = 0.1;  // share of the steps below which their rate is unreliable
  // A drained seed continues from the step at which it left. After any other end of an attempt the first step
  // of the next is unknown.
  Statement query(*connection_,
                  "SELECT l.point_id, strftime('%s', l.renewed_at) - strftime('%s', a.started_at), l.step, "
                  "l.steps, l.phase, (SELECT CASE WHEN total(b.outcome != 'drained' AND b.step > 0) = 0 THEN "
                  "coalesce(max(b.step), 0) END FROM attempt b WHERE b.point_id = l.point_id AND b.seed = "
                  "l.seed AND b.attempt_id < l.attempt_id) FROM lease l JOIN attempt a USING (attempt_id)");
  std::map<std::int64_t, std::vector<Unfinished>> running;
  while (query.step()) {
    const double seconds = query.real(1), step = query.real(2), steps = query.real(3);
    const double made = step - query.real(5);
    Unfinished one{seconds};
    if (query.text(4) != "packing" && seconds > 0 && steps > 0 && made >= shortest * steps) {
      one.whole = seconds * steps / made;
      one.taken = *one.whole * step / steps;
    }
    running[query.integer(0)].push_back(one);
  }
  return running;
}

int Database::last_workers() {
  return static_cast<int>(connection_->integer(
      "WITH last AS (SELECT host, started_at FROM attempt ORDER BY attempt_id DESC LIMIT 1), "
      // A job without a step may have waited behind another one.
      "jobs AS (SELECT a.worker, total((a.ended_at > l.started_at AND a.outcome != 'result' AND a.step > 0) "
      "OR (a.ended_at IS NULL AND EXISTS "
      "(SELECT 1 FROM lease WHERE attempt_id = a.attempt_id AND phase != 'starting'))) AS running "
      "FROM attempt a JOIN last l USING (host) WHERE a.ended_at IS NULL OR a.ended_at >= l.started_at "
      "GROUP BY a.worker) SELECT coalesce(sum(max(1, running)), 0) FROM jobs"));
}

std::map<std::int64_t, StoredPrediction> Database::predictions() {
  Statement query(*connection_,
                  "SELECT point_id, pilot, seeds, lower, upper, cpu_seconds, made_at FROM prediction WHERE "
                  "target_id = (SELECT target_id FROM campaign)");
  std::map<std::int64_t, StoredPrediction> stored;
  while (query.step()) {
    const Expected<int> seeds{query.number(2), query.number(3), query.number(4)};
    stored[query.integer(0)] = {query.number(1), seeds, query.real(5), query.text(6)};
  }
  return stored;
}

std::vector<StopTestRecord> Database::stop_tests(std::int64_t point) {
  Statement query(
      *connection_,
      std::string("SELECT ") + stop_test_columns +
          ", made_at, target_id, observable, criterion, confidence, minimum, maximum FROM stop_test JOIN "
          "target USING (target_id) WHERE point_id = ? AND target_id = (SELECT target_id FROM campaign) "
          "ORDER BY seeds",
      point);
  return query.rows([](const Statement& row) {
    return StopTestRecord{read_target(row, 14), read_stop_test(row), row.text(13)};
  });
}

std::vector<EventRecord> Database::events(int limit) {
  Statement query(*connection_,
                  "SELECT at, kind, point_id, seed, message FROM (SELECT * FROM event ORDER BY event_id "
                  "DESC LIMIT ?) ORDER BY event_id",
                  limit);
  return query.rows(read_event);
}

std::optional<EventRecord> Database::event_of(const std::string& request) {
  Statement query(*connection_, "SELECT at, kind, point_id, seed, message FROM event WHERE request = ?",
                  request);
  return query.step() ? std::optional(read_event(query)) : std::nullopt;
}

std::vector<EngineRecord> Database::engines() {
  Statement query(*connection_, "SELECT engine_id, identity, provenance FROM engine ORDER BY engine_id");
  return query.rows([](const Statement& row) {
    return EngineRecord{row.integer(0), row.text(1), Json::parse(row.text(2))};
  });
}

std::vector<SetAside> Database::set_aside(const std::string& hash) {
  Statement query(
      *connection_,
      "SELECT engine_identity, count(content_sha256) FROM point LEFT JOIN realisation USING (point_id) "
      "WHERE hash = ? AND set_aside = 1 GROUP BY point_id HAVING count(content_sha256) > 0 ORDER BY "
      "point_id",
      hash);
  return query.rows([](const Statement& row) { return SetAside{row.text(0), row.number(1)}; });
}

}  // namespace peclet::runner
