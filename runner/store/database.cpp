#include "runner/store/database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "contract/guarded_file.h"
#include "runner/store/campaign_sql.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

// Of each table its columns, as "name TYPE", generated ones marked.
using Tables = std::map<std::string, std::set<std::string>>;

std::set<std::string> columns_of(Connection& connection, const std::string& table) {
  Statement query(connection, "SELECT name, type, hidden FROM pragma_table_xinfo(?)");
  query.bind(table);
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
  throw IntegrityError(fmt::format("{}: {} {}; somebody else made or changed this file", connection.path(),
                                   plain(name), what));
}

// As in schema/campaign.sql.
constexpr std::int64_t our_application = 1346587724;
constexpr std::int64_t our_version = 1;

constexpr std::array<std::pair<SeedState, const char*>, 5> state_names{
    {{SeedState::queued, "queued"},
     {SeedState::running, "running"},
     {SeedState::done, "done"},
     {SeedState::failed, "failed"},
     {SeedState::quarantined, "quarantined"}}};

template <typename Names, typename Value>
const char* name_of(const Names& names, Value value) {
  for (const auto& [known, name] : names) {
    if (known == value) return name;
  }
  return "?";
}

template <typename Value, typename Names>
Value value_of(const Names& names, const std::string& text) {
  for (const auto& [known, name] : names) {
    if (name == text) return known;
  }
  throw IntegrityError("the database holds an unknown state: " + text);
}

// An owner that died between creating the file and filling it leaves nothing in it.
bool is_empty(Connection& connection) {
  return connection.integer("PRAGMA application_id") == 0 &&
         connection.integer("SELECT count(*) FROM sqlite_schema") == 0;
}

// The tables are made before the campaign is written into them.
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
  connection.empty_log();  // what is to become larger later has its place now
}

bool may_write(const std::filesystem::path& folder) {
  return faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0;
}

bool may_read(const std::filesystem::path& file) {
  return faccessat(AT_FDCWD, file.c_str(), R_OK, AT_EACCESS) == 0;
}

// A log of some 4 MB, and less on a small disk: a full one whose log takes most of it has no room to bring
// the log into the database either, and nobody could ever go on.
int pages_of_log(const std::filesystem::path& database) {
  constexpr std::uintmax_t page = 16384, part = 8, least = 8, most = 250;
  const std::uintmax_t available = std::filesystem::space(database.parent_path()).available;
  return static_cast<int>(std::clamp(available / (part * page), least, most));
}

// SQLite keeps an index of its log beside a database that somebody reads, and cannot where nothing may be
// written.
std::unique_ptr<Connection> connection_of_reader(const std::filesystem::path& path) {
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

}  // namespace

bool is_frozen_for_us(const std::filesystem::path& path) {
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
    if (type == "trigger") refuse(connection, name, "is a trigger, of which this program makes none");
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

const char* to_string(SeedState state) { return name_of(state_names, state); }

SeedState seed_state(const std::string& text) { return value_of<SeedState>(state_names, text); }

Database::Database(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

Database Database::open_owner(const std::filesystem::path& path) {
  // Readers never hold a lock that blocks the writer in WAL mode; only a checkpoint may have to wait.
  Database database(std::make_unique<Connection>(path.string(), Connection::Access::create, 10'000));
  Connection& connection = database.connection();
  const bool fresh = is_empty(connection);
  if (!fresh) check_kind(connection);
  // Results take some 2 kB, of which pages of 4 kB would hold one each. Ignored where there are tables.
  connection.execute("PRAGMA page_size = 16384");
  connection.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  connection.execute(fmt::format("PRAGMA wal_autocheckpoint = {}", pages_of_log(path)));
  // Beside a reader that does not come to an end the log grows; when that one is gone, the file shrinks
  // again.
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

Database Database::open_reader(const std::filesystem::path& path) {
  if (kind_of(path).empty()) {
    throw InputError(path.string(), "", "",
                     "no such database; has the campaign been started with `peclet run`?");
  }
  Database database(connection_of_reader(path));
  database.snapshot_ = std::make_unique<Transaction>(database.connection(), Transaction::Kind::snapshot);
  if (is_empty(database.connection())) throw BeingSetUp(path.string());
  check_kind(database.connection());
  if (!holds_anything(database.connection())) throw BeingSetUp(path.string());
  return database;
}

}  // namespace peclet::runner
