// Asks a batch system (Slurm, ...) to run jobs. A template describes it as a folder of text: a job script,
// and the commands that submit, query and cancel jobs.
//
//   job.sh       job script of a bundle; @NAME@, @LAST@ (index of the last task), @TASKS@, @THREADS@,
//                @PECLET@ (the program), @MANIFEST@ and @FOLDER@ (of the bundle) are replaced, each quoted
//                for its place
//   submit.sh    NAME JOB_SCRIPT [OPTION...]: submits it, prints the job's number. Exit code 75 if it is not
//                known whether the job was taken, any other but 0 if it was not
//   query.sh     NAME: prints one line per task, JOB INDEX waiting|running|ended; exit code 0 only if the
//                answer is complete
//   cancel.sh    NAME: ends the jobs of that name
//   largest.sh   prints how many tasks a job may have
//
// sh runs the copies in the bundle's folder, so the scripts that submitted a job also query it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runner/campaign/paths.h"

namespace peclet::runner {

using BatchTemplate = std::map<std::string, std::string>;  // text by file name

// Returns the files in `folder` (none if it is ""), and the built-in ones of `system` in the place of those
// that are not there. Throws InputError if one is in neither.
BatchTemplate batch_template(const std::string& system, const fs::path& folder);

// Replaces the names between @ by `values`, each quoted for its place: for the shell, or for sbatch in a line
// `#SBATCH ...`. A value must be plain between quotes, and in any other line that begins with #, which may be
// a directive of another batch system. Throws InputError for a value that cannot be quoted there (control
// characters never can), and for a name that is not in `values`.
std::string fill_in(const std::string& text, const std::map<std::string, std::string>& values,
                    const std::string& file);

enum class TaskState { waiting, running, ended };

// Answer of the batch system about a job's name.
struct QueryAnswer {
  std::vector<std::string> jobs;  // their numbers; several if a job was submitted twice
  std::map<int, TaskState> tasks;
  // True if the task waits or runs. A task that is not listed has ended or was never there.
  bool alive(int task) const;
};

struct JobTaken {
  std::string job;  // number of the job
};
struct JobRefused {  // the job does not exist and will not
  std::string complaint;
};
struct JobUnknown {  // the answer was lost; the job may exist
  std::string complaint;
};
using Submission = std::variant<JobTaken, JobRefused, JobUnknown>;

// Submits the job. After a failure the batch system is asked for the job's name, as the job may exist.
Submission submit_job(const fs::path& folder, const std::string& name,
                      const std::vector<std::string>& options);
// Returns nothing if there is no complete answer; `why` says why. It then says nothing about any task.
std::optional<QueryAnswer> query_job(const fs::path& folder, const std::string& name, std::string& why);
// Returns false if the command failed.
bool cancel_job(const fs::path& folder, const std::string& name, std::string& why);
// Returns how many tasks a job may have; `otherwise` if the batch system does not say.
int largest_array(const BatchTemplate& scripts, int otherwise);

// The files in templates/, which are compiled in: templates/slurm/job.sh is "slurm-job".
const std::map<std::string, std::string>& built_in_templates();
// Returns the text of a built-in file, or the list of their names for "". Throws InputError for any other
// name.
std::string template_text(const std::string& name);

}  // namespace peclet::runner
