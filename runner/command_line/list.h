// The verb `peclet list`: one line for each campaign below a folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/reports/status.h"

namespace peclet::runner {

struct ListedCampaign {
  std::string name;                      // path of its file or folder, from the folder that was searched
  std::optional<CampaignStatus> status;  // none if it cannot be read
  std::string fault{};                   // the reason
};

// Returns the campaigns that have been run in `folder` and the folders below it, sorted by name; `folder`
// alone if it is a campaign's. Links are
// not followed, and folders that may not be read are left out. Throws InputError if `folder` cannot be read.
std::vector<ListedCampaign> campaigns_below(const std::filesystem::path& folder);

// Returns "running", "stopped", "handed-over" (a batch system has seeds), "converged" (or complete), "ended"
// (a point is capped, failed, cancelled or has lost seeds), "suspect" or "unreadable".
std::string state_of(const ListedCampaign& campaign);

std::string list_table(const std::vector<ListedCampaign>& campaigns);
// Returns the array that schema/README.md describes (List).
Json list_json(const std::vector<ListedCampaign>& campaigns);

}  // namespace peclet::runner
