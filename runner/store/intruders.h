// What lies in the folders of a campaign and is no file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// Moves links, folders, FIFOs, sockets and devices out of the folders in which a run and its engines read,
// replace and remove files, into aside/: whatever they are, nothing waits for them or is stopped by them
// then. `tell` hears one sentence for each folder that had some. For the campaign's owner. Throws
// std::system_error.
void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell);

// Moves what has the name of a file or folder of ours, and is not of the `wanted` kind (as kind_of() says),
// out of the way: to PATH@aside, a name that no file of ours has. Returns a sentence about it; "" if nothing
// was in the way. Throws std::system_error.
std::string make_way(const std::filesystem::path& path, const std::string& wanted);

}  // namespace peclet::runner
