// How both programs leave.
#pragma once

#include <exception>

namespace peclet {

struct ExitCode {
  enum : int {
    done = 0,  // of a run: every point converged, or has all its seeds
    error = 1,
    usage = 2,        // or faulty input; nothing has been written
    unconverged = 3,  // finished, but some points are capped, failed, cancelled or lost seeds
    unfinished = 4,   // of a request: asked for, and not carried out yet
    owned = 5,        // another process owns the campaign
    integrity = 6,    // the database is damaged, or a seed gave two different results
    stopped = 75,     // by a signal, a time limit or a budget; the same command goes on
  };
};

// Whether an error is about a name that no file can have, too long or a loop of links: only a person gives
// such names, so that it is one of usage.
bool is_impossible_name(const std::exception& error);

}  // namespace peclet
