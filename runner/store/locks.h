// Locks that one process at a time may hold: OwnerLock to write a campaign, FileLock to write the files of a
// folder.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "contract/durable_file.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// Returns this machine's name; "unknown" if it has no name.
std::string host_name();

// Returns the process that holds a write lock of this kind ("FLOCK", "POSIX") on byte `at` of the file with
// this inode; 0 if the kernel's list does not name it. No file is opened, because closing one would release
// this process's own locks.
std::int64_t process_that_locks(std::uint64_t inode, const std::string& kind, std::uint64_t at = 0);

// FileLock is a lock on a folder, or on a file that its holder may replace by another of its name. It is held
// from construction, which waits for it, to destruction or to the end of the process. It leaves no file.
class FileLock {
 public:
  // Throws std::system_error naming the path.
  explicit FileLock(const fs::path& path);

 private:
  Descriptor file_;
};

// Thrown if another process owns the campaign. Exit code 5.
class OwnedByAnother : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// OwnerLock is the right to write a campaign, held from construction to destruction or to the end of the
// process. It locks the folder itself, which cannot be replaced unnoticed as a file can, and campaign.lock,
// which names the holder.
class OwnerLock {
 public:
  // Requires the folder to exist. Throws OwnedByAnother naming the owner's process, UnsuitableFile as
  // require_own_folders() or if campaign.lock is not a regular file, std::system_error.
  explicit OwnerLock(const CampaignDirectory& directory);

  // Returns the present path of the folder, which changes if it is moved; nothing if it was deleted.
  std::optional<fs::path> folder() const;

 private:
  Descriptor folder_, file_;
};

// Returns the process that owns the campaign, without waiting for it or disturbing it; nothing if no process
// does. The number is 0 until the owner has written it.
std::optional<std::int64_t> current_owner(const CampaignDirectory& directory);

}  // namespace peclet::runner
