// The verbs `peclet run`, from a campaign file to converged points, and `peclet plan`.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "runner/owner/owned_campaign.h"

namespace peclet::runner {

// The command of the user's that a run calls when it has ended.
struct RunOutcome {
  std::filesystem::path campaign, directory;
  int code = 0;         // the exit code that follows
  std::string summary;  // one line
};

// Runs `command` by /bin/sh, with nothing on its standard input and what it says on standard error, and waits
// for it, a minute at most. It is told what has ended by the variables PECLET_CAMPAIGN (the file) and
// PECLET_DIRECTORY, absolute paths, PECLET_EXIT_CODE and PECLET_SUMMARY. Returns why it failed, on one line;
// nothing where it succeeded.
std::string notify(const std::string& command, const RunOutcome& outcome);

struct RunOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;     // "": beside the campaign file
  int workers = 0;                     // 0: cores / threads
  int threads = 0;                     // of each worker; 0: 1, or cores / workers when workers are given
  bool quiet = false;                  // no progress
  bool jsonl = false;                  // events on standard output, instead of the table at the end
  std::optional<double> time_limit;    // seconds until the drain
  std::string accept_engine;           // its name; "": none takes another one's place
  bool force = false;                  // use a network file system all the same
  double lease_seconds = 120;          // a worker without a new step for so long is hung
  double checkpoint_seconds = 60;      // between two checkpoints of a realisation
  double backup_seconds = 600;         // between two backups of the database
  std::optional<double> budget_hours;  // of processor time, that this run may spend
  std::string notify;                  // a command of the shell for the end; "": none
};

// What is not given follows from what is: together they fill the machine.
struct WorkerCount {
  int workers, threads;
};
WorkerCount worker_count(const RunOptions& options);

// Runs until every point is decided or the run is stopped. The result is the exit code: 0 every point
// converged, 3 some points capped, failed, cancelled or with losses, 5 another process owns the campaign, 6
// integrity, 75 stopped, or at the end of its budget. Throws InputError (exit code 2) before anything is
// written, and std::exception (exit code 1) for the rest.
int run_campaign(const RunOptions& options);

// Runs the seeds 0 .. seeds - 1 of every point that is not decided, as run_campaign(), and calls `conclude`
// with the campaign in hand when all have ended. Returns 0 then, else 6 or 75.
int run_pilot(const RunOptions& options, int seeds,
              const std::function<void(const ClaimedCampaign&, Database&)>& conclude);

// The verb `peclet plan`: the pilot is run, the plan made of what the database has, and told.
struct PlanOptions {
  RunOptions run;            // of the pilot; its workers are those that the campaign is planned for
  std::optional<int> pilot;  // seeds of each point to run first; none: nothing is run and nothing written
  bool json = false;
};

// Asks the engine how long the realisations are, and the database, if there is one, what they cost; where it
// does not know, the engine tries a realisation of the point with the median work for two seconds. With a
// pilot runs it first and stores its predictions. Prints the plan; returns 0, or as run_pilot(). Throws as
// run_campaign().
int plan_campaign(const PlanOptions& options);

}  // namespace peclet::runner
