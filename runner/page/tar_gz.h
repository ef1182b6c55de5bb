// Archives of files in one file, as tar and gzip write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace peclet::runner {

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

}  // namespace peclet::runner
