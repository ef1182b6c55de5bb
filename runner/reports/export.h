// Implements the verbs `peclet export`, `results` and `files`: the results of a campaign, for programs.
//
// The canonical form of an export depends on campaign, seeds and engine alone. It has the seeds of the
// deciding stop test, or of the last one if the point is open, and no times, costs, machines or attempts. Two
// runs with different numbers of workers, interrupted or not, give the same bytes. The full form has all.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Passes the stored results to `take` as lines of JSON without newline, in the order of points and seeds.
// Each is an object of `label`, `hash`, `settings`, `seed`, `deciding` (whether the last stop test counts the
// seed) and `result`, as the engine wrote it. `point` and `seed` select; "" is all points. Throws InputError
// if the point does not exist, or if `seed` has no result.
void for_each_result_line(Database& database, const std::string& point, std::optional<int> seed,
                          const std::function<void(const std::string& line)>& take);

// The options of `peclet files`.
struct FileChoice {
  std::string point;  // as find_point() names it; "" for all
  bool paths = false, json = false;
};

// Returns the table of the files that realisations have left beside their results. With `paths`, returns the
// paths of the kept files, one a line. With `json`, returns an array of point, hash, seed, name, bytes,
// sha256 and path (null for a file that was thrown away). Throws InputError if the point does not exist.
std::string list_files(Database& database, const CampaignDirectory& directory, const FileChoice& options);

// Returns the export as schema/README.md describes it. All three functions throw IntegrityError if stored
// stop tests disagree with the stored results.
std::string export_json(Database& database, bool canonical);
// Returns a table with one row per point, with the mean of every scalar quantity.
std::string export_csv(Database& database, bool canonical);
// Returns a table with one row per point, quantity and element ("long" or "tidy" data).
std::string export_long_csv(Database& database);

}  // namespace peclet::runner
