// Consistent copies of a campaign's database, also while its owner writes: what they hold, where they are,
// and what they mean for a database that is lost or damaged.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "contract/json.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// Copies the database `from` to `to` through SQLite's backup interface: one snapshot, read without blocking
// the writer. The copy is one file without a write-ahead log. It is checked (integrity_check,
// foreign_key_check) and durable before it gets its name, and replaces what had that name; `amend` may add to
// it before that. Throws IntegrityError (the source is damaged), DatabaseError, std::system_error; nothing is
// left behind then.
void copy_database(const fs::path& from, const fs::path& to,
                   const std::function<void(Connection& copy)>& amend);

// The same from a connection that is in no transaction, whose file may have lost its name.
void copy_database(Connection& from, const fs::path& to,
                   const std::function<void(Connection& copy)>& amend = {});

// What is wrong inside a database: the first complaint of integrity_check or foreign_key_check, or "".
std::string damage(Connection& connection);

// How far a campaign had come: stored results, and the number of its last attempt. Attempts are never
// forgotten.
struct Extent {
  std::int64_t results = 0, attempts = 0;
};
Extent extent_of(Connection& database);

// What a database holds.
struct Contents : Extent {
  std::string name, created_at;  // of the campaign
  std::string origin;            // tells campaigns apart, whatever they are called since
  Json document;
  std::string backed_up_at;  // of a backup; empty otherwise
  bool same_campaign(const Contents& other) const { return origin == other.origin; }
};

// Returns the same without extent, document and check; nothing of a damaged database.
Contents campaign_in(const fs::path& database);

// Checks a whole database and says what it holds. Throws IntegrityError, DatabaseError.
Contents examine(const fs::path& database);

fs::path newest_backup(const fs::path& folder);
fs::path previous_backup(const fs::path& folder);

// Throws IntegrityError when the database of a campaign that has backups is gone or empty: starting afresh
// would in time replace them. Throws UnsuitableFile when something else bears its name.
void refuse_lost_database(const CampaignDirectory& directory);

// What to do about a damaged database: the command that puts the last backup back, or "" when there is none.
std::string restore_hint(const CampaignDirectory& directory);
// The same, but "" also when the whole database was examined and found sound.
std::string hint_if_damaged(const CampaignDirectory& directory);

}  // namespace peclet::runner
