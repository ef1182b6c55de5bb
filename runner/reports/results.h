// The verb `peclet results`: every stored result as the engine wrote it, one JSON object a line, for programs
// that cannot inflate what the database holds.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "runner/store/database.h"

namespace peclet::runner {

struct ResultsOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::string point;  // label or beginning of the hash; all points unless given
  std::optional<int> seed;
};

// Gives `take` the lines in the order of points and seeds, one at a time, without their newlines. Each is an
// object of `label`, `hash`, `settings`, `seed`, `deciding` (whether the last look counts the seed) and
// `result`. Throws InputError for a point that is not there, or when there is no result of `seed`.
void for_each_result_line(Database& database, const std::string& point, std::optional<int> seed,
                          const std::function<void(const std::string& line)>& take);

}  // namespace peclet::runner
