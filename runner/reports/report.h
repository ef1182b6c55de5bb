// The verb `peclet report`: a campaign on one page, for a colleague or a notebook.
//
// The page needs no other file and no network. It depends on the database alone: the same one gives the same
// bytes at any time.
#pragma once

#include <filesystem>
#include <string>

#include "runner/database/database.h"

namespace peclet::runner {

struct ReportOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // does not say where it is
};

// Throws IntegrityError when stored looks are not what the stored results say.
std::string report_html(Database& database);

}  // namespace peclet::runner
