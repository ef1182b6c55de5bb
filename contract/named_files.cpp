#include "contract/named_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_size(const fs::path& path, const std::string& size, std::size_t most) {
  throw InputError(path.string(), "", size, fmt::format("must be at most {} MiB", most >> 20U));
}

[[noreturn]] void fail(const fs::path& path, int error) {
  throw InputError(path.string(), "", "",
                   fmt::format("cannot be read: {}", std::generic_category().message(error)));
}

constexpr int most_links = 40;  // as in the kernel

// Where a name leads after all links.
struct Target {
  fs::path path;
  std::optional<int> descriptor;  // of this process, if the name stands for one
  bool exists = false;
  mode_t mode = 0;
};

[[noreturn]] void refuse_output(const fs::path& path, const std::string& why) {
  throw InputError(path.string(), "", "", why);
}

[[noreturn]] void refuse_output(const fs::path& path, int error) {
  refuse_output(path, fmt::format("cannot be written: {}", std::generic_category().message(error)));
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

// Returns the descriptor of this process that the path stands for, if any: /dev/stdout is a link to
// /proc/self/fd/1. Opening that path would begin at the start of a file to which a shell appends, and would
// fail for a socket.
std::optional<int> descriptor_named(const fs::path& path) {
  std::error_code absent, without_proc;
  const fs::path folder = fs::canonical(folder_of(path), absent);
  const fs::path own = fs::canonical("/proc/self/fd", without_proc);
  const std::string name = path.filename().string();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = !name.empty() && error == std::errc{} && end == name.data() + name.size();
  if (absent || without_proc || !is_number || folder != own) return std::nullopt;
  return number;
}

Target follow(const fs::path& given) {
  Target target{given, std::nullopt};
  for (int links = 0; links < most_links; ++links) {
    target.descriptor = descriptor_named(target.path);
    if (target.descriptor) return target;
    struct stat about {};
    target.exists = lstat(target.path.c_str(), &about) == 0;
    if (!target.exists && errno != ENOENT) refuse_output(given, errno);
    target.mode = about.st_mode;
    if (!target.exists || !S_ISLNK(about.st_mode)) return target;
    std::error_code error;
    const fs::path next = fs::read_symlink(target.path, error);
    if (error) refuse_output(given, error.value());
    target.path = next.is_absolute() ? next : folder_of(target.path) / next;
  }
  refuse_output(given, ELOOP);
}

void check(const fs::path& given, const Target& target) {
  if (target.descriptor) {
    const int status = fcntl(*target.descriptor, F_GETFL);
    if (status < 0 || (status & O_ACCMODE) == O_RDONLY) refuse_output(given, EBADF);
    return;
  }
  if (!target.path.has_filename()) refuse_output(given, "must be the name of a file, not of a folder");
  if (!target.exists || S_ISREG(target.mode)) {
    const fs::path folder = folder_of(target.path);
    struct stat about {};
    if (stat(folder.c_str(), &about) != 0) {
      refuse_output(given, fmt::format("cannot be written: the folder {} is not there", folder.string()));
    }
    if (access(folder.c_str(), W_OK | X_OK) != 0) refuse_output(given, errno);
    return;
  }
  if (S_ISDIR(target.mode)) refuse_output(given, "is a folder: must be the name of a file");
  if (S_ISSOCK(target.mode)) refuse_output(given, "is a socket: must be the name of a file");
  if (access(target.path.c_str(), W_OK) != 0) refuse_output(given, errno);
}

// Calls replace(path) for a regular or absent file, write_to(descriptor) for anything else.
template <class Replace, class WriteTo>
void write(const fs::path& path, const Replace& replace, const WriteTo& write_to) {
  const Target target = follow(path);
  check(path, target);
  if (target.descriptor) return write_to(*target.descriptor);
  if (!target.exists || S_ISREG(target.mode)) return replace(target.path);
  Descriptor file = open_file(target.path, O_WRONLY | O_NOCTTY);
  if (file.number() < 0) fail_to("cannot open", path);
  write_to(file.number());
  if (file.close() != 0 && errno != EINTR) fail_to("cannot close", path);
}

}  // namespace

std::string read_input(const fs::path& path, const InputLimits& limits) {
  const Descriptor file = open_file(path, O_RDONLY | O_NOCTTY);
  struct stat about {};
  if (file.number() < 0 || fstat(file.number(), &about) != 0) fail(path, errno);
  if (S_ISREG(about.st_mode) && static_cast<std::size_t>(about.st_size) > limits.bytes) {
    refuse_size(path, fmt::format("{:.0f} MiB", std::ceil(static_cast<double>(about.st_size) / (1U << 20U))),
                limits.bytes);
  }
  std::string content;
  try {
    read_pieces(file.number(), path, [&](std::string_view piece) {
      content += piece;
      if (content.size() > limits.bytes)
        refuse_size(path, fmt::format("more than {} MiB", limits.bytes >> 20U), limits.bytes);
    });
  } catch (const std::system_error& error) {
    fail(path, error.code().value());
  }
  return content;
}

Json read_json_input(const fs::path& path, const InputLimits& limits) {
  return parse_json_input(read_input(path, limits), path.string(), limits.values);
}

void check_output(const fs::path& path) { check(path, follow(path)); }

void write_output(const fs::path& path, std::string_view bytes) {
  write(
      path, [&](const fs::path& target) { write_durably(target, bytes); },
      [&](int file) { write_all(file, bytes, path); });
}

void write_output(const fs::path& path, const std::function<std::string()>& next) {
  write(
      path, [&](const fs::path& target) { write_durably(target, next); },
      [&](int file) {
        for (std::string piece = next(); !piece.empty(); piece = next()) write_all(file, piece, path);
      });
}

}  // namespace peclet
