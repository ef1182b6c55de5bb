#include "runner/command_line/list.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/number_text.h"
#include "runner/command_line/print.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

bool is_campaign(const fs::path& folder) {
  std::error_code unreadable;
  const CampaignDirectory directory(folder);
  return fs::exists(directory.database(), unreadable) || fs::is_directory(directory.backup(), unreadable);
}

ListedCampaign listed(const fs::path& folder, const fs::path& searched) {
  const fs::path file = fs::path(folder).replace_extension(".json");
  std::error_code unreadable;
  const bool has_file = folder.extension() == ".peclet" && fs::is_regular_file(file, unreadable);
  const fs::path shown =
      folder == searched ? folder : (has_file ? file : folder).lexically_proximate(searched);
  ListedCampaign campaign{printable(shown.string()), {}};
  try {
    OpenCampaign open = open_campaign(folder, "");
    campaign.status = read_status(open.database, current_owner(open.directory));
  } catch (const std::exception& error) {
    campaign.fault = message_of(error);
  }
  return campaign;
}

}  // namespace

std::vector<ListedCampaign> campaigns_below(const fs::path& folder) {
  std::error_code fault;
  const fs::directory_iterator first(folder, fault);  // the recursive one passes over a folder closed to us
  if (fault) throw InputError(folder.string(), "", "", fault.message());
  if (is_campaign(folder)) return {listed(folder, folder)};
  std::vector<fs::path> found;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, fault);
  for (const fs::recursive_directory_iterator end; entry != end; entry.increment(fault)) {
    std::error_code unreadable;  // such an entry is no campaign
    if (entry->is_symlink(unreadable) || !entry->is_directory(unreadable) || !is_campaign(entry->path()))
      continue;
    found.push_back(entry->path());
    entry.disable_recursion_pending();
  }
  if (fault) throw InputError(folder.string(), "", "", "cannot be searched: " + fault.message());
  std::sort(found.begin(), found.end());
  std::vector<ListedCampaign> campaigns;
  campaigns.reserve(found.size());
  for (const fs::path& path : found) campaigns.push_back(listed(path, folder));
  return campaigns;
}

std::string state_of(const ListedCampaign& campaign) {
  if (!campaign.status) return "unreadable";
  const int code = exit_code_of(*campaign.status);
  if (code == ExitCode::integrity) return "suspect";
  if (campaign.status->owner) return "running";
  if (code == ExitCode::done) return "converged";
  if (code == ExitCode::unconverged) return "ended";
  return campaign.status->handed_over.empty() ? "stopped" : "handed-over";
}

std::string list_table(const std::vector<ListedCampaign>& campaigns) {
  TextTable table;
  table.add_column("campaign", TextTable::Align::left);
  for (const char* const title : {"decided", "seeds", "processor time"}) table.add_column(title);
  for (const char* const title : {"state", "to go"}) table.add_column(title, TextTable::Align::left);
  for (const ListedCampaign& campaign : campaigns) {
    if (!campaign.status) {
      table.add_row({campaign.name, "-", "-", "-", state_of(campaign), campaign.fault});
      continue;
    }
    const CampaignTotals totals = totals_of(*campaign.status);
    const auto& to_go = campaign.status->to_go;
    table.add_row({campaign.name, fmt::format("{}/{}", totals.decided, campaign.status->points.size()),
                   fmt::format("{}", totals.ended), duration_text(totals.cpu_seconds), state_of(campaign),
                   to_go ? to_string(*to_go) : ""});
  }
  return campaigns.empty() ? "no campaigns\n" : table.text();
}

Json list_json(const std::vector<ListedCampaign>& campaigns) {
  Json list = Json::array();
  for (const ListedCampaign& campaign : campaigns) {
    Json line{{"campaign", campaign.name}, {"state", state_of(campaign)}};
    for (const char* const unknown :
         {"points", "decided", "seeds", "cpu_seconds", "seconds_to_go", "process", "fault"})
      line[unknown] = nullptr;
    if (const auto& status = campaign.status) {
      const CampaignTotals totals = totals_of(*status);
      line["points"] = status->points.size();
      line["decided"] = totals.decided;
      line["seeds"] = totals.ended;
      line["cpu_seconds"] = totals.cpu_seconds;
      line["seconds_to_go"] = to_json(status->to_go);
      if (status->owner) line["process"] = *status->owner;
    } else {
      line["fault"] = campaign.fault;
    }
    list.push_back(std::move(line));
  }
  return list;
}

}  // namespace peclet::runner
