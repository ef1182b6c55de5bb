// Who may write a campaign.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "runner/folder/campaign_directory.h"

namespace peclet::runner {

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
  ~OwnerLock();
  OwnerLock(const OwnerLock&) = delete;
  OwnerLock& operator=(const OwnerLock&) = delete;

  // Where the folder is now: another place when it was moved; nothing when it was deleted.
  std::optional<std::filesystem::path> folder() const;

 private:
  int folder_ = -1, file_ = -1;
};

// The process that owns the campaign now, without waiting for it or disturbing it; nothing when nobody does.
// The number is 0 while the owner has not written it yet.
std::optional<std::int64_t> current_owner(const CampaignDirectory& directory);

}  // namespace peclet::runner
