// Verbs that set a campaign up, run it, change what it is to do, hand its seeds over and keep it safe.
#include "runner/batch/batch_task.h"
#include "runner/campaign/campaign.h"
#include "runner/command_line/ask_owner.h"
#include "runner/command_line/hand_over.h"
#include "runner/command_line/init.h"
#include "runner/command_line/print.h"
#include "runner/command_line/run.h"
#include "runner/command_line/validate.h"
#include "runner/command_line/verb_set.h"
#include "runner/launch/launched_worker.h"
#include "runner/maintenance/backup.h"
#include "runner/maintenance/doctor.h"

namespace peclet::runner {
namespace {

void add_device(CLI::App* verb, std::string& device) {
  add_option(verb, "--device", device,
             "Whether engines compute on a graphics card, where they can: PECLET_DEVICE of the engine, which "
             "`none` unsets")
      ->check(CLI::IsMember({"auto", "cuda", "none"}));
}

void add_team(CLI::App* verb, RunOptions& run) {
  add_device(verb, run.device);
  add_number(verb, "--workers", run.workers, whole_number(1, 100'000),
             "Engine processes; unless given, one for each card that --device finds, else cores / threads");
  add_number(verb, "--threads", run.threads, whole_number(1, 4096),
             "Threads of each; unless given, cores / workers if --workers is given, else 1");
}

void add_file_of_hosts(CLI::App* verb, std::filesystem::path& hosts) {
  add_option(
      verb, "--hosts FILE", hosts,
      "File with a host on each line, as node1 slots=8: that many workers there, started by ssh or the "
      "command of --launch");
}

void add_init(VerbSet& verbs) {
  const auto [verb, options] =
      verbs.add<InitOptions>(init_campaign, "init", "Write a campaign to begin with", {0, 1, 2}, R"(
The file is a complete campaign that runs in seconds to three minutes: an example of what the programs can do.
Its first lines say what to change and how to draw the results. Adapt it to your question; `peclet validate`
says what is wrong with it.

  peclet init --list
  peclet init thickening.json --example thickening
)");
  CLI::Option* const file = add_option(verb, "campaign FILE.json", options->campaign,
                                       "Campaign file (JSON) to write; must not exist");
  add_option(verb, "--example NAME", options->example, "Example to begin with")->capture_default_str();
  verb->add_flag("--list", options->list, "List the examples, and write nothing")->excludes(file);
}

void add_validate(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ValidateOptions>(
      validate_campaign, "validate", "Check a campaign and all its scenes; writes nothing", {0, 1, 2}, R"(
Reads the campaign and asks its engine about the scene of every point: the groups that follow from it, the
time step, and warnings. The first fault is named with its place in the file, its value and what is allowed.
A target that results will not have is a fault, too. The file may be a pipe.

  peclet validate flow-curve.json
  # the output of a program
  peclet validate <(my-generator)
  # the time steps alone
  peclet validate flow-curve.json --json | jq '.points[].timestep'
)");
  add_file(verb, options->campaign);
  add_json(verb, options->json);
}

void add_plan(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<PlanOptions>(
      plan_campaign, "plan",
      "Estimate the work of a campaign: seeds, hours, finish; writes nothing without --pilot",
      {0, 1, 2, 5, 6, 75}, R"(
The work is counted in particle-steps, from the fewest seeds that a point may take to the most; in processor
time, too, if realisations have been run before. Otherwise a realisation of the point with the median work
is tried for two seconds in a temporary folder, or one of another point if that jams. The table then says
that its times are a guess.

  peclet plan flow-curve.json --pilot 4 --workers 8
)");
  add_campaign_file(verb, options->run);
  add_number(verb, "--pilot", options->pilot, whole_number(2, 1'000'000),
             "Run the first seeds of every point, 4 unless given, which takes as long as they do, and store "
             "predictions from them, which `status` compares with the outcome; later runs count these seeds")
      ->expected(0, 1)
      ->default_str("4");
  add_team(verb, options->run);
  verb->add_flag("--quiet", options->run.quiet, "No progress on stderr");
  verb->add_flag("--force", options->run.force, "Use a network file system all the same, at your own risk");
  add_json(verb, options->json);
}

void add_run(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<RunOptions>(
      run_campaign, "run", "Run a campaign until every point is decided; resume one that was stopped",
      {0, 1, 2, 3, 5, 6, 75}, R"(
Runs seeds of every point until the interval of its mean is within the tolerance, or all seeds that are
allowed have ended. The same command resumes a campaign that was stopped or killed, and takes over changes
of its file; seeds that have ended are not run again.

Ctrl-C (or SIGTERM) lets the workers write checkpoints and stop; a second one stops them at once. Either way
the exit code is 75 and the campaign can be resumed. Progress goes to standard error, the table at the end
to standard output. With --jsonl, events are printed instead, which schema/README.md describes.

  peclet run flow-curve.json --workers 8
  # 64 workers on the nodes of this Slurm job
  peclet run flow-curve.json --launch 'srun --exact --mem=0 -N1 -n1 -c{threads}' --workers 64
  # on other machines, by ssh
  peclet run flow-curve.json --hosts hosts.txt
  # for eight hours; the same command resumes it tomorrow
  peclet run flow-curve.json --time-limit 28800
  # follow it with a program
  peclet run flow-curve.json --jsonl | jq -r 'select(.event == "decided") | .point.label'
  # send a mail when it ends
  peclet run flow-curve.json --notify 'echo "$PECLET_SUMMARY" | mail -s peclet me@example.org'
)");
  add_campaign_file(verb, *options);
  add_team(verb, *options);
  add_option(verb, "--launch COMMAND", options->launch,
             "Shell command that starts a program on another machine; each worker is started through it. "
             "{threads} and, with --hosts, {host} are replaced");
  add_file_of_hosts(verb, options->hosts);
  add_number(verb, "--time-limit SECONDS", options->time_limit, number_above(0),
             "Seconds after which workers checkpoint and stop");
  add_number(
      verb, "--budget", options->budget_hours, number_above(0),
      "Hours of processor time that this run may spend, on seeds that lower the summed relative error most");
  add_seconds(verb, "--lease", options->lease_seconds,
              "Seconds without a new step after which a worker counts as hung");
  add_seconds(verb, "--checkpoint", options->checkpoint_seconds,
              "Seconds between checkpoints of a realisation");
  add_seconds(verb, "--backup", options->backup_seconds, "Seconds between backups of the database");
  verb->add_flag("--jsonl", options->jsonl,
                 "Print events as JSON on standard output, one object per line, instead of the table");
  add_option(verb, "--notify COMMAND", options->notify,
             "Shell command to run at the end, except after a faulty file or if another process owns the "
             "campaign; its variables are PECLET_SUMMARY, PECLET_EXIT_CODE, PECLET_CAMPAIGN and "
             "PECLET_DIRECTORY");
  add_accept_engine(verb, options->accept_engine);
  verb->add_flag("--quiet", options->quiet, "No progress on stderr");
  verb->add_flag("--force", options->force, "Use a network file system all the same, at your own risk");
}

}  // namespace

void add_running_verbs(VerbSet& verbs) {
  add_init(verbs);
  add_validate(verbs);
  add_plan(verbs);
  add_run(verbs);
}

// Verbs that change what a campaign is to do.

namespace {

void add_patience(CLI::App* verb, double& seconds) {
  add_number(verb, "--wait SECONDS", seconds, number_from(0),
             "Seconds to wait for the process that runs the campaign; 0: not at all")
      ->capture_default_str();
}

void add_set(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<SetOptions>(
      set_campaign, "set", "Change target, points or priorities of a campaign, also while it runs",
      {0, 1, 2, 4, 6}, R"(
Changes the target, the numbers of seeds or priorities. The values are changed in the campaign file, every
other byte of which stays, and the campaign takes the file over. Without options the campaign takes the file
over as it is, for example with points that were added to the sweep. A running campaign does so within
seconds, and this verb waits for it. If points of a finished campaign are no longer decided, `peclet run`
continues them.

  peclet set flow-curve.json --tolerance 0.03 --maximum 2000
  # take over a file that was edited
  peclet set flow-curve.json
  # this point first
  peclet set flow-curve.json --point peclet=10 --priority 1
)");
  add_campaign_file(verb, *options);
  add_number(verb, "--tolerance", options->tolerance, *campaign_keys().find("/target/relative_tolerance"),
             "/target/relative_tolerance, also that of a curve: 0.05 or 5%");
  add_number(verb, "--absolute-tolerance", options->absolute_tolerance,
             *campaign_keys().find("/target/absolute_tolerance"),
             "/target/absolute_tolerance, where the campaign has that");
  add_number(verb, "--confidence", options->confidence, *campaign_keys().find("/target/confidence"),
             "/target/confidence");
  add_number(verb, "--minimum", options->minimum, *campaign_keys().find("/realisations/minimum"),
             "/realisations/minimum: seeds before the first stop test");
  add_number(verb, "--maximum", options->maximum, *campaign_keys().find("/realisations/maximum"),
             "/realisations/maximum: seeds after which a point is capped");
  add_number(verb, "--realisations", options->realisations, whole_number(1, most_realisations),
             "/realisations, where their number is fixed: seeds of every point");
  add_option(verb, "--keep-files", options->keep_files,
             "/keep_files: all, none, or the number of first seeds of each point whose files are kept");
  add_option(verb, "--point", options->points, "Point that gets the priority; may be repeated")
      ->allow_extra_args(false);
  add_number(verb, "--priority", options->priority, whole_number(-1'000'000, 1'000'000),
             "Priority of these points; higher ones get seeds first; 0 unless set");
  add_patience(verb, options->patience);
}

void add_cancel(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<CancelOptions>(
      cancel_points, "cancel", "Give points no more seeds, also while the campaign runs", {0, 1, 2, 4, 6}, R"(
The points get no more seeds, and the campaign does not wait for them. Running seeds save a checkpoint and
stop. Results are kept and shown.

  peclet cancel flow-curve.json peclet=10
  # give it seeds again
  peclet cancel flow-curve.json peclet=10 --undo
)");
  add_campaign(verb, *options);
  add_option(verb, "point", options->points,
             "Labels of points, their values alone, or 4 or more digits of their hashes")
      ->required();
  verb->add_flag("--undo", options->undo, "Give the points seeds again");
  add_patience(verb, options->patience);
}

void add_retry(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<RetryOptions>(
      retry_seeds, "retry", "Queue seeds again that were given up, with a clean record", {0, 1, 2, 4, 6}, R"(
Seeds are given up after three failures of their own: crashes, or no progress. A realisation that the engine
itself reported as failed (an overlap, a step too large) would fail again, and is not retried.

  peclet retry flow-curve.json peclet=10 --seed 17
)");
  add_campaign(verb, *options);
  add_option(verb, "point", options->points,
             "Labels of points, their values alone, or 4 or more digits of their hashes; all unless given");
  add_number(verb, "--seed", options->seeds, whole_number(0, 2'147'483'647),
             "Seed of the one point that is named; may be repeated; all seeds unless given")
      ->allow_extra_args(false);
  add_patience(verb, options->patience);
}

// Verbs that keep a campaign safe and sound.

void add_backup(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<BackupOptions>(
      backup_campaign, "backup", "Copy a campaign's database and files, checked, also while it runs",
      {0, 1, 2, 6}, R"(
`peclet run` makes such backups by itself; this verb makes one now, or in another place. The copy is checked
before it replaces the previous one. Only the last folder of the path is created, so that an unmounted disk
is an error and not a copy on another disk. The verb says so if the copy is on the campaign's own file
system.

  peclet backup flow-curve.json /mnt/usb/flow-curve --checkpoints
)");
  add_campaign(verb, *options);
  add_option(verb, "target FOLDER", options->target,
             "Folder for backup.db, in a folder that must exist; the previous backup there becomes "
             "backup.previous.db; the campaign's own backup/ unless given");
  verb->add_flag("--checkpoints", options->checkpoints,
                 "Also copy checkpoints and results that are not stored yet, so that running seeds need not "
                 "start again");
  add_json(verb, options->json);
}

void add_restore(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<RestoreOptions>(
      restore_campaign, "restore",
      "Put a backup in the place of a lost or damaged database, here or elsewhere", {0, 1, 2, 5, 6}, R"(
The database that was there is set aside. `peclet run` then continues the campaign to the same results.

  peclet restore /mnt/usb/flow-curve flow-curve.json
)");
  add_option(verb, "backup FILE", options->backup, "Folder of backups, or one file")->required();
  add_option(verb, "campaign CAMPAIGN", options->campaign,
             "Campaign file or .peclet folder; the folder is created if it does not exist")
      ->required();
  add_directory(verb, options->directory);
  verb->add_flag(
      "--force", options->force,
      "Also replace a sound database that is as new, or that of another campaign; it is set aside");
}

void add_doctor(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<DoctorOptions>(
      examine_campaign, "doctor", "Examine a campaign: database, files, processes, clock and disk",
      {0, 1, 2, 5, 6},
      R"(
Names each fault with its severity and its cure. Without --repair nothing is changed. With it, among other
things, checkpoints of seeds that no point needs any more are removed; these seeds start again if the
tolerance is tightened.

  peclet doctor flow-curve.json --repair
)");
  add_campaign(verb, *options);
  verb->add_flag("--repair", options->repair, "Do the safe repairs that are named as cures");
  add_json(verb, options->json);
}

// Verbs for seeds that run elsewhere, under a batch system.

void add_hand_over(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<HandOverOptions>(
      hand_over_campaign, "hand-over",
      "Give seeds to a batch system: job arrays that need no database and no daemon", {0, 1, 2, 3, 5, 6, 75},
      R"(
Turns the seeds that the next stop tests need into job arrays. The database stays on this machine; nodes see
the folder --shared and the two programs. Without --follow it hands over once, and `peclet ingest` takes in
what has been done. The results are the same, byte for byte, as those of `peclet run`.

If the batch system refuses a job, its seeds stay here and the exit code is 1. If its answer is lost, the
seeds count as handed over until a job of that name has been looked for.

  peclet hand-over slurm flow-curve.json --shared /scratch/me/flow-curve --follow \
           --option=--partition=short --option=--time=4:00:00
)");
  add_option(verb, "system SYSTEM", options->system, "slurm, pbs or lsf; with --template any name")
      ->required();
  add_campaign_file(verb, *options);
  add_option(verb, "--shared FOLDER", options->shared,
             "Folder that this machine and the nodes see in the same place; the one used last unless given");
  add_number(verb, "--seeds-per-task", options->seeds_per_task, whole_number(1, 100'000),
             "Seeds that one task runs, as many at once as the engine can")
      ->capture_default_str();
  add_number(verb, "--largest-array", options->largest_array, whole_number(1, 1'000'000),
             "Tasks of one job at most; what the batch system allows unless given");
  add_number(verb, "--threads", options->threads, whole_number(1, 4096), "Threads of each engine")
      ->capture_default_str();
  add_option(verb, "--option WORD", options->options, "Word for the submit command (sbatch, qsub, bsub)");
  add_device(verb, options->device);
  add_option(verb, "--template FOLDER", options->template_folder,
             "Folder with other scripts: job.sh, submit.sh, query.sh, cancel.sh, largest.sh, or some of them")
      ->check(CLI::ExistingDirectory);
  verb->add_flag("--ahead", options->ahead, "Hand over the seeds of the stop test after the next one, too");
  verb->add_flag("--follow", options->follow,
                 "Take results in and hand over what the next stop tests need, until every point is decided");
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
}

void add_ingest(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<IngestOptions>(
      ingest_campaign, "ingest", "Take in what a batch system has done with the seeds it was given",
      {0, 1, 2, 5, 6}, R"(
Takes results, failures and preempted tasks in from the folder that is shared with the nodes, and hands
nothing over.

Seeds of which nothing is known (their folder is gone, or the batch system does not answer) stay handed
over, because they may be running. --forget gives up a bundle of them, by the name that `peclet ingest`
prints. The exit code is 1 while the folder of seeds that are out does not exist.

  peclet ingest flow-curve.json
  # end the jobs; `peclet run` can run their seeds
  peclet ingest flow-curve.json --cancel
  # its folder is gone, and so are its jobs
  peclet ingest flow-curve.json --forget flow-curve-1a2b3c-0001
)");
  add_campaign_file(verb, *options);
  verb->add_flag("--cancel", options->cancel, "End the jobs and take their seeds back");
  add_option(verb, "--forget BUNDLE", options->forget,
             "Queue the seeds of this bundle again although nothing is known of them; results that still "
             "arrive count once")
      ->allow_extra_args(false)  // a campaign's file may follow
      ->excludes("--cancel");
  verb->add_flag("--quiet", options->quiet, "No notes on stderr");
  verb->add_flag("--force", options->force, "Use a network file system for the database all the same");
}

void add_task(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<TaskOptions>(
      run_task, "task", "Run one task of a bundle; what job scripts call on a node", {0, 1, 2, 6, 75}, R"(
Runs the seeds of the task, except those that have ended already, as many at once as the engine can. SIGTERM, SIGINT and
SIGUSR1 make the engine save a checkpoint and exit.

  peclet task /scratch/me/flow-curve/bundles/NAME/manifest.json 7
)");
  add_option(verb, "manifest FILE.json", options->manifest, "The bundle's manifest.json")->required();
  add_number(verb, "index", options->index, whole_number(0, 1e9), "Number of the task, from 0")->required();
}

void add_template(VerbSet& verbs) {
  const auto [verb, name] = verbs.add<std::string>(
      template_text, "template", "Print a script for a batch system, to be used or changed", {0, 2}, R"(
Without a name it lists the scripts. `slurm-nodes` runs a campaign in one job of Slurm, on one node or several.
The others, as `slurm-job` and `slurm-submit`, are those of hand-over; a folder with changed ones goes behind
its option --template.

  peclet template slurm-nodes > nodes.sh
  sbatch --job-name=friction --nodes=3 nodes.sh friction.json
  # hand-over with another job script
  peclet template pbs-job > my-site/job.sh
  peclet hand-over pbs friction.json --template my-site --shared /scratch/me/friction
)");
  add_option(verb, "name NAME", *name, "Name of a script");
}

void add_worker(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<WorkerOptions>(
      run_worker, "worker", "Be a worker of a campaign on another machine; what `peclet run --launch` calls",
      {0, 1, 2}, R"(
Without options it is the end on the other machine: it starts the engine that the frames on standard input
name, and carries files in both directions. With --through it is the end beside the owner.

  # whether a launcher works: this prints a frame that begins with PCF1
  ssh node1 /usr/local/bin/peclet worker </dev/null | head -c 60
)");
  add_option(verb, "--through COMMAND", options->through, "Shell command that starts the other end");
  add_number(verb, "--silence SECONDS", options->silence_seconds, number_above(0),
             "Seconds without a frame after which the other end counts as lost")
      ->capture_default_str();
  add_option(verb, "engine", options->engine,
             "Program of the engine and its arguments, on the other machine");
}

}  // namespace

void add_changing_verbs(VerbSet& verbs) {
  add_set(verbs);
  add_cancel(verbs);
  add_retry(verbs);
  add_hand_over(verbs);
  add_ingest(verbs);
  add_task(verbs);
  add_template(verbs);
  add_worker(verbs);
  add_backup(verbs);
  add_restore(verbs);
  add_doctor(verbs);
}

}  // namespace peclet::runner
