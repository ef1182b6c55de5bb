#include "runner/care/file_copies.h"

#include <system_error>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

fs::path copy_of(const FileRecord& record, const fs::path& backups) {
  return CampaignDirectory(backups).files() / record.file.sha256;
}

bool is_what_it_was(const fs::path& path, const FileRecord& record) {
  return fault_of_file(path, record.file.bytes, record.file.sha256).empty();
}

void link_or_copy(const fs::path& place, const fs::path& copy) {
  const fs::path next = copy.string() + ".next";
  fs::remove(next);
  std::error_code no_link;
  fs::create_hard_link(place, next, no_link);
  if (no_link) return copy_regular(place, copy, largest_left_file);
  rename_durably(next, copy);
}

}  // namespace

FileCopies copy_files_of(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                         const fs::path& backups) {
  FileCopies copies;
  require_own_folder(CampaignDirectory(backups).files());
  for (const FileRecord& record : records) {
    if (!record.kept) continue;
    const fs::path target = copy_of(record, backups), place = record.place(directory);
    // Only whole files get such a name.
    const bool is_there = kind_of(target) == "a regular file" && fs::file_size(target) == record.file.bytes;
    if (!is_there && !is_what_it_was(place, record)) {
      ++copies.lacking;
      continue;
    }
    ++copies.there;
    if (is_there) continue;
    create_folders_durably(target.parent_path());
    link_or_copy(place, target);
  }
  return copies;
}

bool is_sound(const FileRecord& record, const CampaignDirectory& directory) {
  return is_what_it_was(record.place(directory), record);
}

bool has_copy(const FileRecord& record, const fs::path& backups) {
  return is_what_it_was(copy_of(record, backups), record);
}

FileCopies bring_files_back(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                            const fs::path& backups) {
  FileCopies copies;
  for (const FileRecord& record : records) {
    if (!record.kept || is_sound(record, directory)) continue;
    if (!has_copy(record, backups)) {
      ++copies.lacking;
      continue;
    }
    const fs::path place = record.place(directory);
    create_folders_durably(place.parent_path());
    copy_regular(copy_of(record, backups), place, largest_left_file);
    ++copies.there;
  }
  return copies;
}

}  // namespace peclet::runner
