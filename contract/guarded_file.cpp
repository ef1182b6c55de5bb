#include "contract/guarded_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <sstream>

namespace peclet {
namespace {

namespace fs = std::filesystem;

const char* kind_of(mode_t mode) {
  if (S_ISLNK(mode)) return "a link";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISREG(mode)) return "a regular file";
  return "a device";
}

[[noreturn]] void refuse(const fs::path& path, const std::string& found) {
  throw UnsuitableFile(path.string(), "", "is " + found, "must be a regular file: move it away");
}

[[noreturn]] void refuse_size(const fs::path& path, std::uint64_t most) {
  throw UnsuitableFile(path.string(), "", "is too large", fmt::format("must have at most {} bytes", most));
}

std::uint64_t size_of(const Descriptor& file, const fs::path& path) {
  struct stat about {};
  if (fstat(file.number(), &about) != 0) fail_to("cannot examine", path);
  return static_cast<std::uint64_t>(about.st_size);
}

}  // namespace

std::string kind_of(const fs::path& path) {
  struct stat about {};
  return lstat(path.c_str(), &about) == 0 ? kind_of(about.st_mode) : "";
}

void require_regular(const fs::path& path) {
  struct stat about {};
  if (lstat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode)) refuse(path, kind_of(about.st_mode));
}

// The kind is checked before opening, because opening a device may have an effect, and again afterwards,
// because the file may have been replaced in between.
Descriptor open_regular(const fs::path& path, int flags, unsigned mode) {
  require_regular(path);
  Descriptor file = open_file(path, flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, mode);
  if (file.number() < 0) {
    const int error = errno;
    require_regular(path);
    errno = error;
    fail_to("cannot open", path);
  }
  struct stat about {};
  if (fstat(file.number(), &about) != 0) fail_to("cannot examine", path);
  if (!S_ISREG(about.st_mode)) refuse(path, kind_of(about.st_mode));
  const int status = fcntl(file.number(), F_GETFL);
  if (status < 0 || fcntl(file.number(), F_SETFL, status & ~O_NONBLOCK) != 0) fail_to("cannot open", path);
  return file;
}

std::string read_regular(const fs::path& path, std::uint64_t most) {
  const Descriptor file = open_regular(path, O_RDONLY);
  const std::uint64_t size = size_of(file, path);
  if (size > most) refuse_size(path, most);
  std::string content;
  content.reserve(size);
  read_pieces(file.number(), path, [&](std::string_view piece) {
    content += piece;
    if (content.size() > most) refuse_size(path, most);  // it has grown
  });
  return content;
}

void copy_regular(const fs::path& from, const fs::path& to, std::uint64_t most) {
  const Descriptor file = open_regular(from, O_RDONLY);
  const std::uint64_t bytes = size_of(file, from);
  if (bytes > most) refuse_size(from, most);
  copy_durably(file.number(), bytes, to);
}

void require_own_folder(const fs::path& path, bool may_be_link, uid_t self) {
  struct stat about {};
  if (lstat(path.c_str(), &about) != 0) return;  // the caller makes the folder, or reports why that fails
  if (S_ISLNK(about.st_mode) && may_be_link && stat(path.c_str(), &about) != 0)
    fail_to("cannot follow", path);
  if (!S_ISDIR(about.st_mode)) {
    throw UnsuitableFile(path.string(), "", fmt::format("is {}", kind_of(about.st_mode)),
                         "must be a folder: move it away");
  }
  if (about.st_uid == self || about.st_uid == 0) return;
  throw UnsuitableFile(
      path.string(), "", fmt::format("belongs to the user {}", user_name(about.st_uid)),
      fmt::format("must be your own, because its owner can make it lead elsewhere: run as that user, "
                  "or make it yours with `sudo chown -R {} {}`",
                  user_name(self), path.string()));
}

// getpwuid(3) would also ask network directories, through libraries that a static program cannot load.
std::string user_name(uid_t user) {
  std::ifstream users("/etc/passwd");
  std::string number = std::to_string(user);
  for (std::string line; std::getline(users, line);) {
    std::istringstream fields(line);
    std::string name, password, id;
    if (std::getline(fields, name, ':') && std::getline(fields, password, ':') &&
        std::getline(fields, id, ':') && id == number) {
      return name;
    }
  }
  return number;
}

}  // namespace peclet
