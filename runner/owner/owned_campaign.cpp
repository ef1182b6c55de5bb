#include "runner/owner/owned_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/backups.h"
#include "runner/store/point_store.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

namespace {

constexpr std::size_t fewest_digits = 6;  // digits of a hash that names an engine

CampaignDirectory directory_for(const Campaign& campaign, const fs::path& file, const fs::path& chosen) {
  if (chosen.empty() && !fs::is_regular_file(file)) {
    throw InputError(
        file.string(), "", "",
        "is not a regular file, so the campaign has no place beside it: name its folder with --directory");
  }
  CampaignDirectory directory = campaign_directory(file, chosen);
  if (chosen.empty()) refuse_renamed_file(campaign, file, directory);
  return directory;
}

// Returns the engine if `name` is empty or one of its names; otherwise throws InputError.
const Json& accepted(const Json& engine, const std::string& name) {
  const std::string version = engine.at("version"), hash = engine.at("binary_sha256");
  const bool is_name =
      name.empty() || name == version || (name.size() >= fewest_digits && hash.starts_with(name));
  if (is_name) return engine;
  throw InputError("", "--accept-engine", name,
                   fmt::format("must be the version, or {} or more digits of the hash, of the engine that is "
                               "there now: {}",
                               fewest_digits, engine_identity(engine)));
}

// Creates the folder and returns it. Throws InputError for a network file system unless `force` is set.
const CampaignDirectory& created(const CampaignDirectory& directory, bool force) {
  const std::optional<std::string> kind = network_file_system(directory.root());
  if (kind && !force) {
    throw InputError(
        directory.root().string(), "", *kind,
        "a campaign must be on a local file system, where locks and fsync can be trusted: choose another "
        "--directory, or --force it at your own risk");
  }
  std::error_code error;
  fs::create_directories(directory.root(), error);
  if (error) {
    throw InputError(
        directory.root().string(), "", "",
        fmt::format("cannot be made: {}; choose another place with --directory", error.message()));
  }
  return directory;
}

// Throws IntegrityError if the database has fewer attempts than its backup: then it is an older copy.
void refuse_older_copy(const CampaignDirectory& directory, Database& database) {
  const fs::path backup = newest_backup(directory.backup());
  if (kind_of(backup).empty()) return;
  Connection saved(backup.string(), Connection::Access::read_only, 10'000);
  const Extent here = extent_of(database.connection());
  Extent there;
  try {
    there = extent_of(saved);
  } catch (const IntegrityError&) {  // a damaged backup is for `peclet doctor` to find
    return;
  }
  if (here.attempts >= there.attempts) return;
  throw IntegrityError(fmt::format(
      "{}: is older than its own backup: {} results of {} attempts, and {} of {} in {}; has an old copy "
      "taken its place? Put the newer one back with `peclet restore {} {}`, or keep what is here with "
      "`peclet backup "
      "{}`; then run again",
      directory.database().string(), here.results, here.attempts, there.results, there.attempts,
      backup.string(), shell_word(directory.backup().string()), shell_word(directory.root().string()),
      shell_word(directory.root().string())));
}

// Tells the owner of results at points that a changed sweep has left out.
void tell_of_points_left_behind(Database& database, const std::function<void(const std::string&)>& tell) {
  const std::vector<PointRecord> left = database.inactive_points();
  int results = 0;
  for (const PointRecord& point : left) results += database.counts(point.id).terminal();
  if (results == 0) return;
  tell(fmt::format(
      "{} seeds that ended at {} points of earlier versions of the campaign are kept, and count again "
      "when the sweep contains these points",
      results, left.size()));
}

constexpr std::chrono::seconds interval{1};

}  // namespace

ClaimedCampaign::ClaimedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                                 const std::string& accepted_engine)
    : campaign(read_campaign(file)),
      command(resolve_engine(campaign, file)),
      scenes(check_scenes(campaign, file, command)),
      engine(accepted(scenes.front().identity, accepted_engine)),
      directory(directory_for(campaign, file, chosen)),
      lock(created(directory, force)) {}

