// A launched worker: an engine on another machine, which a launcher of the user's (srun, ssh, mpiexec)
// starts.
//
//   owner = near end - launcher ~ far end = engine        = a socket pair, - pipes, ~ whatever the launcher
//   uses
//
// Both ends are `peclet worker`. To the owner, the near end is an engine. It starts the launcher, which
// starts the far end on another machine, which starts the engine there, in a folder of its own. The two ends
// pass frames on, and carry the files of a job in pieces: its checkpoint there, its results and checkpoints
// back. If one end hears nothing of the other for `silence`, it counts as lost.
#pragma once

#include <string>
#include <vector>

namespace peclet::runner {

struct WorkerOptions {
  std::string through;              // command of the launcher, for /bin/sh; "": be the far end
  double silence_seconds = 60;      // of the other end, after which it counts as lost
  std::vector<std::string> engine;  // of the near end: program and arguments
};

// Serves the owner, or the near end, until there is nothing more to do. The near end leaves as the engine
// did: with its exit code, or by its signal; by SIGKILL if the launcher or the link was lost. Returns the
// exit code.
int run_worker(const WorkerOptions& options);

}  // namespace peclet::runner
