// The spool, which holds durable results that the owner has not committed yet, and the files that a
// realisation leaves beside its result, which lists them with their sizes and hashes.
//
// An engine makes them durable before the result: beside SPOOL/STEM.json they are SPOOL/files/STEM@NAME. No
// name has an "@", so that no two jobs, and no two attempts at a seed, have a file in common. The result is
// what makes them count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "contract/json.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/realisation_result.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

struct LeftFile {
  std::string name;
  std::uint64_t bytes = 0;
  std::string sha256;
};

constexpr std::size_t longest_left_name = 64;

// Throws ResultError for the first thing in the member "files" of a result that is not as it must be.
void check_left_files(const Json& files);

// Requires a result whose shape has been checked.
std::vector<LeftFile> left_files(const Json& result);

// Where the files of the job with this spool file are: the folder, what their names begin with there, and
// one.
fs::path left_folder(const fs::path& spool);
std::string left_stem(const fs::path& spool);
fs::path left_file(const fs::path& spool, const std::string& name);

// Those that are there, listed or not, without unfinished ones.
std::vector<fs::path> left_files_of(const fs::path& spool);

// Returns the regular file of that size and hash at `path`, open for reading; its bytes are then on disk.
// Throws ResultError, which says what is wrong with the file, and std::system_error if the machine fails to
// read it.
Descriptor open_left_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256);

// Returns what is wrong with the file at `path`, or with the machine that reads it; "" if nothing is.
std::string fault_of_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256);

// Returns the files of the result, in its order, as open_left_file(). The ResultError names the file.
std::vector<Descriptor> open_files_in_spool(const Json& result, const fs::path& spool);

// The files that realisations have left, as the table `file` has them.
struct FileRecord {
  std::string hash;  // of the point's scene
  std::int64_t point_id = 0;
  int seed = 0;
  LeftFile file;
  bool kept = true;  // false: thrown away, as the campaign asked for

  fs::path place(const CampaignDirectory& directory) const {
    return directory.left_files(hash, point_id, seed) / file.name;
  }
};

// For use inside a Transaction of the caller. Requires that the realisation has its row.
void store_file(Connection& connection, std::int64_t point_id, int seed, const LeftFile& file, bool kept);

// Those of all points, of a point, of a seed.
std::vector<FileRecord> files_in(Connection& connection);
std::vector<FileRecord> files_of_point(Connection& connection, std::int64_t point_id);
std::vector<FileRecord> files_of_seed(Connection& connection, std::int64_t point_id, int seed);

// Reads one spool file; `sha256` is what the engine says about its bytes ("" when nobody is left to say it).
// Throws ResultError when it is absent, differs, is too large or is no result.
RealisationResult read_spool_file(const fs::path& path, const std::string& sha256);

// Whether the file bears the name of another point's or seed's result. Files with names of other forms are
// accepted.
bool belongs_to_another(const fs::path& path, const RealisationResult& result);

// The folder whose spool the file lies in: the campaign's own, or one that is shared with a batch system.
CampaignDirectory home_of_spool_file(const fs::path& path);

// Complete spool files, by name.
std::vector<fs::path> spool_files(const CampaignDirectory& directory);

// Whether anything bears that name, be it no file or a link that leads nowhere.
bool is_there(const fs::path& path);
// The files in a folder that are regular ones, not links to some, and no temporary ones; by name.
std::vector<fs::path> whole_files(const fs::path& folder);
// A checkpoint may be large; what is larger than this is none, and is not copied into a backup or out of it.
constexpr std::uint64_t largest_copied_file = std::uint64_t{16} << 30;

// Moves a file to spool/rejected/, with what its realisation left, under names that are free there, and says
// where it is now.
fs::path reject(const CampaignDirectory& directory, const fs::path& path);

// The unfinished temporary files in `folder` whose writers no longer run.
std::vector<fs::path> unfinished_files(const fs::path& folder);
// Removes the unfinished temporary files in `folder` whose writers no longer run.
void remove_unfinished_files(const fs::path& folder);

}  // namespace peclet::runner
