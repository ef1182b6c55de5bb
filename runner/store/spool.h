// The spool: results that an engine has made durable and that the owner has not committed yet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runner/store/campaign_directory.h"
#include "runner/store/realisation_result.h"

namespace peclet::runner {

// Reads one spool file; `sha256` is what the engine says about its bytes ("" when nobody is left to say it).
// Throws ResultError when it is absent, differs, is too large or is no result.
RealisationResult read_spool_file(const std::filesystem::path& path, const std::string& sha256);

// Whether the file bears the name of another point's or seed's result. Files with names of other forms are
// accepted.
bool belongs_to_another(const std::filesystem::path& path, const RealisationResult& result);

// The folder whose spool the file lies in: the campaign's own, or one that is shared with a batch system.
CampaignDirectory home_of_spool_file(const std::filesystem::path& path);

// Complete spool files, by name.
std::vector<std::filesystem::path> spool_files(const CampaignDirectory& directory);

// Whether anything bears that name, be it no file or a link that leads nowhere.
bool is_there(const std::filesystem::path& path);
// The files in a folder that are regular ones, not links to some, and no temporary ones; by name.
std::vector<std::filesystem::path> whole_files(const std::filesystem::path& folder);
// A checkpoint may be large; what is larger than this is none, and is not copied into a backup or out of it.
constexpr std::uint64_t largest_copied_file = std::uint64_t{16} << 30;

// Moves a file to spool/rejected/, with what its realisation left, under names that are free there, and says
// where it is now.
std::filesystem::path reject(const CampaignDirectory& directory, const std::filesystem::path& path);

// The unfinished temporary files in `folder` whose writers no longer run.
std::vector<std::filesystem::path> unfinished_files(const std::filesystem::path& folder);
// Removes the unfinished temporary files in `folder` whose writers no longer run.
void remove_unfinished_files(const std::filesystem::path& folder);

}  // namespace peclet::runner
