// The verbs `peclet hand-over` and `peclet ingest`: a batch system runs the seeds of a campaign.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace peclet::runner {

struct HandOverOptions {
  std::string system;  // "slurm"
  std::filesystem::path campaign;
  std::filesystem::path directory;        // "": beside the campaign file
  std::filesystem::path shared;           // "": the one used last
  std::filesystem::path template_folder;  // "": the built-in one
  int seeds_per_task = 1;
  int largest_array = 0;  // 0: what the batch system says
  int threads = 1;
  std::string device;  // as in choose_device(); with cuda, Slurm is asked for a graphics card
  double lease_seconds = 120, checkpoint_seconds = 60;
  std::vector<std::string> options;  // words for the submit command
  std::string accept_engine;         // name of the engine that replaces another one; "": none
  bool ahead = false;
  bool dry_run = false;
  bool follow = false;
  double interval = 30;         // seconds between two turns of --follow
  double backup_seconds = 600;  // between two backups of the database, with --follow
  bool quiet = false;
  bool force = false;  // use a network file system for the database all the same
};

// Thrown if the batch system refuses a job; what() has its message.
class SubmissionRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Hands open seeds over once, or with `follow` settles and hands over until every point is decided. Returns
// the exit code: that of run_campaign() with `follow`, otherwise 0. Throws as run_campaign(), and EngineError
// if tasks cannot use their engine. Throws SubmissionRefused if the batch system refuses a job; with `follow`
// only if no earlier job is out.
int hand_over_campaign(const HandOverOptions& options);

struct IngestOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  bool cancel = false;  // take everything back
  bool quiet = false;
  bool force = false;
  std::vector<std::string> forget{};  // bundles whose seeds are queued again without an answer
};

// Takes in what nodes have done, and prints the seeds of each bundle that are still out. Returns 0, also if
// the batch system does not answer; 1 if the folder of seeds that are out does not exist. Throws InputError
// if `forget` has a name that is not that of a bundle.
int ingest_campaign(const IngestOptions& options);

}  // namespace peclet::runner
