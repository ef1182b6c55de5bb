// What becomes of the files that a realisation left beside its result.
//
// Their rows are stored with the result, and they get their places after that commit, before the spool file
// of the result goes. What was checked is what gets there: it is held open meanwhile. So whatever is killed
// when, the spool file is found again, as a result that is known by then, and the moving goes on from there.
#pragma once

#include <filesystem>

#include "runner/owner/after_commit.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_store.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// Of a result that has been stored, or that is known. Inside its transaction. With `keep` files of a new one
// are kept. Throws ResultError if a file of a new one is absent or another one; std::system_error if the
// machine fails.
void take_files(Connection& connection, const CampaignDirectory& directory, const RealisationResult& result,
                const std::filesystem::path& spool, const StoredResult& stored, bool keep,
                AfterCommit& after);

// Removes files in the spool of attempts that gave no result and whose processes no longer run.
void remove_files_of_the_dead(Database& database, const CampaignDirectory& directory);

}  // namespace peclet::runner
