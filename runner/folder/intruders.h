// What lies in the folders of a campaign and is no file.
#pragma once

#include <functional>
#include <string>

#include "runner/folder/campaign_directory.h"

namespace peclet::runner {

// Moves links, folders, FIFOs, sockets and devices out of the folders in which a run and its engines read,
// replace and remove files, into aside/: whatever they are, nothing waits for them or is stopped by them
// then. `tell` hears one sentence for each folder that had some. For the campaign's owner. Throws
// std::system_error.
void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell);

}  // namespace peclet::runner
