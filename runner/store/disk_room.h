// Checks whether something fits on the file systems of a campaign, and says why not.
#pragma once

#include <cstdint>
#include <string>

#include "runner/campaign/paths.h"

namespace peclet::runner {

// Returns ENOSPC or EDQUOT if `bytes` (1 MB to 64 MB are tried) cannot be written in `folder` now; 0 if they
// can, or if another error prevents the trial. The room is really taken for a moment, because statvfs() does
// not show quotas.
int lack_of_room(const fs::path& folder, std::uint64_t bytes);
inline bool has_room(const fs::path& folder, std::uint64_t bytes) { return lack_of_room(folder, bytes) == 0; }

// Returns what is used up: the quota, the inodes or the bytes. `error` is ENOSPC or EDQUOT.
// "/data/friction.peclet/spool is full: 0.0 MB are free there, 1.1 MB are needed"
std::string shortage_text(const fs::path& folder, std::uint64_t bytes, int error);

// Returns why waiting for `bytes` in `folder` cannot help: its file system would be too small even with only
// the campaign in `root` on it. "" if room can be made; quotas are not considered.
std::string why_in_vain(const fs::path& root, const fs::path& folder, std::uint64_t bytes);

}  // namespace peclet::runner
