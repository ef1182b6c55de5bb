// What a database or a backup of it holds, where backups are, and what they mean for a database that is lost
// or damaged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "contract/json.h"
#include "runner/database/sqlite.h"
#include "runner/folder/campaign_directory.h"

namespace peclet::runner {

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
Contents campaign_in(const std::filesystem::path& database);

// Checks a whole database and says what it holds. Throws IntegrityError, DatabaseError.
Contents examine(const std::filesystem::path& database);

std::filesystem::path newest_backup(const std::filesystem::path& folder);
std::filesystem::path previous_backup(const std::filesystem::path& folder);

// Throws IntegrityError when the database of a campaign that has backups is gone or empty: starting afresh
// would in time replace them. Throws UnsuitableFile when something else bears its name.
void refuse_lost_database(const CampaignDirectory& directory);

// What to do about a damaged database: the command that puts the last backup back, or "" when there is none.
std::string restore_hint(const CampaignDirectory& directory);
// The same, but "" also when the whole database was examined and found sound.
std::string hint_if_damaged(const CampaignDirectory& directory);

}  // namespace peclet::runner
