#include "runner/database/database_tables.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "contract/integrity_error.h"
#include "runner/database/campaign_sql.h"
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

}  // namespace

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

}  // namespace peclet::runner
