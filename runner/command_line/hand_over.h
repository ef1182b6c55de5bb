// The verbs `peclet hand-over` and `peclet ingest`: a batch system runs the seeds, the owner keeps the book.
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
  std::filesystem::path shared;           // "": as the last time
  std::filesystem::path template_folder;  // "": the built-in one
  int seeds_per_task = 1;
  int largest_array = 0;  // 0: what the batch system says
  int threads = 1;
  double lease_seconds = 120, checkpoint_seconds = 60;
  std::vector<std::string> options;  // of the submit command
  std::string accept_engine;         // its name; "": none takes another one's place
  bool ahead = false;
  bool dry_run = false;
  bool follow = false;
  double interval = 30;         // seconds between two turns of --follow
  double backup_seconds = 600;  // between two backups of the database, with --follow
  bool quiet = false;
  bool force = false;  // use a network file system for the database all the same
};

// The batch system has said no. what() has its message.
class SubmissionRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Hands open seeds over once, or with `follow` settles and hands over until every point is decided. The
// result is the exit code: as of run_campaign() with `follow`, else 0. Throws as run_campaign(); EngineError
// when tasks cannot use their engine; SubmissionRefused when the batch system takes no job and, with
// `follow`, none of an earlier one is left to wait for.
int hand_over_campaign(const HandOverOptions& options);

struct IngestOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  bool cancel = false;  // take everything back
  bool quiet = false;
  bool force = false;
  std::vector<std::string> forget{};  // bundles whose seeds are taken back without an answer
};

// Takes in what nodes have done, and says how the bundles stand. Exit code 0, also when the batch system does
// not answer; 1 when the folder of seeds that are out is not there. Throws InputError for the name of no
// bundle.
int ingest_campaign(const IngestOptions& options);

}  // namespace peclet::runner
