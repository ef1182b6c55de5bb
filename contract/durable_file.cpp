#include "contract/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>

namespace peclet {

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

int Descriptor::close() { return ::close(take()); }

Descriptor open_file(const std::filesystem::path& path, int flags, unsigned mode) {
  int number = -1;
  do {
    number = ::open(path.c_str(), flags | O_CLOEXEC, mode);
  } while (number < 0 && errno == EINTR);
  return Descriptor(number);
}

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail_to("cannot write", path);
    }
  }
}

void read_pieces(int descriptor, const std::filesystem::path& path,
                 const std::function<void(std::string_view)>& take, const char* action) {
  std::array<char, 65536> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (;;) {
    const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
    if (count == 0) return;
    if (count < 0 && errno != EINTR) fail_to(action, path);
    if (count > 0) take({chunk.data(), static_cast<std::size_t>(count)});
  }
}

std::size_t read_at(int descriptor, std::uint64_t place, std::span<std::byte> bytes,
                    const std::filesystem::path& path) {
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t more =
        ::pread(descriptor, bytes.data() + filled, bytes.size() - filled, static_cast<off_t>(place + filled));
    if (more < 0 && errno != EINTR) fail_to("cannot read", path);
    if (more == 0) break;
    if (more > 0) filled += static_cast<std::size_t>(more);
  }
  return filled;
}

void synchronise(int descriptor, const std::filesystem::path& path) {
  while (::fsync(descriptor) != 0) {
    if (errno != EINTR) fail_to("cannot synchronise", path);
  }
}

void fail_to(const char* action, const std::filesystem::path& path) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{} {}", action, path.string()));
}

namespace {

// Creates a temporary file beside `path`. Its name has the process number and a count; O_EXCL avoids files
// that an earlier process of the same number left behind.
Descriptor create_temporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  static std::atomic<unsigned> count{0};
  for (;;) {
    temporary = path;
    temporary += fmt::format(".{}.{}.tmp", ::getpid(), count++);
    Descriptor descriptor = open_file(temporary, O_WRONLY | O_CREAT | O_EXCL);
    if (descriptor.number() >= 0) return descriptor;
    if (errno != EEXIST) fail_to("cannot create", path);  // the name that the user knows
  }
}

void synchronise_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const Descriptor descriptor = open_file(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor.number() < 0) fail_to("cannot open", folder);
  synchronise(descriptor.number(), folder);
}

// Replaces `path` by a file of `bytes` bytes that write(descriptor) fills.
template <typename Write>
void replace_durably(const std::filesystem::path& path, std::uint64_t bytes, const Write& write) {
  std::filesystem::path temporary;
  try {
    Descriptor descriptor = create_temporary(path, temporary);
    write(descriptor.number());
    synchronise(descriptor.number(), path);
    if (descriptor.close() != 0 && errno != EINTR) fail_to("cannot close", path);
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail_to("cannot replace", path);
  } catch (const std::system_error& error) {
    ::unlink(temporary.c_str());
    const int number = error.code().value();
    if (means_no_room(number)) throw NoRoomError(number, "cannot write " + path.string(), path, bytes);
    throw;
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  synchronise_folder(path);
}

}  // namespace

bool means_no_room(int error) { return error == ENOSPC || error == EDQUOT; }

bool means_machine_fault(int error) {
  constexpr std::array faults{EIO, ENOMEM, ENFILE, EMFILE, ESTALE, ETIMEDOUT, ENOTCONN, ENOLCK};
  return means_no_room(error) || std::find(faults.begin(), faults.end(), error) != faults.end();
}

void write_durably(const std::filesystem::path& path, std::string_view bytes) {
  replace_durably(path, bytes.size(), [&](int file) { write_all(file, bytes, path); });
}

void write_durably(const std::filesystem::path& path, const std::function<std::string()>& next) {
  replace_durably(path, 0, [&](int file) {
    for (std::string piece = next(); !piece.empty(); piece = next()) write_all(file, piece, path);
  });
}

void copy_durably(int from, std::uint64_t bytes, const std::filesystem::path& path) {
  replace_durably(path, bytes, [&](int file) {
    const auto take = [&](std::string_view piece) { write_all(file, piece, path); };
    read_pieces(from, path, take, "cannot read what becomes");
  });
}

void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Descriptor descriptor = open_file(from, O_RDONLY);
  if (descriptor.number() < 0) fail_to("cannot open", from);
  synchronise(descriptor.number(), from);
  if (::rename(from.c_str(), to.c_str()) != 0) fail_to("cannot replace", to);
  synchronise_folder(to);
}

void create_folders_durably(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return;
  if (path.has_parent_path()) create_folders_durably(path.parent_path());
  if (::mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) {
    const int error = errno;
    if (means_no_room(error)) throw NoRoomError(error, "cannot make " + path.string(), path, 0);
    errno = error;
    fail_to("cannot make", path);
  }
  synchronise_folder(path);
}

std::filesystem::path free_name(const std::filesystem::path& path) {
  std::filesystem::path name = path;
  for (int count = 1; std::filesystem::symlink_status(name).type() != std::filesystem::file_type::not_found;
       ++count) {
    name = path.string() + "." + std::to_string(count);
  }
  return name;
}

std::string read_file(const std::filesystem::path& path) {
  const Descriptor descriptor = open_file(path, O_RDONLY);
  if (descriptor.number() < 0) fail_to("cannot open", path);
  std::string content;
  read_pieces(descriptor.number(), path, [&](std::string_view piece) { content += piece; });
  return content;
}

}  // namespace peclet
