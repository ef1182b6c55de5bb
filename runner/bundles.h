// Bundles of seeds in the hands of a batch system: made, submitted, asked after, settled.
//
// Nothing here trusts the batch system with a result: results come through the spool, and what became of an
// attempt through the reports of the tasks. The batch system is asked for one thing: is a task still there?
// When it is not, and has left no result, its seeds are queued again. When nobody answers, nothing is
// concluded. A wrong answer costs time only: a seed that is run twice gives the same result twice, and it
// counts once.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "runner/batch_system.h"
#include "runner/bundle_book.h"
#include "runner/bundle_files.h"
#include "runner/ledger.h"

namespace peclet::runner {

struct BundleSettings {
  std::filesystem::path shared;
  int seeds_per_task = 1;
  int largest_array = 1000;  // tasks of one bundle
  int threads = 1;
  double lease_seconds = 120, checkpoint_seconds = 60;
  bool ahead = false;  // also the seeds of the look after the next one
  BatchTemplate scripts;
  std::vector<std::string> options;  // of submit.sh
  std::vector<std::string> engine;   // program and arguments
  std::filesystem::path engine_folder;
  Json engine_provenance;  // of the owner's engine: the nodes' must have its identity
  std::string program;     // peclet, as the nodes find it
};

class Bundles {
 public:
  // All references must outlive it.
  Bundles(Database& database, Ledger& ledger, const Campaign& campaign, CampaignDirectory directory,
          RunListener& listener);

  struct Settled {
    int open = 0;         // bundles of which something is still out
    int unknown = 0;      // of these, those that nobody answers for
    int unconfirmed = 0;  // those whose submission has not been seen
    int ended = 0;        // seeds that have ended, in whatever way
    std::string
        lifeless;  // of tasks that have gone without having begun a seed, in words; "" when there were none
  };
  // Takes in results and reports, asks the batch system what is still there, and puts the seeds of tasks that
  // have gone without a result back.
  Settled settle();

  // Submits again what was never seen to arrive: requires a settle() since, which has asked for it by name.
  void submit_unconfirmed();
  // Hands the open seeds over; returns how many.
  int hand_over(const BundleSettings& settings);
  // What hand_over() would do, in words; nothing is made or submitted.
  std::string describe(const BundleSettings& settings);
  // Ends all jobs, and takes the seeds back of those that were never submitted. Tasks may take their time to
  // go.
  void cancel();

 private:
  void settle_bundle(const BundleRecord& bundle, Settled& settled);
  void book(const BundleRecord& bundle, const BundleFolder& folder, const Manifest& manifest,
            const QueryAnswer* answer, Settled& settled);
  struct Returned {
    int seeds = 0, lifeless = 0;
    std::set<std::string> troubles;
  };
  void return_seed(const BundleRecord& bundle, const BundleFolder& folder, const BundleSeedRecord& seed,
                   Returned& returned);
  void tell(const BundleRecord& bundle, const Returned& returned, Settled& settled);
  bool was_never_submitted(const BundleRecord& bundle) const;
  void withdraw(const BundleRecord& bundle);
  void close(const BundleRecord& bundle, const BundleFolder& folder);
  void make(const BundleSettings& settings, const std::vector<SeedId>& seeds);
  void submit(const BundleRecord& bundle, const std::vector<std::string>& options);
  std::string free_name(const std::filesystem::path& shared);
  Manifest manifest_of(const BundleSettings& settings, const std::vector<SeedId>& seeds) const;
  void write(const BundleFolder& folder, const Manifest& manifest, const BundleSettings& settings);

  Database& database_;
  Ledger& ledger_;
  const Campaign& campaign_;
  CampaignDirectory directory_;
  RunListener& listener_;
  BundleBook book_;
  Queue queue_;
};

}  // namespace peclet::runner
