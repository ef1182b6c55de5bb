// A campaign in the hands of the process that may write it.
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

// A seed may fail so often beyond the first time.
constexpr int retries = 2;

// Checked and locked: nobody else may write it now.
struct ClaimedCampaign {
  Campaign campaign;
  EngineCommand command;
  std::vector<SceneAnswer> scenes;  // of its points
  Json engine;                      // provenance of the engine here
  CampaignDirectory directory;
  OwnerLock lock;

  // Checks the campaign file and its scenes, makes the folder and takes the lock. `directory` as in
  // campaign_directory(); `force`: on a network file system, too; `accepted_engine`: a name of the engine
  // here, its version or 6 or more leading digits of its binary's hash, or nothing. Throws InputError before
  // anything is written, OwnedByAnother.
  ClaimedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                  const std::string& accepted_engine = "");
};

// Opens or creates the database and makes it that of the campaign file, after what a dead owner left
// unfinished has been removed. `tell`: what a person should know about it. Throws IntegrityError, which says
// how to restore it from a backup where there is one, InputError, DatabaseError.
Database open_for_owner(
    const ClaimedCampaign& claimed, const std::function<void(const std::string&)>& tell = [](const auto&) {});

struct OwnedCampaign : ClaimedCampaign {
  Database database;  // has adopted the campaign
  OwnedCampaign(const fs::path& file, const fs::path& chosen, bool force,
                const std::string& accepted_engine = "");
};

// Keeps the results of other engines than this one apart at the points that are still to be run.
void accept_engine(CampaignState& state, const Json& engine, RunListener& listener);

// What accepts the engine that an OtherEngine was thrown for: "; accept it with `peclet run FILE
// --accept-engine 1a2b3c4d5e6f`: ...".
std::string acceptance_hint(const std::string& verb_and_file, const Json& engine);

// The files that the owner has open live on without their names until it ends, and all that was committed
// with them: so a database whose name is gone is copied before that. Requires folder and database to be
// whole.
class FolderWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // References must outlive the watch.
  FolderWatch(const CampaignDirectory& directory, const OwnerLock& lock, Database& database,
              RunListener& listener);

  // Looks about once a second. Makes folders below anew, says so, and returns whether it did. Throws
  // IntegrityError when folder or database are no longer where they were: it says what was saved where, and
  // how to go on.
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
