// The command line of `peclet`, read.
#pragma once

#include <optional>
#include <variant>

#include "runner/batch/batch_task.h"
#include "runner/care/backup.h"
#include "runner/care/doctor.h"
#include "runner/care/restore.h"
#include "runner/command_line/command_tree.h"
#include "runner/command_line/completion.h"
#include "runner/command_line/manual.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/report.h"
#include "runner/reports/results.h"
#include "runner/reports/status.h"
#include "runner/verbs/cancel.h"
#include "runner/verbs/hand_over.h"
#include "runner/verbs/init.h"
#include "runner/verbs/plan_campaign.h"
#include "runner/verbs/retry.h"
#include "runner/verbs/run.h"
#include "runner/verbs/set.h"
#include "runner/verbs/study.h"
#include "runner/verbs/validate.h"
#include "runner/verbs/watch.h"

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
