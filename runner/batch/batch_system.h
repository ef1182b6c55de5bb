// A batch system (Slurm, ...) as a folder of text: a job script and the commands that submit, query and
// cancel it.
//
//   job.sh       becomes the bundle's job script; @NAME@, @LAST@ (index of the last task), @TASKS@,
//   @THREADS@,
//                @PECLET@ (the program), @MANIFEST@ and @FOLDER@ (the bundle's) are replaced, quoted for
//                where they stand
//   submit.sh    NAME JOB_SCRIPT [OPTION...]: submits it, prints the job's number. Exit code 75 when nobody
//                knows whether the job was taken, any other but 0 when it was not
//   query.sh     NAME: prints one line per task, JOB INDEX waiting|running|ended; exit code 0 only when the
//                answer is complete
//   cancel.sh    NAME: ends the jobs of that name
//   largest.sh   prints how many tasks a job may have
//
// They are run by sh, from the bundle's folder, into which they are copied: what submitted a job also asks
// for it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runner/campaign/paths.h"

namespace peclet::runner {

using BatchTemplate = std::map<std::string, std::string>;  // text by file name

// The folder's, or (for "") the built-in one of that name. Throws InputError when there is no such, or a file
// is missing.
BatchTemplate batch_template(const std::string& system, const fs::path& folder);

// Puts `values` in the place of their names between @, each quoted for where it stands: for the shell, or in
// a line `#SBATCH ...` for sbatch. In any other line that begins with #, which may be a directive of another
// batch system, and between quotes, a value must be plain. Throws InputError for what cannot be quoted there
// (nowhere can control characters), and for a name that is not in `values`.
std::string fill_in(const std::string& text, const std::map<std::string, std::string>& values,
                    const std::string& file);

enum class TaskState { waiting, running, ended };

// What the batch system says about a job's name.
struct QueryAnswer {
  std::vector<std::string> jobs;  // numbers; more than one when a job was submitted twice
  std::map<int, TaskState> tasks;
  // A task that is not listed has ended or was never there.
  bool alive(int task) const;
};

struct JobTaken {
  std::string job;  // its number
};
struct JobRefused {  // there is no such job, nor will there be
  std::string complaint;
};
struct JobUnknown {  // the answer was lost, and the job may be there
  std::string complaint;
};
using Submission = std::variant<JobTaken, JobRefused, JobUnknown>;

// A submit command that fails after all its work is found out by asking for the job's name.
Submission submit_job(const fs::path& folder, const std::string& name,
                      const std::vector<std::string>& options);
// Nothing when nobody knows; `why` says so. That is no news about any task.
std::optional<QueryAnswer> query_job(const fs::path& folder, const std::string& name, std::string& why);
// False when it failed.
bool cancel_job(const fs::path& folder, const std::string& name, std::string& why);
// Tasks that a job may have; `otherwise` when the batch system does not say.
int largest_array(const BatchTemplate& scripts, int otherwise);

// The templates of templates/, compiled in.
BatchTemplate slurm_template();

}  // namespace peclet::runner
