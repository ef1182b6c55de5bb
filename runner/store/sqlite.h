// Connection, Statement and Transaction wrap SQLite with every return code checked. They are not thread-safe:
// a connection and its statements belong to one thread.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace peclet::runner {

// Error of SQLite with its extended result code and the errno behind it (0 if there is none). Nothing is
// retried or swallowed. A damaged file, or one that is not a database, is an IntegrityError instead.
class DatabaseError : public std::runtime_error {
 public:
  DatabaseError(const std::string& message, int code, int system_error = 0)
      : std::runtime_error(message), code_(code), system_error_(system_error) {}
  int code() const { return code_; }
  int system_error() const { return system_error_; }
  // True if the file system or the user's quota is full: nothing was changed, and the call may be repeated.
  bool no_room() const;
  // True if another program has locked the database: nothing was changed, and the call may be repeated.
  bool is_locked() const;
  // True if the tables do not accept these values: nothing was changed, and repeating cannot help.
  bool refuses_values() const;

 private:
  int code_, system_error_;
};

bool means_no_room(const std::exception& error);

class Connection {
 public:
  // `frozen` reads a file without its log and without locks. Requires that no process writes it meanwhile.
  enum class Access { create, read_write, read_only, frozen };
  // Name of a database in memory, which ends with its connection.
  static constexpr const char* in_memory = ":memory:";

  // Waits up to `busy_milliseconds` for other connections' locks. Throws DatabaseError, and UnsuitableFile if
  // the database or a file of SQLite beside it is not a regular file.
  Connection(const std::string& path, Access access, int busy_milliseconds);
  ~Connection();
  Connection& operator=(Connection&&) = delete;

  // Sets how long to wait for other connections' locks from now on.
  void wait_for_locks(int busy_milliseconds);

  // Runs any number of statements and ignores their rows.
  void execute(const std::string& sql);
  // Runs one statement with these values for its question marks. Returns how many rows it changed.
  template <typename... Values>
  int run(std::string_view sql, const Values&... values);
  // Returns the single integer (text) that a query with these values gives.
  template <typename... Values>
  std::int64_t integer(std::string_view sql, const Values&... values);
  template <typename... Values>
  std::string text(std::string_view sql, const Values&... values);
  std::int64_t last_insert_id() const;
  // Brings the write-ahead log into the database and gives its room back, unless a reader or a full disk
  // prevents it. Not for use inside a transaction. Throws DatabaseError.
  void empty_log();
  // Throws the error of SQLite's last call, which gave `code` (0: as SQLite remembers it), while doing
  // `doing`.
  [[noreturn]] void fail(const std::string& doing, int code = 0) const;

  sqlite3* handle() const { return handle_; }
  const std::string& path() const { return path_; }

  // Returns a compiled statement of this text. put_back() keeps it for the next take() of the same text.
  // Throws DatabaseError.
  sqlite3_stmt* take(std::string_view sql);
  void put_back(sqlite3_stmt* statement) noexcept;

 private:
  int rows_changed() const;

  std::string path_;
  int busy_milliseconds_;
  sqlite3* handle_ = nullptr;
  std::unordered_multimap<std::string, sqlite3_stmt*> idle_;  // compiled statements without values, by text
};

// Statement is compiled SQL: bind in order of the question marks, step, read columns from 0.
class Statement {
 public:
  Statement(Connection& connection, std::string_view sql);
  template <typename... Values>
  Statement(Connection& connection, std::string_view sql, const Values&... values)
      : Statement(connection, sql) {
    (bind(values), ...);
  }
  ~Statement();
  Statement& operator=(Statement&&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(int value) { return bind(std::int64_t{value}); }
  Statement& bind(bool value) { return bind(std::int64_t{value}); }
  Statement& bind(double value);  // NaN is NULL
  Statement& bind(std::string_view value);
  Statement& bind(const char* value) { return bind(std::string_view(value)); }
  Statement& bind_blob(std::string_view bytes);
  Statement& bind(std::nullptr_t);
  template <typename T>
  Statement& bind(const std::optional<T>& value) {
    return value ? bind(*value) : bind(nullptr);
  }

  // Returns true if there is a row to read. After the last row the statement is ready to be bound again.
  bool step();
  // Runs a statement without rows, with these values.
  template <typename... Values>
  void run(const Values&... values) {
    (bind(values), ...);
    while (step()) {
    }
  }
  // Returns read(*this) for each row.
  template <typename Read>
  auto rows(const Read& read) {
    std::vector<decltype(read(*this))> rows;
    while (step()) rows.push_back(read(*this));
    return rows;
  }

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  int number(int column) const { return static_cast<int>(integer(column)); }
  bool flag(int column) const { return integer(column) != 0; }
  double real(int column) const;       // NULL is NaN
  std::string text(int column) const;  // or the bytes of a blob; NULL is empty
  std::optional<double> optional_real(int column) const;
  std::optional<std::int64_t> optional_integer(int column) const;
  std::optional<int> optional_number(int column) const;

 private:
  void check(int code) const;

  Connection& connection_;
  sqlite3_stmt* statement_ = nullptr;
  int next_parameter_ = 1;
};

template <typename... Values>
int Connection::run(std::string_view sql, const Values&... values) {
  Statement(*this, sql).run(values...);
  return rows_changed();
}

template <typename... Values>
std::int64_t Connection::integer(std::string_view sql, const Values&... values) {
  Statement query(*this, sql, values...);
  query.step();
  return query.integer(0);
}

template <typename... Values>
std::string Connection::text(std::string_view sql, const Values&... values) {
  Statement query(*this, sql, values...);
  query.step();
  return query.text(0);
}

// Returns the text for binding; NULL if it is empty.
inline std::optional<std::string_view> unless_empty(std::string_view text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

// Transaction is BEGIN IMMEDIATE for a writer, BEGIN for a reader's snapshot. It rolls back unless committed.
class Transaction {
 public:
  enum class Kind { write, snapshot };
  explicit Transaction(Connection& connection, Kind kind = Kind::write);
  ~Transaction();
  Transaction& operator=(Transaction&&) = delete;
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

// Savepoint is a part of a transaction that is rolled back unless it is kept. At most one exists at a time.
class Savepoint {
 public:
  explicit Savepoint(Connection& connection);
  ~Savepoint();
  Savepoint& operator=(Savepoint&&) = delete;
  void keep();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace peclet::runner
