// Open files, and files that are either whole or not there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace peclet {

// An open file that is closed when its owner goes.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.take()) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor();

  int number() const { return number_; }
  // Closing reports late write errors on some file systems; afterwards the destructor has nothing to do.
  int close();
  // Leaves it to the caller.
  int take() { return std::exchange(number_, -1); }

 private:
  int number_;
};

// As open(2) with O_CLOEXEC, again after a signal; a number below 0 with errno when it cannot be opened.
Descriptor open_file(const std::filesystem::path& path, int flags, unsigned mode = 0666);

// Writes every byte. Throws std::system_error naming the path.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path);

// Takes what is left to read of an open file, piece by piece. Throws std::system_error naming the path.
void read_pieces(int descriptor, const std::filesystem::path& path,
                 const std::function<void(std::string_view)>& take, const char* action = "cannot read");

// Reads bytes at a place of an open file; returns their number, which is less only where the file ends.
// Throws std::system_error naming the path.
std::size_t read_at(int descriptor, std::uint64_t place, std::span<std::byte> bytes,
                    const std::filesystem::path& path);

// Has what was written on disk. Throws std::system_error naming the path.
void synchronise(int descriptor, const std::filesystem::path& path);

// Throws what errno says: "cannot open /the/path: ...".
[[noreturn]] void fail_to(const char* action, const std::filesystem::path& path);

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
