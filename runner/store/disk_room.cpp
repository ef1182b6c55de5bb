#include "runner/store/disk_room.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "contract/durable_file.h"

namespace peclet::runner {
namespace {

// Least room [bytes] that is asked for: with less, a campaign would stop again at the next result.
constexpr std::uint64_t least = 1 << 20;
// Most room [bytes] that is tried, so that a trial is cheap.
constexpr std::uint64_t most = 64 << 20;

// Takes blocks on the disk. Writes zeros if the file system cannot allocate blocks. Returns 0 or an errno.
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

int lack_of_room(const fs::path& folder, std::uint64_t bytes) {
  // Named like the temporary files of write_durably(), so that it is removed after a crash.
  const fs::path trial = folder / fmt::format(".room.{}.0.tmp", getpid());
  unlink(trial.c_str());
  const int descriptor = open(trial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const int error = descriptor < 0 ? errno : try_to_write(descriptor, std::clamp(bytes, least, most));
  if (descriptor >= 0) close(descriptor);
  unlink(trial.c_str());
  return peclet::means_no_room(error) ? error : 0;
}

std::string shortage_text(const fs::path& folder, std::uint64_t bytes, int error) {
  const double needed = megabytes(std::max(bytes, least));
  if (error == EDQUOT) {
    return fmt::format("{} is full: your disk quota is used up there (`quota -s`), {:.1f} MB are needed",
                       folder.string(), needed);
  }
  struct statvfs about {};
  if (statvfs(folder.c_str(), &about) == 0 && about.f_files > 0 && about.f_favail == 0) {
    return fmt::format(
        "{} is full: all {} inodes of its file system are taken, and no further file can be made",
        folder.string(), static_cast<std::uintmax_t>(about.f_files));
  }
  std::error_code unknown;
  const fs::space_info space = fs::space(folder, unknown);
  return fmt::format("{} is full: {:.1f} MB are free there, {:.1f} MB are needed", folder.string(),
                     unknown ? 0 : megabytes(space.available), needed);
}

std::string why_in_vain(const fs::path& root, const fs::path& folder, std::uint64_t bytes) {
  struct statvfs whole {};
  struct stat place {};
  if (statvfs(folder.c_str(), &whole) != 0 || stat(folder.c_str(), &place) != 0) return "";
  const std::uint64_t size = std::uint64_t{whole.f_blocks} * whole.f_frsize;
  std::uint64_t own = 0;
  std::error_code gone;  // files may vanish meanwhile
  for (fs::recursive_directory_iterator file(root, gone), end; !gone && file != end; file.increment(gone)) {
    struct stat about {};
    // Other files at the top of the folder are not the campaign's and may be taken away.
    const bool is_ours = file.depth() > 0 || file->path().filename().string().starts_with("campaign.");
    const bool counts = is_ours && lstat(file->path().c_str(), &about) == 0 && S_ISREG(about.st_mode) &&
                        about.st_dev == place.st_dev;
    if (counts) own += std::uint64_t{static_cast<std::uint64_t>(about.st_blocks)} * 512;
  }
  const std::uint64_t needed = std::max(bytes, least);
  if (size >= own + needed) return "";
  return fmt::format(
      "{}: its file system has {:.1f} MB in all, of which the campaign takes {:.1f} MB; {:.1f} MB more are "
      "needed, for which no room can be made: move the campaign to a larger one",
      folder.string(), megabytes(size), megabytes(own), megabytes(needed));
}

}  // namespace peclet::runner
