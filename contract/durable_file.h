// Opens, reads and writes files; replaces files so that they are either whole or absent.
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

// Owner of a file descriptor, which its destructor closes.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.take()) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor();

  int number() const { return number_; }
  // Returns the result of close(2), which on some file systems reports late write errors.
  int close();
  // Hands the descriptor over to the caller, who closes it.
  int take() { return std::exchange(number_, -1); }

 private:
  int number_;
};

// Opens a file with open(2) and O_CLOEXEC, again after a signal. If this fails, the number is below 0 and
// errno says why.
Descriptor open_file(const std::filesystem::path& path, int flags, unsigned mode = 0666);

// Writes every byte. Throws std::system_error naming the path.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path);

// Calls take() with every piece of the rest of an open file. Throws std::system_error naming the path.
void read_pieces(int descriptor, const std::filesystem::path& path,
                 const std::function<void(std::string_view)>& take, const char* action = "cannot read");

// Reads bytes at offset `place` [bytes] of an open file. Returns their number, smaller than requested only at
// the end of the file. Throws std::system_error naming the path.
std::size_t read_at(int descriptor, std::uint64_t place, std::span<std::byte> bytes,
                    const std::filesystem::path& path);

// Waits until what was written to an open file is on disk. Throws std::system_error naming the path.
void synchronise(int descriptor, const std::filesystem::path& path);

// Throws std::system_error for errno: "cannot open /the/path: ...".
[[noreturn]] void fail_to(const char* action, const std::filesystem::path& path);

// The file system or the user's quota is full; the write may be tried again later.
class NoRoomError : public std::system_error {
 public:
  NoRoomError(int error, const std::string& doing, std::filesystem::path path, std::uint64_t bytes)
      : std::system_error(error, std::generic_category(), doing), path_(std::move(path)), bytes_(bytes) {}
  const std::filesystem::path& path() const { return path_; }
  // Returns the size of the write that failed [bytes]; 0 if not known.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::filesystem::path path_;
  std::uint64_t bytes_;
};

// Returns true if an errno says that the disk or the quota is full: ENOSPC or EDQUOT.
bool means_no_room(int error);

// Returns true if an errno says that the machine failed while the file may be sound: a full disk, an I/O
// error, no memory, no descriptor left, a file system that does not answer.
bool means_machine_fault(int error);

// Replaces the content of `path` by `bytes`; a crash at any moment leaves the old content or the new one.
// Throws NoRoomError, or std::system_error naming the path; the temporary file is then removed.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

// Replaces the content of `path` by the texts that next() returns up to an empty one. They need not fit into
// memory together. If next() throws, the old content stays. Throws as above.
void write_durably(const std::filesystem::path& path, const std::function<std::string()>& next);

// Replaces the content of `path` by the rest of an open file of `bytes` bytes, which need not fit into
// memory. Throws as write_durably().
void copy_durably(int from, std::uint64_t bytes, const std::filesystem::path& path);

// Renames a file of another program after its bytes are on disk. Throws std::system_error naming the path.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

// Makes a folder and its missing parents durably. Throws NoRoomError, or std::system_error naming the path.
void create_folders_durably(const std::filesystem::path& path);

// Returns the first of PATH, PATH.1, PATH.2 ... that does not exist, not even as a dangling link.
std::filesystem::path free_name(const std::filesystem::path& path);

// Returns the whole content of a file. Throws std::system_error naming the path.
std::string read_file(const std::filesystem::path& path);

}  // namespace peclet
