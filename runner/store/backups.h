// Copies a campaign's database consistently, also while its owner writes, and says what the copies hold and
// what they mean for a lost or damaged database.
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
// the writer. The copy is one file without a write-ahead log; `amend` may add to it. It is then checked
// (integrity_check, foreign_key_check) and made durable, and replaces what had its name. Throws
// IntegrityError (the source is damaged), DatabaseError, std::system_error; nothing is left behind then.
void copy_database(const fs::path& from, const fs::path& to,
                   const std::function<void(Connection& copy)>& amend);

// Copies from a connection that is in no transaction; its file may have lost its name.
void copy_database(Connection& from, const fs::path& to,
                   const std::function<void(Connection& copy)>& amend = {});

// Returns the first fault of integrity_check, of the tables or of foreign_key_check; "" if there is none.
std::string damage(Connection& connection);

// Progress of a campaign: stored results, and the number of its last attempt. Attempts are never removed.
struct Extent {
  std::int64_t results = 0, attempts = 0;
};
Extent extent_of(Connection& database);

struct Contents : Extent {
  std::string name, created_at;  // name and time of creation of the campaign
  std::string origin;            // tells campaigns apart, also after a change of name
  Json document;
  std::string backed_up_at;  // when a backup was made; "" for another database
  bool same_campaign(const Contents& other) const { return origin == other.origin; }
};

// Returns name, created_at and origin without a check; empty for a damaged database.
Contents campaign_in(const fs::path& database);

// Checks a whole database and returns what it holds. Throws IntegrityError, DatabaseError.
Contents examine(const fs::path& database);

fs::path newest_backup(const fs::path& folder);
fs::path previous_backup(const fs::path& folder);

// Throws IntegrityError if the database of a campaign with backups is gone or empty: a fresh start would in
// time replace them. Throws UnsuitableFile if its name is not a regular file's.
void refuse_lost_database(const CampaignDirectory& directory);

// Returns the command that puts the last backup in the place of a damaged database; "" if there is no backup.
std::string restore_hint(const CampaignDirectory& directory);
// Returns restore_hint() if the database is damaged; "" if it was examined and found sound.
std::string hint_if_damaged(const CampaignDirectory& directory);

}  // namespace peclet::runner
