// Notices what somebody else does to a campaign's folder while it runs: deletes it, moves it away, or parts
// of it.
#pragma once

#include <chrono>

#include "runner/owner/run_listener.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"
#include "runner/store/locks.h"

namespace peclet::runner {

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
