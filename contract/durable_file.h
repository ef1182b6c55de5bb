// Files that are either there whole or not there: temporary file, fsync, rename, fsync of the folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace peclet {

// Replaces `path` by `bytes` so that a crash at any moment leaves the old content or the new one.
// Throws std::system_error naming the path; the temporary file is then removed.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

// Gives a file that somebody else has written its final name: its bytes are on disk before the name is.
// Throws std::system_error naming the path.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

// The whole content. Throws std::system_error naming the path.
std::string read_file(const std::filesystem::path& path);

}  // namespace peclet
