// Bundles of seeds in the hands of a batch system: made, submitted, asked after, settled.
//
// Nothing here trusts the batch system with a result: results come through the spool, and what became of an
// attempt through the reports of the tasks. The batch system is asked for one thing: is a task still there?
// When it is not, and has left no result, its seeds are queued again. When nobody answers, nothing is
// concluded, until a person says that a bundle is to be forgotten. A wrong answer costs time only: a seed
// that is run twice gives the same result twice, and it counts once.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/batch/batch_system.h"
#include "runner/batch/bundle_files.h"
#include "runner/campaign/paths.h"
#include "runner/owner/campaign_state.h"
#include "runner/store/bundle_store.h"
#include "runner/store/point_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

struct BundleSettings {
  fs::path shared;
  int seeds_per_task = 1;
  int largest_array = 1000;  // tasks of one bundle
  int threads = 1;
  double lease_seconds = 120, checkpoint_seconds = 60;
  bool ahead = false;  // also the seeds of the stop test after the next one
  BatchTemplate scripts;
  std::vector<std::string> options;  // of submit.sh
  std::vector<std::string> engine;   // program and arguments
  fs::path engine_folder;
  Json engine_provenance;  // of the owner's engine: the nodes' must have its identity
  std::string program;     // peclet, as the nodes find it
};

// What the template would make of these settings. Throws InputError for what cannot be put into it, before
// anything is written.
void check_template(const BatchTemplate& scripts, const fs::path& shared, const std::string& program);

class Bundles {
 public:
  // All references must outlive it.
  Bundles(Database& database, CampaignState& state, const Campaign& campaign, CampaignDirectory directory,
          RunListener& listener);

  struct SettleReport {
    int open = 0;         // bundles of which something is still out
    int unknown = 0;      // of these, those that nobody answers for
    int unreachable = 0;  // of the unknown, those whose folder is not there
    int unconfirmed = 0;  // those whose submission has not been seen
    int ended = 0;        // seeds that have ended, in whatever way
    std::string
        lifeless;  // of tasks that have gone without having begun a seed, in words; "" when there were none
    // Something is out that will be heard of again.
    bool any_awaited() const { return open > unreachable + unconfirmed; }
  };
  // Takes in results and reports, asks the batch system what is still there, and puts the seeds of tasks that
  // have gone without a result back.
  SettleReport settle();

  // Submits again the jobs that the batch system has never shown. Requires a settle() before, which asks for
  // them by name.
  // The result is why the batch system refused, "" when it did not; the seeds are open again then.
  std::string submit_unconfirmed();
  // Hands the open seeds over. The result is as before; what was taken before the refusal stays out.
  std::string hand_over(const BundleSettings& settings);
  bool any_out() const { return !book_.open_bundles().empty(); }
  // What hand_over() would do, in words; nothing is made or submitted.
  std::string describe(const BundleSettings& settings);
  // Ends all jobs, and takes the seeds back of those that were never submitted. Tasks may take their time to
  // go.
  void cancel();
  // Queues the seeds of a bundle again without waiting for anybody's answer, and ends its job where that can
  // be reached. Results that its tasks leave all the same are taken in, and count once. False: nothing of it
  // is out.
  bool forget(const std::string& name);

 private:
  void settle_bundle(const BundleRecord& bundle, SettleReport& settled);
  void book(const BundleRecord& bundle, const BundleFolder& folder, const Manifest& manifest,
            const QueryAnswer* answer, SettleReport& settled);
  struct Returned {
    int seeds = 0, lifeless = 0;
    std::set<std::string> troubles;
  };
  void return_seed(const BundleRecord& bundle, const BundleFolder& folder, const BundleSeedRecord& seed,
                   Returned& returned);
  void tell(const BundleRecord& bundle, const Returned& returned, SettleReport& settled);
  bool was_never_submitted(const BundleRecord& bundle) const;
  void withdraw(const BundleRecord& bundle);
  void take_back_seeds(const BundleRecord& bundle);
  void fence_forgotten();
  void tell_once(const std::string& about, const std::string& message);
  void close(const BundleRecord& bundle, const BundleFolder& folder);
  std::string make(const BundleSettings& settings, const std::vector<SeedId>& seeds);
  std::string submit(const BundleRecord& bundle, const std::vector<std::string>& options);
  std::string free_name(const fs::path& shared);
  Manifest manifest_of(const BundleSettings& settings, const std::vector<SeedId>& seeds) const;
  void write(const BundleFolder& folder, const Manifest& manifest, const BundleSettings& settings);

  Database& database_;
  CampaignState& state_;
  const Campaign& campaign_;
  CampaignDirectory directory_;
  RunListener& listener_;
  BundleStore book_;
  SeedStore seeds_;
  EventStore events_;
  std::map<std::string, std::string>
      told_;  // the last complaint about each bundle: the same is not made twice
};

}  // namespace peclet::runner
