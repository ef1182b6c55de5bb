// Which system call of which process goes wrong, and how: the fault drill's plan, as the environment gives
// it.
//
// The shim is preloaded (LD_PRELOAD) into the program under test, so nothing of it is in the product.
//
//   PECLET_FAULT_BOARD    file of one page that the drill has made: counts, shared by all processes
//   PECLET_FAULT_PLAN     "role=owner call=any number=17 action=kill path=.peclet/ for=1"
//   PECLET_FAULT_JOURNAL  folder: changes of files are recorded there, so that a power cut can undo them
//
// role: owner (a process called peclet), worker (any other), any. call: the names below, or `any` for those
// that change something. number: the first call that is hit, from 1, counted over all processes of the role;
// 0 only counts. for: how many calls in a row are hit. path: parts of files' names, separated by commas, one
// of which must occur; the name of what is sent to is "socket". action: see below.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

namespace peclet::drill {

enum class Call { create, write, truncate, sync, rename, remove, send, read, allocation };

// How long `wait` waits at most, so that nothing outlives a drill that was broken off.
constexpr int longest_wait_seconds = 60;

enum class Action {
  kill,    // SIGKILL of the calling process
  cut,     // SIGKILL of owner and workers, the caller last
  stop,    // SIGSTOP of the calling process, which goes on with SIGCONT
  wait,    // the calling process hangs in the call until the board's `off`
  eio,     // the call fails with EIO
  enospc,  // the call fails with ENOSPC
  edquot,  // the call fails with EDQUOT
  fail     // an allocation that gives nothing
};

// In the board's file, which starts as zeros. The drill reads and writes it with the same layout.
struct Board {
  std::atomic<std::int64_t> calls;     // that fit the plan
  std::atomic<std::int64_t> struck;    // of these, hit
  std::atomic<std::int64_t> off;       // not zero: nothing is hit any more
  std::atomic<std::int64_t> sequence;  // of the journal's records
  std::atomic<std::int64_t> process;   // that was hit last
  char what[256];                      // the call that was hit last: its name and its file
};

// Counts the call if it fits the plan. If it is the one to be hit, kills or stops, or returns the error that
// the call is to fail with; otherwise 0.
int strike(Call call, std::string_view path);

// The file behind a descriptor; "socket:[...]" for a socket.
std::string path_of(int descriptor);

// The next number of a record in the journal.
std::int64_t next_record();

}  // namespace peclet::drill
