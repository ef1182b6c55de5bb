// Files by which owner and nodes share handed-over seeds, below one folder that both see.
//
//   SHARED/spool, checkpoints, failures   as in a campaign's folder
//   SHARED/bundles/NAME/
//     manifest.json          what is to be done; written once, by the owner
//     *.sh                   the job and the commands, from the template; written once
//     ended/N.json           how the bundle's seed N has ended; written by its task
//     tasks/I/running.json   the seed that task I runs or has drained; written by it. Further ones are in
//                            running-1.json ..., if its engine runs several at once
//     tasks/I/trouble.json   why task I could do nothing at all
//     tasks/I/*.result       results that are not in the spool yet
//     tasks/I/files          files that their realisations leave beside them
//     forgotten              the owner has given the bundle up: no task begins a seed any more
//     logs/                  what tasks and engines printed
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

// A seed of a bundle. Its place is its index in the manifest.
struct BundledSeed {
  std::string point;  // hash of the scene
  int seed = 0;
  int halvings = 0;  // of the seeds in its engine, as in blame.h
};

struct Manifest {
  std::string bundle, campaign;     // names
  std::vector<std::string> engine;  // program and arguments, as the nodes find them
  fs::path engine_folder;           // folder in which it runs, if the node has it
  std::string engine_identity;      // identity that the engine there must have
  int threads = 1;
  std::string device{};  // as in choose_device()
  double lease_seconds = 120, checkpoint_seconds = 60;
  Json scenes;                          // by hash
  std::vector<BundledSeed> seeds;       // in the order in which tasks take them
  std::vector<std::vector<int>> tasks;  // places in `seeds`, for each task
};

const KeyTable& manifest_keys();
Json manifest_json(const Manifest& manifest);
// Throws InputError if the file is absent or not a manifest.
Manifest read_manifest(const fs::path& path);

// Names of the files in a bundle's folder.
class BundleFolder {
 public:
  BundleFolder(const fs::path& shared, const std::string& name)
      : shared_(shared), root_(shared / "bundles" / name) {}
  // Returns the folder of a manifest, which owner and nodes may see in different places.
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
  fs::path running(int index, int slot = 0) const {
    return task(index) / (slot == 0 ? "running.json" : "running-" + std::to_string(slot) + ".json");
  }
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
// Returns nothing if there is no report. Throws InputError if the file is not a report.
std::optional<PlacedReport> read_report(const fs::path& path);
// Returns the reports of the seeds that the task runs or has drained.
std::vector<PlacedReport> read_running(const BundleFolder& folder, int task);

// Returns how the names of a seed's results begin, in the task's folder and in the spool.
std::string result_name(const BundledSeed& seed);

// True if the bundle's manifest can be seen from here; otherwise `why` says why not. A folder that cannot be
// reached (not mounted, or not answering) is an answer, not an error.
bool is_there(const BundleFolder& folder, std::string& why);

// Returns what a person may do about seeds that are out, or "". `words` name the campaign to the verbs.
std::string handed_over_advice(const std::vector<HandedOver>& bundles, const std::string& words);

// Moves the results in a task's own folder into the spool, after the files that their realisations left, and
// notes them as ended. Files that are not results go to spool/rejected.
void publish_results(const BundleFolder& folder, const Manifest& manifest, int task);
// Does so with one of them.
void publish_result(const BundleFolder& folder, const Manifest& manifest, int task, const fs::path& file);

}  // namespace peclet::runner
