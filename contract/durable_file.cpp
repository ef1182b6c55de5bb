#include "contract/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace peclet {

namespace {

[[noreturn]] void fail(const char* action, const std::filesystem::path& path) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{} {}", action, path.string()));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }
  // Closing reports late write errors on some file systems; afterwards the destructor has nothing to do.
  int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

int open_again_if_interrupted(const std::filesystem::path& path, int flags) {
  int number = -1;
  do {
    number = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  } while (number < 0 && errno == EINTR);
  return number;
}

// A name that no other writer uses: the process's number and a count, and O_EXCL against what an earlier
// process of the same number left behind.
Descriptor create_temporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  static std::atomic<unsigned> count{0};
  for (;;) {
    temporary = path;
    temporary += fmt::format(".{}.{}.tmp", ::getpid(), count++);
    const int number = open_again_if_interrupted(temporary, O_WRONLY | O_CREAT | O_EXCL);
    if (number >= 0) return Descriptor(number);
    if (errno != EEXIST) fail("cannot create", temporary);
  }
}

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail("cannot write", path);
    }
  }
}

void synchronise(int descriptor, const std::filesystem::path& path) {
  while (::fsync(descriptor) != 0) {
    if (errno != EINTR) fail("cannot synchronise", path);
  }
}

void synchronise_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const Descriptor descriptor(open_again_if_interrupted(folder, O_RDONLY | O_DIRECTORY));
  if (descriptor.number() < 0) fail("cannot open", folder);
  synchronise(descriptor.number(), folder);
}

}  // namespace

bool means_no_room(int error) { return error == ENOSPC || error == EDQUOT; }

void write_durably(const std::filesystem::path& path, std::string_view bytes) {
  std::filesystem::path temporary;
  try {
    Descriptor descriptor = create_temporary(path, temporary);
    write_all(descriptor.number(), bytes, path);
    synchronise(descriptor.number(), path);
    if (descriptor.close() != 0 && errno != EINTR) fail("cannot close", path);
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot replace", path);
  } catch (const std::system_error& error) {
    ::unlink(temporary.c_str());
    const int number = error.code().value();
    if (means_no_room(number)) throw NoRoomError(number, "cannot write " + path.string(), path, bytes.size());
    throw;
  }
  synchronise_folder(path);
}

void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Descriptor descriptor(open_again_if_interrupted(from, O_RDONLY));
  if (descriptor.number() < 0) fail("cannot open", from);
  synchronise(descriptor.number(), from);
  if (::rename(from.c_str(), to.c_str()) != 0) fail("cannot replace", to);
  synchronise_folder(to);
}

std::filesystem::path free_name(const std::filesystem::path& path) {
  std::filesystem::path name = path;
  for (int count = 1; std::filesystem::exists(name); ++count) {
    name = path.string() + "." + std::to_string(count);
  }
  return name;
}

std::string read_file(const std::filesystem::path& path) {
  const Descriptor descriptor(open_again_if_interrupted(path, O_RDONLY));
  if (descriptor.number() < 0) fail("cannot open", path);
  std::string content;
  std::array<char, 65536> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (;;) {
    const ssize_t count = ::read(descriptor.number(), chunk.data(), chunk.size());
    if (count == 0) return content;
    if (count > 0) {
      content.append(chunk.data(), static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      fail("cannot read", path);
    }
  }
}

}  // namespace peclet
