// Bundles hands seeds over to a batch system in bundles: it makes them, submits them, asks about them and
// settles them.
//
// The batch system is not trusted with results: these come through the spool, and the ends of attempts
// through the reports of tasks. It is asked one thing only: whether a task is still there. The seeds of a
// task that is gone without a result are queued again. Without an answer nothing is concluded, until a person
// forgets the bundle. A wrong answer only costs time: a seed that runs twice gives the same result twice,
// which counts once.
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
  int largest_array = 1000;  // most tasks of one bundle
  int threads = 1;
  std::string device{};  // as in choose_device()
  double lease_seconds = 120, checkpoint_seconds = 60;
  bool ahead = false;  // also hand over the seeds of the stop tests after the next ones
  BatchTemplate scripts;
  std::vector<std::string> options;  // options of submit.sh
  std::vector<std::string> engine;   // program and arguments
  fs::path engine_folder;
  Json engine_provenance;  // provenance of the owner's engine; the nodes' must have its identity
  std::string program;     // peclet, as the nodes find it
};

// Throws InputError if these settings cannot be put into the template.
void check_template(const BatchTemplate& scripts, const fs::path& shared, const std::string& program);

class Bundles {
 public:
  // All references must outlive it.
  Bundles(Database& database, CampaignState& state, const Campaign& campaign, CampaignDirectory directory,
          RunListener& listener);

  struct SettleReport {
    int open = 0;          // bundles with tasks or seeds that are still out
    int unknown = 0;       // open bundles without an answer of the batch system
    int unreachable = 0;   // unknown bundles whose folder is not there
    int unconfirmed = 0;   // open bundles whose submission has not been confirmed
    int ended = 0;         // seeds that have ended, in whatever way
    std::string lifeless;  // message about tasks that ended before they began a seed; "" if none did
    // True if something is out that will be heard of again.
    bool any_awaited() const { return open > unreachable + unconfirmed; }
  };
  // Takes in results and reports, asks the batch system which tasks are still there, and queues the seeds of
  // tasks that are gone without a result again.
  SettleReport settle();

  // Submits again the jobs that the batch system has never shown. Requires a settle() before, which asks for
  // them by name. Returns why the batch system refused, or ""; after a refusal the seeds are open again.
  std::string submit_unconfirmed();
  // Hands the open seeds over. Returns as submit_unconfirmed(); what was taken before a refusal stays out.
  std::string hand_over(const BundleSettings& settings);
  bool any_out() const { return !book_.open_bundles().empty(); }
  // Describes what hand_over() would do; nothing is made or submitted.
  std::string describe(const BundleSettings& settings);
  // Ends all jobs, and takes back the seeds of jobs that were never submitted. Tasks may take time to end.
  void cancel();
  // Queues the seeds of a bundle again without waiting for an answer; its job is ended once its folder can be
  // reached. Results that its tasks still leave are taken in, and count once. Returns false if no open bundle
  // has this name.
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
  // Last complaint about each bundle, so that it is not repeated.
  std::map<std::string, std::string> told_;
};

}  // namespace peclet::runner
