#include "runner/store/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

int primary(int code) { return code & 0xff; }

// True if SQLite's code comes with an errno that gives the reason.
bool comes_from_the_system(int code) {
  return primary(code) == SQLITE_IOERR || primary(code) == SQLITE_CANTOPEN || primary(code) == SQLITE_FULL;
}

// Returns who has locked a database: "campaign.db: is locked by sqlite3 (process 4711), which writes to it:
// ...".
//
// In WAL mode the writer locks byte 120 of the -shm file. In other modes, and to exclude readers, it locks
// bytes of the database from 0x40000000 on (SQLite's os_unix.c and wal.c).
std::string lock_text(const std::string& database) {
  constexpr std::uint64_t write_lock = 120, pending = 0x40000000;
  const auto holder = [](const std::string& file, std::uint64_t byte) -> std::int64_t {
    struct stat about {};
    return stat(file.c_str(), &about) == 0 ? process_that_locks(about.st_ino, "POSIX", byte) : 0;
  };
  std::int64_t process = holder(database + "-shm", write_lock);
  for (std::uint64_t byte = pending; process == 0 && byte < pending + 3; ++byte)
    process = holder(database, byte);
  if (process <= 0) {
    return fmt::format(
        "{0}: is locked by another program, which writes to it: let that end its transaction or close the "
        "database (`fuser -v {0}` names it)",
        database);
  }
  std::string name;
  std::getline(std::ifstream(fmt::format("/proc/{}/comm", process)), name);
  return fmt::format(
      "{}: is locked by {} (process {}), which writes to it: let it end its transaction (COMMIT or "
      "ROLLBACK) or close the database",
      database, name.empty() ? "another program" : plain(name), process);
}

// `error` is the errno after the call, which began with 0. SQLite's own copy of errno may be older, and is
// lost after COMMIT.
[[noreturn]] void complain(const std::string& path, sqlite3* handle, int code, std::string_view doing,
                           int error) {
  if (primary(code) == SQLITE_BUSY) throw DatabaseError(lock_text(path), code);
  const bool is_said = handle != nullptr && sqlite3_extended_errcode(handle) == code;
  std::string said = is_said ? sqlite3_errmsg(handle) : sqlite3_errstr(code);
  if (!comes_from_the_system(code)) error = 0;
  if (error != 0) said += ": " + std::generic_category().message(error);
  const bool is_damaged = primary(code) == SQLITE_CORRUPT;
  const std::string message = fmt::format("{}: {}{} (SQLite code {}) while: {}", path,
                                          is_damaged ? "is damaged: " : "", said, code, doing);
  if (is_damaged || primary(code) == SQLITE_NOTADB) throw IntegrityError(message);
  throw DatabaseError(message, code, error);
}

int flags_of(Connection::Access access) {
  if (access == Connection::Access::create) return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (access == Connection::Access::read_write) return SQLITE_OPEN_READWRITE;
  return SQLITE_OPEN_READONLY | (access == Connection::Access::frozen ? SQLITE_OPEN_URI : 0);
}

// Escapes characters that have a meaning in a URI (https://sqlite.org/uri.html).
std::string uri_of_frozen(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

// Resolves links in the folder of the path, because SQLITE_OPEN_NOFOLLOW refuses links anywhere in it.
std::string without_links_above(const fs::path& path) {
  if (path == Connection::in_memory) return path.string();  // not a file
  std::error_code absent;                                   // SQLite reports it
  const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", absent);
  return absent ? path.string() : (folder / path.filename()).string();
}

}  // namespace

bool DatabaseError::no_room() const {
  if (primary(code_) == SQLITE_FULL) return true;
  return comes_from_the_system(code_) && peclet::means_no_room(system_error_);
}

bool DatabaseError::is_locked() const { return primary(code_) == SQLITE_BUSY; }

bool means_no_room(const std::exception& error) {
  if (const auto* database = dynamic_cast<const DatabaseError*>(&error)) return database->no_room();
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && peclet::means_no_room(system->code().value());
}

bool DatabaseError::refuses_values() const {
  const int what = primary(code_);
  return what == SQLITE_CONSTRAINT || what == SQLITE_MISMATCH || what == SQLITE_TOOBIG;
}

Connection::Connection(const std::string& path, Access access, int busy_milliseconds)
    : path_(path), busy_milliseconds_(busy_milliseconds) {
  // Checked beforehand, because SQLite would wait for a FIFO. SQLITE_OPEN_NOFOLLOW refuses links.
  for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) require_regular(path + suffix);
  const std::string place = without_links_above(path);
  const int code = sqlite3_open_v2(
      (access == Access::frozen ? uri_of_frozen(place) : place).c_str(), &handle_,
      flags_of(access) | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_NOFOLLOW, nullptr);
  if (code != SQLITE_OK) {
    sqlite3* const broken = handle_;
    handle_ = nullptr;
    const std::string said = broken != nullptr ? sqlite3_errmsg(broken) : sqlite3_errstr(code);
    const int system_error = broken != nullptr ? sqlite3_system_errno(broken) : 0;
    sqlite3_close_v2(broken);
    const std::string why = system_error != 0 ? ": " + std::generic_category().message(system_error) : "";
    throw DatabaseError(fmt::format("{}: {}{} (SQLite code {}) while opening it", path, said, why, code),
                        code, system_error);
  }
  sqlite3_busy_timeout(handle_, busy_milliseconds);
}

