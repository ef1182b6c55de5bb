// The verbs `peclet run`, from a campaign file to converged points, and `peclet plan`.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "runner/owner/owned_campaign.h"

namespace peclet::runner {

// The end of a run, as the command of --notify is told.
struct RunOutcome {
  std::filesystem::path campaign, directory;
  int code = 0;         // the exit code that follows
  std::string summary;  // one line
};

// Runs `command` with /bin/sh and waits for it, at most one minute. Its standard input is empty, and its
// output goes to standard error. The variables PECLET_CAMPAIGN (the file) and PECLET_DIRECTORY, both absolute
// paths, PECLET_EXIT_CODE and PECLET_SUMMARY describe the run. Returns why the command failed, in one line.
std::string notify(const std::string& command, const RunOutcome& outcome);

struct RunOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;     // "": beside the campaign file
  std::string device;                  // as in choose_device()
  int workers = 0;                     // 0: one for each card of the device, else cores / threads
  int threads = 0;                     // for each worker; 0: 1, or cores / workers if workers are given
  std::string launch;                  // shell command that starts workers elsewhere; "": none
  std::filesystem::path hosts;         // file of hosts of workers; "": none
  bool quiet = false;                  // no progress
  bool jsonl = false;                  // events on standard output, instead of the table at the end
  std::optional<double> time_limit;    // seconds until the drain
  std::string accept_engine;           // name of the engine that replaces another one; "": none
  bool force = false;                  // use a network file system all the same
  double lease_seconds = 120;          // without a new step, after which a worker is hung
  double checkpoint_seconds = 60;      // between two checkpoints of a realisation
  double backup_seconds = 600;         // between two backups of the database
  std::optional<double> budget_hours;  // processor time that this run may spend [h]
  std::string notify;                  // shell command to call at the end; "": none
};

struct WorkerCount {
  int workers, threads;
};
// Returns the workers, and the threads of each. Numbers that are not given follow from the usable cores, so
// that all threads together fill the machine.
WorkerCount worker_count(const RunOptions& options);

// Runs until every point is decided or the run is stopped, and returns the exit code:
// clang-format off
//   0   every point converged, or has all its seeds
//   3   some points are capped, failed, cancelled or have losses
//   6   a point is suspect
//   75  stopped, or at the end of the budget
// clang-format on
// Throws InputError (code 2) before anything is written, OwnedByAnother (5), IntegrityError (6), others (1).
int run_campaign(const RunOptions& options);

// Runs the seeds 0 .. seeds - 1 of every point that is not decided, as run_campaign(). Calls `conclude` with
// the campaign in hand, unless the run was stopped. Returns 75 if stopped, 6 if a point is suspect, else 0.
int run_pilot(const RunOptions& options, int seeds,
              const std::function<void(const ClaimedCampaign&, Database&)>& conclude);

struct PlanOptions {
  RunOptions run;            // of the pilot; the plan is made for the same workers
  std::optional<int> pilot;  // seeds of each point to run first; absent: nothing is run or written
  bool json = false;
};

// Prints the plan. The engine gives the length of the realisations, the database their cost; if no cost is
// known, the engine tries a realisation of the point with the median work for two seconds. With a pilot, runs
// that first and stores its predictions. Returns 0, or as run_pilot(). Throws as run_campaign().
int plan_campaign(const PlanOptions& options);

}  // namespace peclet::runner
