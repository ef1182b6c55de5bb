// Locks: who may write a campaign, one process at a time at the files of a folder, and who holds a lock.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "contract/durable_file.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// What this machine calls itself; "unknown" where it has no name.
std::string host_name();

// Returns the process that holds a write lock of this kind ("FLOCK", "POSIX") on the file with this inode, on
// the byte `at`; 0 if the list names none. Nothing is opened: closing a file takes a process's own locks
// away.
std::int64_t process_that_locks(std::uint64_t inode, const std::string& kind, std::uint64_t at = 0);

// A lock on a folder, or on a file that its holder may replace by another of its name. Held from
// construction, which waits for it, to destruction or to the end of the process. Leaves no file.
class FileLock {
 public:
  // Throws std::system_error naming the path.
  explicit FileLock(const fs::path& path);

 private:
  Descriptor file_;
};

// Another process owns the campaign. Exit code 5.
class OwnedByAnother : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The right to write a campaign, held from construction to destruction or to the end of the process. It is a
// lock on the folder itself, which cannot be deleted and made anew beneath its owner unnoticed as a file can,
// and on campaign.lock, which says who holds it.
class OwnerLock {
 public:
  // Requires the folder to exist. Throws OwnedByAnother naming the owner's process, UnsuitableFile as
  // require_own_folders() or when the lock is no regular file, std::system_error.
  explicit OwnerLock(const CampaignDirectory& directory);

  // Where the folder is now: another place when it was moved; nothing when it was deleted.
  std::optional<fs::path> folder() const;

 private:
  Descriptor folder_, file_;
};

// The process that owns the campaign now, without waiting for it or disturbing it; nothing when nobody does.
// The number is 0 while the owner has not written it yet.
std::optional<std::int64_t> current_owner(const CampaignDirectory& directory);

}  // namespace peclet::runner
