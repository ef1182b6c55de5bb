// What owner and nodes share of seeds that are handed over: files below one folder that both see, nothing
// else.
//
//   SHARED/spool, checkpoints, failures      as in a campaign's folder
//   SHARED/bundles/NAME/manifest.json        what is to be done; written once, by the owner
//                       *.sh                 the job and the commands, from the template; written once
//                       ended/N.json         what became of the bundle's seed N; written by its task
//                       tasks/I/running.json the seed in the hands of task I, or drained by it; written by it
//                       tasks/I/trouble.json why task I could do nothing at all
//                       tasks/I/*.result     results that are not in the spool yet
//                       tasks/I/files        what their realisations leave beside them
//                       forgotten            the owner has given the bundle up: no task begins a seed any
//                       more logs/                what tasks and engines printed
//
// Every file is written whole (temporary file, fsync, rename) by one process at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/key_table.h"
#include "runner/campaign/paths.h"
#include "runner/store/blame.h"
#include "runner/store/bundle_store.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// A seed of a bundle, called by its place in the manifest.
struct BundledSeed {
  std::string point;  // hash
  int seed = 0;
};

struct Manifest {
  std::string bundle, campaign;     // names
  std::vector<std::string> engine;  // program and arguments, as the nodes find them
  fs::path engine_folder;           // in which it runs, where the node has it
  std::string engine_identity;      // that the engine there must have
  int threads = 1;
  double lease_seconds = 120, checkpoint_seconds = 60;
  Json scenes;                          // by hash
  std::vector<BundledSeed> seeds;       // in the order in which tasks take them
  std::vector<std::vector<int>> tasks;  // of places in `seeds`
};

const KeyTable& manifest_keys();
Json manifest_json(const Manifest& manifest);
// Throws InputError for a file that is absent or no manifest.
Manifest read_manifest(const fs::path& path);

// Names below a bundle's folder.
class BundleFolder {
 public:
  BundleFolder(const fs::path& shared, const std::string& name)
      : shared_(shared), root_(shared / "bundles" / name) {}
  // Of a manifest where it is seen here: owner and nodes may see the shared folder in different places.
  static BundleFolder of_manifest(const fs::path& manifest);

  // The folders that this bundle shares with others: spool, checkpoints, failures.
  const CampaignDirectory& shared() const { return shared_; }
  const fs::path& root() const { return root_; }
  fs::path manifest() const { return root_ / "manifest.json"; }
  fs::path script(const std::string& name) const { return root_ / name; }
  fs::path forgotten() const { return root_ / "forgotten"; }
  fs::path logs() const { return root_ / "logs"; }
  fs::path ended(int place) const { return root_ / "ended" / (std::to_string(place) + ".json"); }
  fs::path task(int index) const { return root_ / "tasks" / std::to_string(index); }
  fs::path running(int index) const { return task(index) / "running.json"; }
  fs::path trouble(int index) const { return task(index) / "trouble.json"; }
  fs::path left(int index) const { return task(index) / "files"; }
  void create(int tasks) const;

 private:
  CampaignDirectory shared_;
  fs::path root_;
};

void write_report(const fs::path& path, int place, const AttemptReport& report);
struct PlacedReport {
  int place = 0;
  AttemptReport report;
};
const KeyTable& report_keys();
// Nothing when there is none. Throws InputError for a file that is no report.
std::optional<PlacedReport> read_report(const fs::path& path);

// How the names of a seed's results begin, in the task's folder and in the spool.
std::string result_name(const BundledSeed& seed);

// Whether the bundle's manifest can be seen from here; `why` says why not. A folder that cannot be reached (a
// file system that is not mounted, or no longer answers) is no error, but an answer.
bool is_there(const BundleFolder& folder, std::string& why);

// What a person may do about seeds that are out; `words` are the campaign's on the command line.
std::string handed_over_advice(const std::vector<HandedOver>& bundles, const std::string& words);

// Moves the results that a task has left in its own folder into the spool, under names of their own, after
// what their realisations left beside them, and notes them as ended. Files that are no result go to
// spool/rejected.
void publish_results(const BundleFolder& folder, const Manifest& manifest, int task);

}  // namespace peclet::runner
