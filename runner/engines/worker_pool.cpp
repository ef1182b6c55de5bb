#include "runner/engines/worker_pool.h"

#include "runner/store/disk_room.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

namespace fs = std::filesystem;

std::array<fs::path, 4> folders_of(const Job& job) {
  return {job.spool.parent_path(), left_folder(job.spool), job.checkpoint.parent_path(), job.failures};
}

std::optional<fs::path> unwritable_folder(const Job& job) {
  for (const fs::path& folder : folders_of(job)) {
    if (!fs::exists(folder) || !has_room(folder, 0)) return folder;
  }
  return std::nullopt;
}

}  // namespace peclet::runner