Database open_for_owner(const ClaimedCampaign& claimed, const std::function<void(const std::string&)>& tell) {
  const CampaignDirectory& directory = claimed.directory;
  create_folders(directory);
  remove_unfinished_files(directory.root());
  for (const fs::path& folder : folders_below(directory)) remove_unfinished_files(folder);
  refuse_lost_database(directory);
  try {
    Database database = Database::open_owner(directory.database());
    refuse_older_copy(directory, database);
    PointStore points(database);
    points.adopt(points.with_chosen_values(claimed.campaign));
    keep_vocabulary(database, *claimed.scenes.front().words);
    tell_of_points_left_behind(database, tell);
    return database;
  } catch (const IntegrityError& error) {
    throw IntegrityError(error.what() + hint_if_damaged(directory));
  }
}

OwnedCampaign::OwnedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                             const std::string& accepted_engine)
    : ClaimedCampaign(file, chosen, force, accepted_engine), database(open_for_owner(*this)) {
  campaign = adopted_campaign(database);
}

Campaign adopted_campaign(Database& database) {
  return parse_campaign(database.campaign().document, database.connection().path());
}

void accept_engine(CampaignState& state, const Json& engine, RunListener& listener) {
  if (state.accept_engine(engine_identity(engine)) == 0) {
    listener.note(
        "no point that is still to be run has results of another engine: there was nothing to accept");
  }
}

std::string acceptance_hint(const std::string& verb_and_file, const Json& engine) {
  return fmt::format(
      ". Run with the engine it was begun with, or accept this one with `peclet {} --accept-engine {}`: the "
      "results of points that are still to be run are then set aside, and these points begin again",
      verb_and_file, engine.at("binary_sha256").get<std::string>().substr(0, 12));
}

FolderWatch::FolderWatch(const CampaignDirectory& directory, const OwnerLock& lock, Database& database,
                         RunListener& listener)
    : directory_(directory), lock_(lock), database_(database), listener_(listener) {}

bool FolderWatch::attend(Time now) {
  if (now - last_ < interval) return false;
  last_ = now;
  refuse_move();
  refuse_deletion();
  require_own_folders(directory_);
  return mend_folders();
}

void FolderWatch::refuse_move() const {
  const std::optional<fs::path> folder = lock_.folder();
  std::error_code absent;
  if (!folder || fs::equivalent(*folder, directory_.root(), absent)) return;
  throw IntegrityError(
      fmt::format("{}: was moved to {} while the campaign ran, which stops here; everything that was "
                  "committed is there: move it back and run again, or go on there with --directory {}",
                  directory_.root().string(), folder->string(), shell_word(folder->string())));
}

void FolderWatch::refuse_deletion() const {
  if (lock_.folder() && fs::exists(directory_.database())) return;
  const fs::path saved = free_name(directory_.root().string() + ".saved.db");
  copy_database(database_.connection(), saved);
  throw IntegrityError(fmt::format(
      "{}: was deleted while the campaign ran, which stops here; all {} results in it were saved in {}: put "
      "them back with `peclet restore {} {}`",
      directory_.database().string(), extent_of(database_.connection()).results, saved.string(),
      shell_word(saved.string()), shell_word(directory_.root().string())));
}

bool FolderWatch::mend_folders() const {
  std::vector<std::string> gone;
  for (const fs::path& folder : folders_below(directory_)) {
    // A folder that went with the one above it is not named.
    if (kind_of(folder).empty() && !kind_of(folder.parent_path()).empty())
      gone.push_back(folder.lexically_relative(directory_.root()).string() + "/");
  }
  if (gone.empty()) return false;
  try {
    create_folders(directory_);
  } catch (const fs::filesystem_error& error) {
    if (!means_machine_fault(error.code().value())) throw;
    return false;  // checked again in a second
  }
  listener_.warn(
      fmt::format("{}: these folders were deleted while the campaign runs and are made anew: {}; the "
                  "database keeps what it has, and a seed whose checkpoint or unbooked result was there runs "
                  "again",
                  directory_.root().string(), fmt::join(gone, ", ")));
  return true;
}

}  // namespace peclet::runner
