#include "runner/store/locks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include "contract/guarded_file.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"

namespace peclet::runner {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

// Lines of /proc/locks: "1: POSIX  ADVISORY  WRITE 4711 fe:01:1234 120 120", "2: FLOCK  ADVISORY  WRITE 4711
// fe:01:1234 0 EOF".
std::int64_t process_that_locks(std::uint64_t inode, const std::string& kind, std::uint64_t at) {
  const std::string place_ends = fmt::format(":{}", inode);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string count, its_kind, mode, access, process, place, first, last;
    words >> count >> its_kind >> mode >> access >> process >> place >> first >> last;
    if (its_kind != kind || access != "WRITE" || !place.ends_with(place_ends)) continue;
    const auto end =
        number_in<std::uint64_t>(last).value_or(std::numeric_limits<std::uint64_t>::max());  // "EOF"
    if (number_in<std::uint64_t>(first).value_or(0) <= at && at <= end) {
      return number_in<std::int64_t>(process).value_or(0);
    }
  }
  return 0;
}

namespace {

// True if the file still has its name.
bool is_there(int descriptor, const fs::path& file) {
  struct stat held {
  }, named{};
  return fstat(descriptor, &held) == 0 && stat(file.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
         held.st_ino == named.st_ino;
}

// Opens and locks the file or folder, and returns it.
Descriptor locked(const fs::path& path) {
  for (;;) {
    Descriptor file = open_file(path, O_RDONLY);
    const auto is_locked = [&] { return file.number() >= 0 && flock(file.number(), LOCK_EX) == 0; };
    while (!is_locked()) {
      if (errno != EINTR) throw std::system_error(errno, std::generic_category(), path.string());
    }
    // A file that was replaced during the wait is opened again.
    if (is_there(file.number(), path)) return file;
  }
}

Descriptor open_folder(const CampaignDirectory& directory) {
  return open_file(directory.root(), O_RDONLY | O_DIRECTORY);
}

// Returns a descriptor below 0 if the file is absent or may not be read.
Descriptor open_for_reading(const fs::path& file) {
  require_regular(file);
  return open_file(file, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
}

std::int64_t written_owner(const CampaignDirectory& directory) {
  const Descriptor file = open_for_reading(directory.lock());
  std::array<char, 32> text{};
  const ssize_t count = pread(file.number(), text.data(), text.size(), 0);
  std::string_view said(text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  return number_in<std::int64_t>(take_line(said)).value_or(0);
}

// Returns the process that has locked the folder by the kernel's list, also if campaign.lock was deleted; 0
// if the list does not name it.
std::int64_t listed_owner(int folder) {
  struct stat about {};
  return fstat(folder, &about) == 0 ? process_that_locks(about.st_ino, "FLOCK") : 0;
}

std::int64_t owner_of(const CampaignDirectory& directory, int folder) {
  const std::int64_t listed = listed_owner(folder);
  return listed > 0 ? listed : written_owner(directory);
}

enum class Attempt { locked, owned, impossible };

// Tries for 0.2 s: readers that ask current_owner() hold the lock for an instant, an owner for longer.
Attempt lock_patiently(int descriptor) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return Attempt::locked;
    if (errno != EWOULDBLOCK && errno != EINTR) return Attempt::impossible;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return Attempt::owned;
}

[[noreturn]] void refuse_owned(const CampaignDirectory& directory, int folder) {
  const std::int64_t owner = owner_of(directory, folder);
  const std::string who = owner > 0 ? fmt::format("process {}", owner) : "another process";
  const std::string stop =
      owner > 0 ? fmt::format("`kill {}` lets it save and stop", owner) : "stop it first";
  throw OwnedByAnother(fmt::format("{}: {} owns this campaign; look at it with `peclet status {}`; {}",
                                   directory.root().string(), who, shell_word(directory.root().string()),
                                   stop));
}

// Throws an error that says how to continue a campaign of another user, such as one run as root.
[[noreturn]] void fail(const fs::path& path, int error) {
  struct stat about {};
  const bool foreign =
      error == EACCES && stat(path.parent_path().c_str(), &about) == 0 && about.st_uid != geteuid();
  if (!foreign) throw std::system_error(error, std::generic_category(), path.string());
  throw std::runtime_error(fmt::format(
      "{}: belongs to the user {}, and may not be written by you: run it as that user, or make it yours with "
      "`sudo chown -R {} {}`",
      path.parent_path().string(), user_name(about.st_uid), user_name(geteuid()),
      path.parent_path().string()));
}

Descriptor owned_folder(const CampaignDirectory& directory) {
  require_own_folders(directory);
  Descriptor folder = open_folder(directory);
  if (folder.number() < 0) fail(directory.lock(), errno);
  // Some network file systems, allowed at the user's own risk, cannot lock folders.
  if (lock_patiently(folder.number()) == Attempt::owned) refuse_owned(directory, folder.number());
  return folder;
}

Descriptor owned_file(const CampaignDirectory& directory, int folder) {
  require_regular(directory.lock());
  Descriptor file = open_file(directory.lock(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, 0644);
  if (file.number() < 0) fail(directory.lock(), errno);
  const Attempt attempt = lock_patiently(file.number());
  if (attempt == Attempt::owned) refuse_owned(directory, folder);
  if (attempt == Attempt::impossible) fail(directory.lock(), errno);
  return file;
}

}  // namespace

FileLock::FileLock(const fs::path& path) : file_(locked(path)) {}

OwnerLock::OwnerLock(const CampaignDirectory& directory)
    : folder_(owned_folder(directory)), file_(owned_file(directory, folder_.number())) {
  const std::string process = fmt::format("{}\n", getpid());
  const bool written =
      ftruncate(file_.number(), 0) == 0 &&
      pwrite(file_.number(), process.data(), process.size(), 0) == static_cast<ssize_t>(process.size());
  // On a full disk the lock is valid without the number.
  if (!written && !peclet::means_no_room(errno)) fail(directory.lock(), errno);
}

std::optional<fs::path> OwnerLock::folder() const {
  struct stat about {};
  if (fstat(folder_.number(), &about) != 0) fail_to("cannot examine", "the campaign's folder");
  if (about.st_nlink == 0) return std::nullopt;
  return fs::read_symlink(fmt::format("/proc/self/fd/{}", folder_.number()));
}

std::optional<std::int64_t> current_owner(const CampaignDirectory& directory) {
  const Descriptor folder = open_folder(directory);
  const Descriptor file = open_for_reading(directory.lock());
  // Shared locks, held for an instant: they fail while there is an owner.
  for (const int descriptor : {folder.number(), file.number()}) {
    if (descriptor < 0 || flock(descriptor, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK) continue;
    return owner_of(directory, folder.number());
  }
  return std::nullopt;
}

}  // namespace peclet::runner
