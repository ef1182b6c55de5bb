// The verb `peclet export`: what a campaign has found, for programs to read.
//
// The canonical form holds what depends on campaign, seeds and engine alone: the seeds of the deciding look
// (of a point that is still open, those of its last look) and nothing of time, cost, machines or attempts.
// Two runs with other numbers of workers, killed or not, give the same bytes. The full form adds the rest.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

enum class ExportFormat { json, csv, long_csv };

struct ExportOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  ExportFormat format = ExportFormat::json;
  bool canonical = false;
  std::filesystem::path output;  // "": standard output
  std::filesystem::path bundle;  // "": no archive of everything
  bool quiet = false;            // does not say where it is
};

// Documents as schema/README.md describes them. Throw IntegrityError when stored looks are not what the
// stored results say.
std::string export_json(Database& database, bool canonical);
// One row per point, with the mean of every scalar quantity.
std::string export_csv(Database& database, bool canonical);
// One row per point, quantity and element: "long" or "tidy" data.
std::string export_long_csv(Database& database);

}  // namespace peclet::runner
