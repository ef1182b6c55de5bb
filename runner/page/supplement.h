// `peclet export --bundle`: all that a reader of a paper needs of a campaign, in one file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

// Archives of files in one file, as tar and gzip write them.

struct ArchivedFile {
  std::string name;  // below the folder of the archive, at most 100 characters
  std::string bytes;
  bool executable = false;
};

// The files below `folder` (at most 100 characters) in the format ustar of POSIX.1-1988, in the order in
// which they are given, of nobody in particular, last changed at `time` (seconds since 1970). The same files
// give the same bytes. Throws std::length_error for what the format has no room for.
std::string tar(const std::string& folder, const std::vector<ArchivedFile>& files, std::int64_t time);

// As gzip -9 deflates, without a name and a time (RFC 1952). Throws std::runtime_error.
std::string gzip(std::string_view bytes);

// Throws InputError at --bundle unless the name ends in .tar.gz or .tgz.
void check_supplement_name(const std::filesystem::path& output);

// A compressed archive with a folder of the campaign's name in it, last changed when the last seed ended:
// README.md first, campaign file, exports as JSON, CSV and long CSV, the page, the figure with its script,
// provenance, and SHA256SUMS last. README.md has the table of results, and says what each file is, which
// number is the one, and how to check and to redo it. All are of the one snapshot that the reader has. They
// depend on the database alone, and on who runs the campaign (`owner`), which the page says; the same state
// gives the same bytes. Throws InputError where nothing has been measured yet, IntegrityError.
std::string supplement(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
