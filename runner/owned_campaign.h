// A campaign in the hands of the process that may write it.
#pragma once

#include <filesystem>

#include "runner/campaign_directory.h"
#include "runner/database.h"
#include "runner/engine_process.h"
#include "runner/scheduler.h"

namespace peclet::runner {

// A seed may fail so often beyond the first time.
constexpr int retries = 2;

struct OwnedCampaign {
  Campaign campaign;
  EngineCommand command;
  Json engine;  // provenance of the engine here
  CampaignDirectory directory;
  OwnerLock lock;
  Database database;  // has adopted the campaign

  // Checks the campaign file and its scenes, takes the lock, opens or creates the database and makes it that
  // of the file. `directory` as in campaign_directory(); `force`: on a network file system, too. Throws
  // InputError before anything is written, OwnedByAnother, IntegrityError, DatabaseError.
  OwnedCampaign(const std::filesystem::path& file, const std::filesystem::path& chosen, bool force);
};

// How a campaign stands whose points are decided (`finished`) or not: 0, 3, 6 or 75, as `peclet run` leaves.
int exit_code(Database& database, const Scheduler& scheduler, bool finished);

}  // namespace peclet::runner
