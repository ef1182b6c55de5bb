#include "runner/owner/renamed_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "contract/input_error.h"
#include "contract/integrity_error.h"
#include "runner/store/database.h"
#include "runner/text/quoting.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Folders of campaigns whose file has gone.
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

// Results of the campaign's points in another folder. One that cannot be read is no reason to refuse this
// one.
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
  } catch (const InputError&) {
    return 0;
  } catch (const IntegrityError&) {
    return 0;
  } catch (const DatabaseError&) {
    return 0;
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
        fmt::format("has not been run under this name, but {4} has {1} results of its points and no file any "
                    "more: was it renamed? Go on with them: `mv {0} {2} && peclet run {3}`; or start "
                    "afresh: `peclet run {3} --directory {2}`",
                    shell_word(other.string()), results, shell_word(own.string()), shell_word(file.string()),
                    other.string()));
  }
}

}  // namespace peclet::runner
