// The command line of `peclet`, read.
#pragma once

#include <optional>
#include <variant>

#include "runner/backup.h"
#include "runner/batch_task.h"
#include "runner/cancel.h"
#include "runner/command_tree.h"
#include "runner/completion.h"
#include "runner/doctor.h"
#include "runner/explain.h"
#include "runner/export.h"
#include "runner/hand_over.h"
#include "runner/init.h"
#include "runner/manual.h"
#include "runner/plan_campaign.h"
#include "runner/report.h"
#include "runner/restore.h"
#include "runner/results.h"
#include "runner/retry.h"
#include "runner/run.h"
#include "runner/set.h"
#include "runner/status.h"
#include "runner/study.h"
#include "runner/validate.h"
#include "runner/watch.h"

namespace peclet::runner {

using Verb =
    std::variant<InitOptions, ValidateOptions, PlanOptions, RunOptions, StatusOptions, WatchOptions,
                 ExplainOptions, ExportOptions, ResultsOptions, ReportOptions, BackupOptions, RestoreOptions,
                 DoctorOptions, HandOverOptions, IngestOptions, TaskOptions, SetOptions, CancelOptions,
                 RetryOptions, CompletionOptions, ManualOptions, StudyOptions>;

struct CommandLine {
  std::optional<Verb> verb;  // nothing: there is nothing left to do but to leave with
  int exit_code = 0;         // 0 after help or version, 2 after a fault, both printed already
};

CommandLine read_command_line(int argc, char** argv);

// All verbs and options.
CommandTree command_tree();

}  // namespace peclet::runner
