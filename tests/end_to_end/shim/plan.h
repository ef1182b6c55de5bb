// The fault drill's plan, read from the environment: which system call of which process fails, and how.
//
// The shim is preloaded (LD_PRELOAD) into the program under test, so it is not part of the product.
//
//   PECLET_FAULT_BOARD    file of one page made by the drill: counts, shared by all processes
//   PECLET_FAULT_PLAN     "role=owner call=any number=17 action=kill path=.peclet/ for=1"
//   PECLET_FAULT_JOURNAL  folder of records of changes, so that a power cut can undo them
//
// Fields of the plan:
//   role    owner (a process called peclet), worker (any other), any
//   call    a name below, or `any` for those that change something
//   number  the first call that fails, from 1, counted over all processes of the role; 0 only counts
//   for     number of consecutive calls that fail
//   path    parts of files' names, separated by commas, one of which must occur; "socket" for a send
//   action  see below
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

namespace peclet::drill {

enum class Call { create, write, truncate, sync, rename, remove, send, read, allocation };

// Limit of `wait` [s], so that no process outlives an interrupted drill.
constexpr int longest_wait_seconds = 60;

enum class Action {
  kill,    // SIGKILL of the calling process
  cut,     // SIGKILL of owner and workers, the caller last
  stop,    // SIGSTOP of the calling process, which SIGCONT continues
  wait,    // the calling process hangs in the call until the board's `off`
  eio,     // the call fails with EIO
  enospc,  // the call fails with ENOSPC
  edquot,  // the call fails with EDQUOT
  fail     // an allocation returns null
};

// The content of the board's file, initially zeros; the drill reads and writes the same layout.
struct Board {
  std::atomic<std::int64_t> calls;     // calls that fit the plan
  std::atomic<std::int64_t> struck;    // calls that failed
  std::atomic<std::int64_t> off;       // nonzero: no further faults
  std::atomic<std::int64_t> sequence;  // of the journal's records
  std::atomic<std::int64_t> process;   // that failed last
  char what[256];                      // name and file of the call that failed last
};

// Counts the call if it fits the plan. Kills or stops the process if the plan says so here. Returns the error
// that the call must fail with, or 0.
int strike(Call call, std::string_view path);

// Returns the file behind a descriptor; "socket:[...]" for a socket.
std::string path_of(int descriptor);

// Returns the next number of a record in the journal.
std::int64_t next_record();

}  // namespace peclet::drill
