// The verb `peclet export`: what a campaign has found, for programs to read.
//
// The canonical form holds what depends on campaign, seeds and engine alone: the seeds of the deciding stop
// test (of a point that is still open, those of its last stop test) and nothing of time, cost, machines or
// attempts. Two runs with other numbers of workers, killed or not, give the same bytes. The full form adds
// the rest.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// The verb `peclet results`: every stored result as the engine wrote it, one JSON object a line, for programs
// that cannot inflate what the database holds.
//
// Gives `take` the lines in the order of points and seeds, one at a time, without their newlines. Each is an
// object of `label`, `hash`, `settings`, `seed`, `deciding` (whether the last stop test counts the seed) and
// `result`. Throws InputError for a point that is not there, or when there is no result of `seed`.
void for_each_result_line(Database& database, const std::string& point, std::optional<int> seed,
                          const std::function<void(const std::string& line)>& take);

// The verb `peclet files`: what realisations have left beside their results.
struct FileChoice {
  std::string point;  // as find_point() names it; "" for all
  bool paths = false, json = false;
};

// A table; with `paths` the paths of the files that are kept, a line each; with `json` an array of point,
// hash, seed, name, bytes, sha256 and path, which is null of a file that was thrown away. Throws InputError
// for a point that there is not.
std::string list_files(Database& database, const CampaignDirectory& directory, const FileChoice& options);

// Documents as schema/README.md describes them. Throw IntegrityError when stored stop tests are not what the
// stored results say.
std::string export_json(Database& database, bool canonical);
// One row per point, with the mean of every scalar quantity.
std::string export_csv(Database& database, bool canonical);
// One row per point, quantity and element: "long" or "tidy" data.
std::string export_long_csv(Database& database);

}  // namespace peclet::runner
