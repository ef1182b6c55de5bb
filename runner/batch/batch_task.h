// The verb `peclet task`: one task of a bundle on a node, without a database.
#pragma once

#include "runner/campaign/paths.h"

namespace peclet::runner {

struct TaskOptions {
  fs::path manifest;
  int index = 0;
};

// Runs the task's seeds one after another and skips those that have ended, so that a task that is queued
// again goes on where it was. SIGTERM, SIGINT and SIGUSR1 make the engine save a checkpoint and leave. The
// result is the exit code: 0 every seed has ended (in whatever way: that is for the owner to judge), 75
// stopped and can be queued again. Throws InputError (exit code 2), EngineError (1) when the engine does not
// start here, IntegrityError (6) when it is another one than the owner's; the owner reads about it, too.
int run_task(const TaskOptions& options);

}  // namespace peclet::runner
