// Finding the campaign file that a person means.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

// The campaign file beside a campaign's folder, as it is spelt from here; a file is itself.
std::filesystem::path campaign_file_of(const std::filesystem::path& given);

// Throws InputError when there is no such file, or a folder, and says which file may have been meant.
void require_campaign_file(const std::filesystem::path& given);

// "; did you mean FILE?" for a name like that of a campaign file or folder beside it, or nothing.
std::string similar_name(const std::filesystem::path& given);

}  // namespace peclet::runner
