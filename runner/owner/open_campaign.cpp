#include "runner/owner/open_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/store/backups.h"
#include "runner/store/disk_room.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

// Returns the campaign folders beside `directory` whose campaign file is gone.
std::vector<fs::path> orphans_beside(const CampaignDirectory& directory) {
  std::vector<fs::path> orphans;
  const fs::path parent = directory.root().parent_path();
  if (!fs::is_directory(parent)) return orphans;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent)) {
    const bool is_campaign =
        entry.path().extension() == ".peclet" && fs::exists(CampaignDirectory(entry.path()).database());
    fs::path file = entry.path();
    if (is_campaign && !fs::exists(file.replace_extension(".json"))) orphans.push_back(entry.path());
  }
  std::sort(orphans.begin(), orphans.end());
  return orphans;
}

// Returns the number of results of the campaign's points in another folder; 0 if its database cannot be read.
int results_of(const Campaign& campaign, const fs::path& folder) {
  std::set<std::string> hashes;
  for (const StatePoint& point : campaign.points) hashes.insert(point.hash);
  try {
    Database database = Database::open_reader(CampaignDirectory(folder).database());
    int results = 0;
    for (const auto& points : {database.points(), database.inactive_points()}) {
      for (const PointRecord& point : points) {
        if (!hashes.contains(point.hash)) continue;
        const StateCounts counts = database.counts(point.id);
        results += counts.done + counts.failed;
      }
    }
    return results;
  } catch (const std::system_error&) {
    throw;  // the machine failed, which says nothing of the folder
  } catch (const std::runtime_error&) {
    return 0;
  }
}

bool has_been_run(const CampaignDirectory& directory) {
  return !kind_of(directory.database()).empty() || !restore_hint(directory).empty();
}

// Throws BeingSetUp with the reason if the setup has stopped: its run has ended, or the disk is full.
void refuse_unfinished_beginning(const CampaignDirectory& directory) {
  const std::string database = directory.database().string();
  if (!current_owner(directory)) {
    throw BeingSetUp(
        database,
        "the campaign was never set up: the run that began it has ended, perhaps for want of room; "
        "`peclet run` begins it again");
  }
  if (const int error = lack_of_room(directory.root(), 0); error != 0) {
    throw BeingSetUp(database,
                     shortage_text(directory.root(), 0, error) + "; the campaign begins when there is room");
  }
}

}  // namespace

void refuse_renamed_file(const Campaign& campaign, const fs::path& file, const CampaignDirectory& directory) {
  if (fs::exists(directory.root())) return;
  for (const fs::path& orphan : orphans_beside(directory)) {
    const int results = results_of(campaign, orphan);
    if (results == 0) continue;
    const fs::path own = file.parent_path() / directory.root().filename();
    const fs::path other = file.parent_path() / orphan.filename();
    throw InputError(
        file.string(), "", "",
        fmt::format("has not been run under this name, but {4} has {1} results of its points and no campaign "
                    "file: was it renamed? Continue with them: `mv {0} {2} && peclet run {3}`; or start "
                    "afresh: `peclet run {3} --directory {2}`",
                    shell_word(other.string()), results, shell_word(own.string()), shell_word(file.string()),
                    other.string()));
  }
}

bool awaits_its_first_run(const fs::path& given, const fs::path& chosen) {
  return fs::is_regular_file(given) && !has_been_run(campaign_directory(given, chosen));
}

Campaign read_new_campaign(const fs::path& given, const fs::path& chosen) {
  Campaign campaign = read_campaign(given);
  if (chosen.empty()) refuse_renamed_file(campaign, given, campaign_directory(given, chosen));
  return campaign;
}

CampaignDirectory find_campaign(const fs::path& given, const fs::path& chosen) {
  const bool is_folder = fs::is_directory(given);
  CampaignDirectory directory = is_folder ? CampaignDirectory(fs::absolute(given).lexically_normal())
                                          : campaign_directory(given, chosen);
  if (has_been_run(directory)) return directory;
  if (is_folder) {
    throw InputError(given.string(), "", "",
                     "no campaign has been run in this folder; give the campaign file or its .peclet folder");
  }
  if (!fs::exists(given))
    throw InputError(given.string(), "", "", "no such file or folder" + similar_name(given));
  read_new_campaign(given, chosen);
  throw InputError(
      given.string(), "", "",
      fmt::format("has not been run yet (there is no {}); start it with `peclet run {}`, or name its folder "
                  "with --directory if that is elsewhere",
                  directory.database().string(), words_for(given, chosen)));
}

OpenCampaign open_campaign(const fs::path& given, const fs::path& chosen) {
  CampaignDirectory directory = find_campaign(given, chosen);
  refuse_lost_database(directory);
  try {
    Database database = Database::open_reader(directory.database());
    return {std::move(directory), std::move(database)};
  } catch (const IntegrityError& error) {
    throw IntegrityError(error.what() + hint_if_damaged(directory));
  } catch (const BeingSetUp&) {
    refuse_unfinished_beginning(directory);
    throw;
  }
}

std::string difference_from_file(const fs::path& given, const fs::path& chosen,
                                 const CampaignRecord& campaign) {
  if (!fs::is_regular_file(given)) return "";
  try {
    if (keeping_chosen_values(read_campaign(given).document, campaign.document) == campaign.document)
      return "";
    return fmt::format(
        "{0} has changed since it was last run; `peclet set {1}` or `peclet run {1}` takes it over",
        given.string(), words_for(given, chosen));
  } catch (const InputError& error) {
    return fmt::format("the campaign file has changed since it was last run and has a fault: {}",
                       error.what());
  }
}

}  // namespace peclet::runner
