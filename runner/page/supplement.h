// `peclet export --bundle`: all files of a campaign that a reader of a paper needs, in one archive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

struct ArchivedFile {
  std::string name;  // below the folder of the archive, at most 100 characters
  std::string bytes;
  bool executable = false;
};

// Returns an archive of the files below `folder` (at most 155 characters) in the format ustar of
// POSIX.1-1988, without an owner and last changed at `time` [s since 1970]. The same files give the same
// bytes. Throws std::length_error for a name, folder or file that is too long for the format.
std::string tar(const std::string& folder, const std::vector<ArchivedFile>& files, std::int64_t time);

// Returns the bytes compressed as by gzip -9, without name and time (RFC 1952). Throws std::runtime_error.
std::string gzip(std::string_view bytes);

// Throws InputError at --bundle unless the name ends in .tar.gz or .tgz.
void check_supplement_name(const std::filesystem::path& output);

// Returns a compressed archive with a folder of the campaign's name, last changed when the last seed ended.
// It has README.md, the campaign file, the exports as CSV, long CSV and JSON, the page, the script of the
// figure, the provenance and SHA256SUMS. README.md has the table of results, describes the files, and tells
// how to check and reproduce them. All files show the one state of the database that the reader has, and
// depend on that and on the process that runs the campaign (`owner`), which the page names; the same state
// gives the same bytes. Throws InputError if nothing has been measured yet, and IntegrityError.
std::string supplement(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
