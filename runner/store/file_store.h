// The files that realisations have left, as the table `file` has them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runner/store/campaign_directory.h"
#include "runner/store/result_files.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

struct FileRecord {
  std::string hash;  // of the point's scene
  std::int64_t point_id = 0;
  int seed = 0;
  LeftFile file;
  bool kept = true;  // false: thrown away, as the campaign asked for

  std::filesystem::path place(const CampaignDirectory& directory) const {
    return directory.left_files(hash, point_id, seed) / file.name;
  }
};

// For use inside a Transaction of the caller. Requires that the realisation has its row.
void store_file(Connection& connection, std::int64_t point_id, int seed, const LeftFile& file, bool kept);

// Those of all points, of a point, of a seed.
std::vector<FileRecord> files_in(Connection& connection);
std::vector<FileRecord> files_of_point(Connection& connection, std::int64_t point_id);
std::vector<FileRecord> files_of_seed(Connection& connection, std::int64_t point_id, int seed);

}  // namespace peclet::runner
