#include "contract/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "contract/descriptor.h"
#include "contract/input_error.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_size(const fs::path& path, const std::string& size, std::size_t most) {
  throw InputError(path.string(), "", size, fmt::format("must be at most {} MiB", most >> 20U));
}

[[noreturn]] void fail(const fs::path& path) {
  throw InputError(path.string(), "", "", fmt::format("cannot be read: {}", std::strerror(errno)));
}

}  // namespace

std::string read_input(const fs::path& path, const InputLimits& limits) {
  const Descriptor file = open_file(path, O_RDONLY | O_NOCTTY);
  struct stat about {};
  if (file.number() < 0 || fstat(file.number(), &about) != 0) fail(path);
  if (S_ISREG(about.st_mode) && static_cast<std::size_t>(about.st_size) > limits.bytes) {
    refuse_size(path, fmt::format("{:.0f} MiB", std::ceil(static_cast<double>(about.st_size) / (1U << 20U))),
                limits.bytes);
  }
  std::string content;
  std::array<char, 65536> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (;;) {
    const ssize_t count = ::read(file.number(), chunk.data(), chunk.size());
    if (count == 0) return content;
    if (count < 0 && errno != EINTR) fail(path);
    if (count > 0) content.append(chunk.data(), static_cast<std::size_t>(count));
    if (content.size() > limits.bytes)
      refuse_size(path, fmt::format("more than {} MiB", limits.bytes >> 20U), limits.bytes);
  }
}

Json read_json_input(const fs::path& path, const InputLimits& limits) {
  return parse_json_input(read_input(path, limits), path.string(), limits.values);
}

}  // namespace peclet
