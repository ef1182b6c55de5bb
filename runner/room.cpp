#include "runner/room.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "contract/durable_file.h"
#include "runner/sqlite.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds patience{3};
// Less than this is no room: a campaign that goes on with the last free block stops again at the next result.
constexpr std::uint64_t least = 1 << 20;
// More than this is not tried, so that looking costs nothing.
constexpr std::uint64_t most = 64 << 20;

// Blocks are really taken; not every file system has a quick way to do that.
int try_to_write(int descriptor, std::uint64_t bytes) {
  const int error = posix_fallocate(descriptor, 0, static_cast<off_t>(bytes));
  if (error != EOPNOTSUPP && error != EINVAL) return error;
  const std::array<char, 65536> zeros{};
  for (std::uint64_t written = 0; written < bytes;) {
    const ssize_t count =
        write(descriptor, zeros.data(), std::min<std::uint64_t>(zeros.size(), bytes - written));
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) written += static_cast<std::uint64_t>(count);
  }
  return fsync(descriptor) == 0 ? 0 : errno;
}

double megabytes(std::uintmax_t bytes) { return 1e-6 * static_cast<double>(bytes); }

}  // namespace

bool has_room(const fs::path& folder, std::uint64_t bytes) {
  // Named as write_durably() names its temporary files, so that it is cleared away after a crash.
  const fs::path trial = folder / fmt::format(".room.{}.0.tmp", getpid());
  const int descriptor = open(trial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) return !peclet::means_no_room(errno);
  const int error = try_to_write(descriptor, std::clamp(bytes, least, most));
  close(descriptor);
  unlink(trial.c_str());
  return !peclet::means_no_room(error);
}

bool means_no_room(const std::exception& error) {
  if (const auto* database = dynamic_cast<const DatabaseError*>(&error)) return database->no_room();
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && peclet::means_no_room(system->code().value());
}

std::string shortage_text(const fs::path& folder, std::uint64_t bytes) {
  std::error_code unknown;
  const fs::space_info space = fs::space(folder, unknown);
  return fmt::format("{} is full: {:.1f} MB are free there, {:.1f} MB are needed", folder.string(),
                     unknown ? 0 : megabytes(space.available), megabytes(std::max(bytes, least)));
}

void Shortage::begin(const fs::path& folder, std::uint64_t bytes, Time now) {
  const bool news = !lasts();
  if (news) looked_ = now;
  bytes_ = news || *folder_ != folder ? bytes : std::max(bytes_, bytes);
  folder_ = folder;
}

bool Shortage::is_over(Time now) {
  if (!lasts() || now - looked_ < patience) return false;
  looked_ = now;
  if (!has_room(*folder_, bytes_)) return false;
  folder_.reset();
  return true;
}

}  // namespace peclet::runner
