// Files that are either there whole or not there: temporary file, fsync, rename, fsync of the folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace peclet {

// The file system is full, or the user's quota of it: what could not be written may be tried again later.
class NoRoomError : public std::system_error {
 public:
  NoRoomError(int error, const std::string& doing, std::filesystem::path path, std::uint64_t bytes)
      : std::system_error(error, std::generic_category(), doing), path_(std::move(path)), bytes_(bytes) {}
  const std::filesystem::path& path() const { return path_; }
  // How much was to be written.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::filesystem::path path_;
  std::uint64_t bytes_;
};

// Whether an errno says that there is no room: ENOSPC or EDQUOT.
bool means_no_room(int error);

// Whether an errno says that the machine failed and the file may be sound: no room, an I/O error, no memory,
// no descriptor left, a file system that is away.
bool means_machine_fault(int error);

// Replaces `path` by `bytes` so that a crash at any moment leaves the old content or the new one.
// Throws NoRoomError, or std::system_error naming the path; the temporary file is then removed.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

// The same with the texts that `next` hands out one after the other, up to an empty one, which together need
// not fit into memory. What `next` throws leaves the old content.
void write_durably(const std::filesystem::path& path, const std::function<std::string()>& next);

// The same with what is left to read of an open file of `bytes` bytes, which need not fit into memory.
void copy_durably(int from, std::uint64_t bytes, const std::filesystem::path& path);

// Gives a file that somebody else has written its final name: its bytes are on disk before the name is.
// Throws std::system_error naming the path.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

// Makes a folder and those above it that are not there; what is made stays after a power cut.
// Throws NoRoomError, or std::system_error naming the path.
void create_folders_durably(const std::filesystem::path& path);

// The first of PATH, PATH.1, PATH.2 ... that is not there, not even as a link to nothing.
std::filesystem::path free_name(const std::filesystem::path& path);

// The whole content. Throws std::system_error naming the path.
std::string read_file(const std::filesystem::path& path);

}  // namespace peclet
