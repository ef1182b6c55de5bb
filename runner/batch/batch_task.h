// The verb `peclet task` runs one task of a bundle on a node, without a database.
#pragma once

#include "runner/campaign/paths.h"

namespace peclet::runner {

struct TaskOptions {
  fs::path manifest;
  int index = 0;
};

// Runs the task's seeds one after another and skips those that have ended, so a task that is queued again
// continues where it stopped. SIGTERM, SIGINT and SIGUSR1 make the engine save a checkpoint and leave.
// Returns the exit code: 0 if every seed has ended, in whatever way; 75 if the task was stopped and can be
// queued again. Throws InputError (exit code 2), EngineError (1) if the engine does not start here,
// IntegrityError (6) if it is another engine than the owner's. The owner learns of these errors, too.
int run_task(const TaskOptions& options);

}  // namespace peclet::runner
