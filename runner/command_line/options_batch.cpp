// Verbs for seeds that run elsewhere, under a batch system.
#include <memory>

#include "runner/batch/batch_task.h"
#include "runner/command_line/verb_set.h"
#include "runner/verbs/hand_over.h"

namespace peclet::runner {
namespace {

void add_hand_over(VerbSet& verbs) {
  const auto options = std::make_shared<HandOverOptions>();
  CLI::App* const verb =
      verbs.add("hand-over", "Give seeds to a batch system: job arrays that need no database and no daemon",
                "peclet hand-over slurm flow-curve.json --shared /scratch/me/flow-curve --follow \\\n"
                "           --option=--partition=short --option=--time=4:00:00",
                page(R"(
Turns the seeds that the next looks need into job arrays. The database stays on this machine; nodes see
the folder --shared and the two programs. Without --follow it hands over once, and `peclet ingest` takes
in what has been done. The answer is the same, byte for byte, as that of `peclet run`.

When the batch system refuses a job, its seeds stay here and the exit code is 1. When it is not known whether it has
taken one, the seeds are out until a job of that name has been looked for.
)",
                     {}, {0, 1, 2, 3, 5, 6, 75}));
  verb->add_option("system", options->system, "slurm; with --template any name")
      ->required()
      ->type_name("SYSTEM");
  add_file(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_option("--shared", options->shared,
                   "Folder that this machine and the nodes see in the same place; that of the last time "
                   "unless given")
      ->type_name(value_name::folder);
  add_number(verb, "--seeds-per-task", options->seeds_per_task, whole_number(1, 100'000),
             "Seeds that one task runs, one after another")
      ->capture_default_str();
  add_number(verb, "--largest-array", options->largest_array, whole_number(1, 1'000'000),
             "Tasks of one job at most; what the batch system allows unless given");
  add_number(verb, "--threads", options->threads, whole_number(1, 4096), "Threads of each engine")
      ->capture_default_str();
  verb->add_option("--option", options->options, "Word for the submit command (sbatch)")->type_name("WORD");
  verb->add_option("--template", options->template_folder,
                   "Folder with job.sh and the commands, for other sites")
      ->type_name(value_name::folder)
      ->check(CLI::ExistingDirectory);
  verb->add_flag("--ahead", options->ahead, "Hand over the seeds of the look after the next one, too");
  verb->add_flag("--follow", options->follow,
                 "Take results in and hand over what the next looks need, until every point is decided");
  add_seconds(verb, "--interval", options->interval, "Seconds between two turns of --follow");
  add_seconds(verb, "--backup", options->backup_seconds,
              "Seconds between backups of the database, with --follow");
  add_seconds(verb, "--lease", options->lease_seconds,
              "Seconds without a new step after which an engine counts as hung");
  add_seconds(verb, "--checkpoint", options->checkpoint_seconds,
              "Seconds between checkpoints of a realisation");
  add_accept_engine(verb, options->accept_engine);
  verb->add_flag("--dry-run", options->dry_run, "Say what would be handed over; submit nothing");
  verb->add_flag("--quiet", options->quiet, "No progress on stderr");
  verb->add_flag("--force", options->force, "Use a network file system for the database all the same");
  verbs.choose(verb, options, hand_over_campaign);
}

void add_ingest(VerbSet& verbs) {
  const auto options = std::make_shared<IngestOptions>();
  CLI::App* const verb = verbs.add(
      "ingest", "Take in what a batch system has done with the seeds it was given",
      "peclet ingest flow-curve.json",
      page(R"(
Takes results, failures and preempted tasks in from the folder that is shared with the nodes, and hands
nothing over.

Seeds of which nobody knows anything (their folder is gone, the batch system does not answer) stay out, because
they may be running. --forget gives a bundle of them up by the name that `peclet ingest` prints. The exit code is 1
while the folder of seeds that are out is not there.
)",
           {{"peclet ingest flow-curve.json --cancel", "end the jobs; `peclet run` can have their seeds"},
            {"peclet ingest flow-curve.json --forget flow-curve-1a2b3c-0001",
             "its folder is gone, and so are its jobs"}},
           {0, 1, 2, 5, 6}));
  add_file(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_flag("--cancel", options->cancel, "End the jobs and take their seeds back");
  verb->add_option(
          "--forget", options->forget,
          "Queue the seeds of this bundle again though nobody answers for it; results that come all the "
          "same count once")
      ->type_name("BUNDLE")
      ->allow_extra_args(false)  // a campaign's file may follow
      ->excludes("--cancel");
  verb->add_flag("--quiet", options->quiet, "No notes on stderr");
  verb->add_flag("--force", options->force, "Use a network file system for the database all the same");
  verbs.choose(verb, options, ingest_campaign);
}

void add_task(VerbSet& verbs) {
  const auto options = std::make_shared<TaskOptions>();
  CLI::App* const verb = verbs.add("task", "Run one task of a bundle; what job scripts call on a node",
                                   "peclet task /scratch/me/flow-curve/bundles/NAME/manifest.json 7",
                                   page(R"(
Runs the seeds of the task one after another, those apart that have ended already. SIGTERM, SIGINT and
SIGUSR1 make the engine save a checkpoint and leave.
)",
                                        {}, {0, 1, 2, 6, 75}));
  verb->add_option("manifest", options->manifest, "The bundle's manifest.json")
      ->required()
      ->type_name(value_name::campaign_file);
  add_number(verb, "index", options->index, whole_number(0, 1e9), "Number of the task, from 0")->required();
  verbs.choose(verb, options, run_task);
}

}  // namespace

void add_batch_verbs(VerbSet& verbs) {
  add_hand_over(verbs);
  add_ingest(verbs);
  add_task(verbs);
}

}  // namespace peclet::runner
