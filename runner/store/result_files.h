// Files of results: the spool, which holds durable results that the owner has not committed yet, and the
// files that a realisation leaves beside its result.
//
// A result lists its files with their sizes and hashes. An engine makes them durable before the result: for
// SPOOL/STEM.json they are SPOOL/files/STEM@NAME. No NAME has an "@", so two jobs, or two attempts at a seed,
// never share a file. The files count once their result is there.
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

// True if a file beside a result may have this name: it is not hidden, an option, a path, or that of a
// temporary file.
bool is_plain_file_name(const std::string& name);

// Throws ResultError for the first invalid entry in the member "files" of a result.
void check_left_files(const Json& files);

// Returns the files that a result lists. Requires that its shape has been checked.
std::vector<LeftFile> left_files(const Json& result);

// Return where the files of the job with this spool file are: their folder, the beginning of their names
// there, and the path of one.
fs::path left_folder(const fs::path& spool);
std::string left_stem(const fs::path& spool);
fs::path left_file(const fs::path& spool, const std::string& name);

// Returns the job's files that are there, listed or not, without unfinished ones.
std::vector<fs::path> left_files_of(const fs::path& spool);

// Opens the regular file at `path` for reading, checks its size and hash, and makes its bytes durable. Throws
// ResultError, which says what is wrong with the file, and std::system_error if the machine fails to read it.
Descriptor open_left_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256);

// Returns why the file at `path` cannot be read or differs from `bytes` and `sha256`; "" if it matches.
std::string fault_of_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256);

// Opens the files of the result, in its order, as open_left_file() does. The ResultError names the file.
std::vector<Descriptor> open_files_in_spool(const Json& result, const fs::path& spool);

// Row of the table `file`: a file that a realisation has left.
struct FileRecord {
  std::string hash;  // hash of the point's scene
  std::int64_t point_id = 0;
  int seed = 0;
  LeftFile file;
  bool kept = true;  // false if it was thrown away, as the campaign asked

  fs::path place(const CampaignDirectory& directory) const {
    return directory.left_files(hash, point_id, seed) / file.name;
  }
};

// Stores the row of a file, inside a Transaction of the caller. Requires that the realisation has its row.
void store_file(Connection& connection, std::int64_t point_id, int seed, const LeftFile& file, bool kept);

// Return the files of all points, of a point, of a seed. Throw IntegrityError for an invalid row.
std::vector<FileRecord> files_in(Connection& connection);
std::vector<FileRecord> files_of_point(Connection& connection, std::int64_t point_id);
std::vector<FileRecord> files_of_seed(Connection& connection, std::int64_t point_id, int seed);

// Reads one spool file; `sha256` is the hash that the engine gave for it, or "". Throws ResultError if it is
// absent, differs, is too large or is not a result.
RealisationResult read_spool_file(const fs::path& path, const std::string& sha256);

// True if the file is named for another point or seed than its result's. Names of other forms are accepted.
bool belongs_to_another(const fs::path& path, const RealisationResult& result);

// Returns the folder whose spool has the file: the campaign's own, or one shared with a batch system.
CampaignDirectory home_of_spool_file(const fs::path& path);

// Returns the complete spool files, by name.
std::vector<fs::path> spool_files(const CampaignDirectory& directory);

// True if anything has that name, also a broken link.
bool is_there(const fs::path& path);
// Returns the regular files in a folder, without links and temporary files, by name.
std::vector<fs::path> whole_files(const fs::path& folder);
// Largest checkpoint or spool file [bytes] that is copied into a backup or out of it.
constexpr std::uint64_t largest_copied_file = std::uint64_t{16} << 30;

// Moves a file, with the files that its realisation left, to spool/rejected/ under names that are free there.
// Returns its new path.
fs::path reject(const CampaignDirectory& directory, const fs::path& path);

// Returns the unfinished temporary files in `folder` whose writers no longer run.
std::vector<fs::path> unfinished_files(const fs::path& folder);
// Removes unfinished_files() and SQLite's files beside them.
void remove_unfinished_files(const fs::path& folder);

}  // namespace peclet::runner
