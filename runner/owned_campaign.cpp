#include "runner/owned_campaign.h"

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "runner/backup.h"
#include "runner/queue.h"
#include "runner/restore.h"
#include "runner/scene_check.h"
#include "runner/spool.h"

namespace peclet::runner {
namespace {

constexpr int exit_converged = 0;
constexpr int exit_unconverged = 3;
constexpr int exit_integrity = 6;

// Returns the folder itself. From its creation on things are written.
const CampaignDirectory& created(const CampaignDirectory& directory, bool force) {
  const std::optional<std::string> kind = network_file_system(directory.root());
  if (kind && !force) {
    throw InputError(
        directory.root().string(), "", *kind,
        "a campaign must be on a local file system, where locks and fsync can be trusted: choose another "
        "--directory, or --force it at your own risk");
  }
  std::filesystem::create_directories(directory.root());
  return directory;
}

// A sound database may be refused for another reason, and there a backup would not help.
std::string hint_if_damaged(const CampaignDirectory& directory) {
  try {
    examine(directory.database());
    return "";
  } catch (const IntegrityError&) {
    return restore_hint(directory);
  }
}

}  // namespace

ClaimedCampaign::ClaimedCampaign(const std::filesystem::path& file, const std::filesystem::path& chosen,
                                 bool force)
    : campaign(read_campaign(file)),
      command(resolve_engine(campaign, file)),
      engine(check_scenes(campaign, file, command).front().identity),
      directory(campaign_directory(file, chosen)),
      lock(created(directory, force)) {}

Database open_for_owner(const ClaimedCampaign& claimed) {
  const CampaignDirectory& directory = claimed.directory;
  create_folders(directory);
  for (const std::filesystem::path& folder : {directory.root(), directory.spool(), directory.checkpoints(),
                                              directory.failures(), directory.backup()}) {
    remove_unfinished_files(folder);
  }
  refuse_lost_database(directory);
  try {
    Database database = Database::open_owner(directory.database());
    Queue(database).adopt(claimed.campaign);
    return database;
  } catch (const IntegrityError& error) {
    throw IntegrityError(error.what() + hint_if_damaged(directory));
  }
}

OwnedCampaign::OwnedCampaign(const std::filesystem::path& file, const std::filesystem::path& chosen,
                             bool force)
    : ClaimedCampaign(file, chosen, force), database(open_for_owner(*this)) {}

int exit_code(Database& database, const Scheduler& scheduler, bool finished) {
  const std::vector<PointRecord> points = database.points();
  if (std::any_of(points.begin(), points.end(), [](const PointRecord& point) { return point.suspect; })) {
    return exit_integrity;
  }
  if (!finished) return exit_stopped;
  for (int place = 0; place < scheduler.points(); ++place) {
    const std::vector<Look>& looks = scheduler.looks(place);  // none of a point that was cancelled early
    if (looks.empty() || looks.back().verdict != Verdict::converged) return exit_unconverged;
  }
  return exit_converged;
}

}  // namespace peclet::runner
