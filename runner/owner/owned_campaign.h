// OwnedCampaign is a campaign that this process may write.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "runner/campaign/paths.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/scene_check.h"
#include "runner/owner/campaign_state.h"
#include "runner/owner/run_listener.h"
#include "runner/statistics/scheduler.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"
#include "runner/store/locks.h"

namespace peclet::runner {

// Failures of a seed that are allowed beyond the first.
constexpr int retries = 2;

// A campaign that is checked and locked: no other process may write it.
struct ClaimedCampaign {
  Campaign campaign;
  EngineCommand command;
  std::vector<SceneAnswer> scenes;  // the engine's answers about its points
  Json engine;                      // provenance of the engine here
  CampaignDirectory directory;
  OwnerLock lock;

  // Checks the campaign file and its scenes, makes the folder and takes the lock. `chosen` is as in
  // campaign_directory(); `force` allows a network file system. `accepted_engine` is "" or a name of the
  // engine here: its version, or 6 or more leading digits of its binary's hash. Throws InputError before
  // anything is written, OwnedByAnother.
  ClaimedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                  const std::string& accepted_engine = "");
};

// Removes what a dead owner left unfinished, opens or creates the database, and adopts the campaign. `tell`
// gets messages for people. Throws IntegrityError, which says how to restore the database if there is a
// backup, InputError, DatabaseError.
Database open_for_owner(
    const ClaimedCampaign& claimed, const std::function<void(const std::string&)>& tell = [](const auto&) {});

// Returns the campaign that the database has adopted: that of the file, with the values that runs have
// chosen.
Campaign adopted_campaign(Database& database);

// Here `campaign` is the one that the database has adopted.
struct OwnedCampaign : ClaimedCampaign {
  Database database;
  OwnedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                const std::string& accepted_engine = "");
};

// Sets aside the results of other engines than this one at the points that are still to be run.
void accept_engine(CampaignState& state, const Json& engine, RunListener& listener);

// Returns the sentence that follows the message of an OtherEngine and says how to accept the engine.
std::string acceptance_hint(const std::string& verb_and_file, const Json& engine);

// FolderWatch stops a run whose folder or database was moved or deleted. Files that the owner has open live
// on without their names until it ends, so a deleted database is saved before that. Requires folder and
// database to be whole.
class FolderWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // References must outlive the watch.
  FolderWatch(const CampaignDirectory& directory, const OwnerLock& lock, Database& database,
              RunListener& listener);

  // Checks about once a second. Makes deleted folders below anew, warns, and returns whether it did. Throws
  // IntegrityError if the folder or the database was moved or deleted: it says what was saved where, and how
  // to continue.
  bool attend(Time now);

 private:
  void refuse_move() const;
  void refuse_deletion() const;
  bool mend_folders() const;

  const CampaignDirectory& directory_;
  const OwnerLock& lock_;
  Database& database_;
  RunListener& listener_;
  Time last_{};
};

}  // namespace peclet::runner