Connection::~Connection() {
  for (const auto& [sql, statement] : idle_) sqlite3_finalize(statement);
  sqlite3_close_v2(handle_);
}

sqlite3_stmt* Connection::take(std::string_view sql) {
  if (const auto known = idle_.find(std::string(sql)); known != idle_.end()) {
    sqlite3_stmt* const statement = known->second;
    idle_.erase(known);
    return statement;
  }
  sqlite3_stmt* statement = nullptr;
  errno = 0;
  const int code = sqlite3_prepare_v3(handle_, sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) complain(path_, handle_, code, sql, errno);
  return statement;
}

// Pragmas are never kept, because some act when they are compiled.
void Connection::put_back(sqlite3_stmt* statement) noexcept {
  const char* const sql = sqlite3_sql(statement);
  const bool is_pragma = sql == nullptr || std::string_view(sql).starts_with("PRAGMA");
  sqlite3_reset(statement);  // returns the code of the last step, which was handled
  sqlite3_clear_bindings(statement);
  try {
    if (!is_pragma) {
      idle_.emplace(sql, statement);
      return;
    }
  } catch (const std::bad_alloc&) {  // then it is compiled again
  }
  sqlite3_finalize(statement);
}

void Connection::execute(const std::string& sql) {
  errno = 0;
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) complain(path_, handle_, code, sql, errno);
}

std::int64_t Connection::last_insert_id() const { return sqlite3_last_insert_rowid(handle_); }

// Tries once, without waiting for a reader.
void Connection::empty_log() {
  sqlite3_busy_timeout(handle_, 0);
  errno = 0;
  const int code = sqlite3_wal_checkpoint_v2(handle_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  const int system_error = errno;
  sqlite3_busy_timeout(handle_, busy_milliseconds_);
  const int what = primary(code);
  if (what == SQLITE_OK || what == SQLITE_BUSY || what == SQLITE_LOCKED) return;
  const DatabaseError error(fmt::format("{}: cannot empty its write-ahead log", path_), code, system_error);
  if (!error.no_room()) throw error;
}

int Connection::rows_changed() const { return sqlite3_changes(handle_); }

void Connection::fail(const std::string& doing, int code) const {
  const int system_error = errno;
  complain(path_, handle_, code != 0 ? code : sqlite3_extended_errcode(handle_), doing, system_error);
}

void Connection::wait_for_locks(int busy_milliseconds) {
  busy_milliseconds_ = busy_milliseconds;
  sqlite3_busy_timeout(handle_, busy_milliseconds);
}

Statement::Statement(Connection& connection, std::string_view sql)
    : connection_(connection), statement_(connection.take(sql)) {}

Statement::~Statement() { connection_.put_back(statement_); }

void Statement::check(int code) const {
  if (code == SQLITE_OK) return;
  complain(connection_.path(), connection_.handle(), code, sqlite3_sql(statement_), errno);
}

Statement& Statement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(statement_, next_parameter_++, value));
  return *this;
}

Statement& Statement::bind(double value) {
  if (std::isnan(value)) return bind(nullptr);
  check(sqlite3_bind_double(statement_, next_parameter_++, value));
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  check(sqlite3_bind_text64(statement_, next_parameter_++, value.data(), value.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_blob(std::string_view bytes) {
  check(sqlite3_bind_blob64(statement_, next_parameter_++, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(std::nullptr_t) {
  check(sqlite3_bind_null(statement_, next_parameter_++));
  return *this;
}

bool Statement::step() {
  errno = 0;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const int system_error = errno;
    const std::string sql = sqlite3_sql(statement_);
    // Reads the message before the statement is reset.
    try {
      complain(connection_.path(), connection_.handle(), code, sql, system_error);
    } catch (...) {
      sqlite3_reset(statement_);
      throw;
    }
  }
  check(sqlite3_reset(statement_));
  next_parameter_ = 1;
  return false;
}

bool Statement::is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }

double Statement::real(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN()
                         : sqlite3_column_double(statement_, column);
}

std::string Statement::text(int column) const {
  const void* const bytes = sqlite3_column_blob(statement_, column);
  if (bytes == nullptr) return {};
  return {static_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::optional<double> Statement::optional_real(int column) const {
  return is_null(column) ? std::nullopt : std::optional(real(column));
}

std::optional<std::int64_t> Statement::optional_integer(int column) const {
  return is_null(column) ? std::nullopt : std::optional(integer(column));
}

std::optional<int> Statement::optional_number(int column) const {
  return is_null(column) ? std::nullopt : std::optional(number(column));
}

Transaction::Transaction(Connection& connection, Kind kind) : connection_(connection) {
  connection_.execute(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // Rolls back after a failed commit, too, unless SQLite has rolled back by itself.
  if (open_ && sqlite3_get_autocommit(connection_.handle()) == 0) {
    sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

Savepoint::Savepoint(Connection& connection) : connection_(connection) {
  connection_.execute("SAVEPOINT part");
}

Savepoint::~Savepoint() {
  // If the part cannot be rolled back, the whole transaction is, so nothing of it can be committed. SQLite
  // may have rolled back by itself.
  if (!open_ || sqlite3_get_autocommit(connection_.handle()) != 0) return;
  if (sqlite3_exec(connection_.handle(), "ROLLBACK TO part; RELEASE part", nullptr, nullptr, nullptr) !=
      SQLITE_OK) {
    sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Savepoint::keep() {
  connection_.execute("RELEASE part");
  open_ = false;
}

}  // namespace peclet::runner
