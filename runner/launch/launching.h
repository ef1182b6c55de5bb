// The commands of launched workers, from --launch and --hosts.
#pragma once

#include <string>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/engines/engine_process.h"

namespace peclet::runner {

// A line of a file of hosts, as MPI programs write it: "node1", "node1 slots=8" or "node1:8".
struct Host {
  std::string name;  // a name or address, or USER@NAME
  int slots = 1;     // workers
};

// Reads a file of hosts. Empty lines and what follows a # are left out. Throws InputError, which names the
// line.
std::vector<Host> read_hosts(const fs::path& file);

struct Launching {
  std::string launcher;     // shell command, with {threads} and, if there are hosts, {host}
  std::vector<Host> hosts;  // empty: the launcher finds the hosts
  int workers = 0;
};
// Returns what --launch ("": ssh), --hosts ("": none) and --workers (0: all slots of the hosts) ask for.
// Throws InputError if they do not fit together.
Launching read_launching(const std::string& launcher, const fs::path& hosts, int workers);

struct LaunchedWorkers {
  std::vector<EngineCommand> commands;
  std::vector<std::string> hosts;  // of each, by their names for people
};
// Returns the near ends of as many workers, at most launching.workers. They are dealt out to the hosts in
// turn, so that few workers use all hosts. The other end of a worker counts as lost after this time of
// silence.
LaunchedWorkers launched_workers(const EngineCommand& engine, const Launching& launching, int workers,
                                 int threads, double silence_seconds);

}  // namespace peclet::runner
