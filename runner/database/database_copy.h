// A consistent copy of a campaign's database, also while its owner writes.
#pragma once

#include <filesystem>
#include <functional>

#include "runner/database/sqlite.h"

namespace peclet::runner {

// Copies the database `from` to `to` through SQLite's backup interface: one snapshot, read without blocking
// the writer. The copy is one file without a write-ahead log. It is checked (integrity_check,
// foreign_key_check) and durable before it gets its name, and replaces what had that name; `amend` may add to
// it before that. Throws IntegrityError (the source is damaged), DatabaseError, std::system_error; nothing is
// left behind then.
void copy_database(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Connection& copy)>& amend);

// The same from a connection that is in no transaction, whose file may have lost its name.
void copy_database(Connection& from, const std::filesystem::path& to,
                   const std::function<void(Connection& copy)>& amend = {});

// What is wrong inside a database: the first complaint of integrity_check or foreign_key_check, or "".
std::string damage(Connection& connection);

}  // namespace peclet::runner
