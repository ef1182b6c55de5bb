// Copies of the files that realisations left, in a folder of backups: files/HASH, by the SHA-256 of the
// bytes.
//
// A copy is there once and stays, whatever generations of the database refer to it; so an unchanged file is
// not copied again. On one file system it is another name of the same bytes, which nobody changes.
#pragma once

#include <filesystem>
#include <vector>

#include "runner/store/campaign_directory.h"
#include "runner/store/file_store.h"

namespace peclet::runner {

struct FileCopies {
  int there = 0;    // that were copied, or already there
  int lacking = 0;  // that are absent or damaged where they should come from
};

// Copies what is kept of these into a folder of backups. Throws NoRoomError, std::system_error,
// UnsuitableFile.
FileCopies copy_files_of(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                         const std::filesystem::path& backups);

// Whether a file lies in its place and is what its row says.
bool is_sound(const FileRecord& record, const CampaignDirectory& directory);
bool has_copy(const FileRecord& record, const std::filesystem::path& backups);

// Brings what is kept of these, and not sound, back into its place.
FileCopies bring_files_back(const std::vector<FileRecord>& records, const CampaignDirectory& directory,
                            const std::filesystem::path& backups);

}  // namespace peclet::runner
