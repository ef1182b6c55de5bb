#include "runner/owner/owned_campaign.h"

#include <fmt/format.h>

#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/backups.h"
#include "runner/store/point_store.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_files.h"
#include "runner/store/vocabulary.h"

namespace peclet::runner {
namespace {

constexpr std::size_t fewest_digits = 6;  // of a hash that names an engine

CampaignDirectory directory_for(const Campaign& campaign, const std::filesystem::path& file,
                                const std::filesystem::path& chosen) {
  if (chosen.empty() && !std::filesystem::is_regular_file(file)) {
    throw InputError(file.string(), "", "",
                     "is no file beside which the campaign could be kept: name its folder with --directory");
  }
  CampaignDirectory directory = campaign_directory(file, chosen);
  if (chosen.empty()) refuse_renamed_file(campaign, file, directory);
  return directory;
}

// Returns the engine itself, when `name` is one of its names or empty.
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

// Returns the folder itself. From its creation on things are written.
const CampaignDirectory& created(const CampaignDirectory& directory, bool force) {
  const std::optional<std::string> kind = network_file_system(directory.root());
  if (kind && !force) {
    throw InputError(
        directory.root().string(), "", *kind,
        "a campaign must be on a local file system, where locks and fsync can be trusted: choose another "
        "--directory, or --force it at your own risk");
  }
  std::error_code error;
  std::filesystem::create_directories(directory.root(), error);
  if (error) {
    throw InputError(
        directory.root().string(), "", "",
        fmt::format("cannot be made: {}; choose another place with --directory", error.message()));
  }
  return directory;
}

// A database that knows of fewer attempts than its backup is an older copy.
void refuse_older_copy(const CampaignDirectory& directory, Database& database) {
  const std::filesystem::path backup = newest_backup(directory.backup());
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

// What the campaign's owner should hear once a changed sweep has been taken up.
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

}  // namespace

ClaimedCampaign::ClaimedCampaign(const std::filesystem::path& file, const std::filesystem::path& chosen,
                                 bool force, const std::string& accepted_engine)
    : campaign(read_campaign(file)),
      command(resolve_engine(campaign, file)),
      scenes(check_scenes(campaign, file, command)),
      engine(accepted(scenes.front().identity, accepted_engine)),
      directory(directory_for(campaign, file, chosen)),
      lock(created(directory, force)) {}

Database open_for_owner(const ClaimedCampaign& claimed, const std::function<void(const std::string&)>& tell) {
  const CampaignDirectory& directory = claimed.directory;
  create_folders(directory);
  for (const std::filesystem::path& folder :
       {directory.root(), directory.spool(), directory.left(), directory.checkpoints(), directory.failures(),
        directory.backup(), directory.requests()}) {
    remove_unfinished_files(folder);
  }
  refuse_lost_database(directory);
  try {
    Database database = Database::open_owner(directory.database());
    refuse_older_copy(directory, database);
    PointStore(database).adopt(claimed.campaign);
    keep_vocabulary(database, *claimed.scenes.front().words);
    tell_of_points_left_behind(database, tell);
    return database;
  } catch (const IntegrityError& error) {
    throw IntegrityError(error.what() + hint_if_damaged(directory));
  }
}

OwnedCampaign::OwnedCampaign(const std::filesystem::path& file, const std::filesystem::path& chosen,
                             bool force, const std::string& accepted_engine)
    : ClaimedCampaign(file, chosen, force, accepted_engine), database(open_for_owner(*this)) {}

void accept_engine(Ledger& ledger, const Json& engine, RunListener& listener) {
  if (ledger.accept_engine(engine_identity(engine)) == 0) {
    listener.note(
        "no point that is still to be run has results of another engine: there was nothing to accept");
  }
}

std::string acceptance_hint(const std::string& verb_and_file, const Json& engine) {
  return fmt::format(
      ". Run with the engine it was begun with, or accept this one with `peclet {} --accept-engine {}`: what "
      "points that are still to be run have is then kept apart, and they begin again",
      verb_and_file, engine.at("binary_sha256").get<std::string>().substr(0, 12));
}

}  // namespace peclet::runner
