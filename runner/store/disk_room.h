// Room on the file systems of a campaign: whether something fits, and why it does not.
#pragma once

#include <cstdint>
#include <string>

#include "runner/campaign/paths.h"

namespace peclet::runner {

// Returns why `bytes` cannot be written in `folder` now, ENOSPC or EDQUOT; 0 if they can be, or if that
// cannot be tried for another reason. It is tried, not asked for: quotas do not show in statvfs.
int lack_of_room(const fs::path& folder, std::uint64_t bytes);
inline bool has_room(const fs::path& folder, std::uint64_t bytes) { return lack_of_room(folder, bytes) == 0; }

// Says what is used up, for which `error` is ENOSPC or EDQUOT: the quota, the inodes or the bytes.
// "/data/friction.peclet/spool is full: 0.0 MB are free there, 1.1 MB are needed"
std::string shortage_text(const fs::path& folder, std::uint64_t bytes, int error);

// Why waiting for `bytes` in `folder` is in vain: its file system, without all that is not of the campaign in
// `root`, would still be too small. "" where somebody could make room, and where quotas hide the truth.
std::string why_in_vain(const fs::path& root, const fs::path& folder, std::uint64_t bytes);

}  // namespace peclet::runner
