// Verbs that set a campaign up and run it.
#include <memory>

#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/verbs/init.h"
#include "runner/verbs/plan_campaign.h"
#include "runner/verbs/run.h"
#include "runner/verbs/validate.h"

namespace peclet::runner {
namespace {

void add_team(CLI::App* verb, RunOptions& run) {
  add_number(verb, "--workers", run.workers, whole_number(1, 100'000),
             "Engine processes; cores / threads unless given");
  add_number(verb, "--threads", run.threads, whole_number(1, 4096),
             "Threads of each; 1, or cores / workers, unless given");
}

void add_init(VerbSet& verbs) {
  const auto options = std::make_shared<InitOptions>();
  CLI::App* const verb =
      verbs.add("init", "Write a small campaign to begin with", "peclet init flow-curve.json",
                page(R"(
The file is a whole campaign that runs in minutes: 100 spheres with friction at three Péclet numbers.
Change it to what you want to know; `peclet validate` says what is wrong with it.
)",
                     {}, {0, 1, 2}));
  verb->add_option("campaign", options->campaign, "Campaign file (JSON) that is not there yet")
      ->required()
      ->type_name(value_name::campaign_file);
  verbs.choose(verb, options, [](const InitOptions& given) { print(init_campaign(given)); });
}

void add_validate(VerbSet& verbs) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* const verb = verbs.add(
      "validate", "Check a campaign and all its scenes; writes nothing", "peclet validate flow-curve.json",
      page(R"(
Reads the campaign and asks its engine about the scene of every point: the groups that follow from it,
the time step, and warnings. The first fault is named with its place in the file, its value and what is
allowed, a target that no result would have included. The file may be a pipe.
)",
           {{"peclet validate <(my-generator)", "what a program writes"},
            {"peclet validate flow-curve.json --json | jq '.points[].timestep'", "the time steps alone"}},
           {0, 1, 2}));
  add_file(verb, options->campaign);
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, [](const ValidateOptions& given) { print(validate_campaign(given)); });
}

void add_plan(VerbSet& verbs) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* const verb = verbs.add(
      "plan", "Say how much work a campaign is: seeds, hours, finish; writes nothing without --pilot",
      "peclet plan flow-curve.json --pilot 4 --workers 8",
      page(R"(
The work is counted in particle-steps, and in processor time where realisations have been run before:
from the fewest seeds that a point may take to the most. Where none has, one of the point in the middle is
tried for two seconds, in a temporary folder, or one of another point where that one jams, and the table says
that its times are a guess.
)",
           {}, {0, 1, 2, 5, 6, 75}));
  add_file(verb, options->run.campaign);
  add_directory(verb, options->run.directory);
  add_number(verb, "--pilot", options->pilot, whole_number(2, 1'000'000),
             "Run the first seeds of every point, 4 unless given, which count later as any others; "
             "predict from them, and store that for `status` to judge")
      ->expected(0, 1)
      ->default_str("4");
  add_team(verb, options->run);
  verb->add_flag("--quiet", options->run.quiet, "No progress on stderr");
  verb->add_flag("--force", options->run.force, "Use a network file system all the same, at your own risk");
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, plan_campaign);
}

void add_run(VerbSet& verbs) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* const verb = verbs.add(
      "run", "Run a campaign until every point is decided; go on with one that was stopped",
      "peclet run flow-curve.json --workers 8",
      page(R"(
Runs seeds of every point until the interval of its mean is within the tolerance, or all seeds that are
allowed have ended. The same command goes on with a campaign that was stopped or killed, and takes up
changes of its file; nothing that has finished is run again.

Ctrl-C (or SIGTERM) lets the workers write checkpoints and stop, a second one stops at once; either way
the exit code is 75 and the campaign can be resumed. Progress goes to standard error, the table at the
end to standard output; with --jsonl events take its place, which schema/README.md describes.
)",
           {{"peclet run flow-curve.json --time-limit 28800", "eight hours of it; the same again tomorrow"},
            {"peclet run flow-curve.json --jsonl | jq -r 'select(.event == \"decided\") | .point.label'",
             "follow it with a program"},
            {"peclet run flow-curve.json --notify 'echo \"$PECLET_SUMMARY\" | mail -s peclet me@example.org'",
             "and write to me when it ends"}},
           {0, 1, 2, 3, 5, 6, 75}));
  add_file(verb, options->campaign);
  add_directory(verb, options->directory);
  add_team(verb, *options);
  add_number(verb, "--time-limit", options->time_limit, number_above(0),
             "Seconds after which workers checkpoint and stop")
      ->type_name("SECONDS");
  add_number(verb, "--budget", options->budget_hours, number_above(0),
             "Hours of processor time that this run may spend, where they lower the summed relative "
             "error most");
  add_seconds(verb, "--lease", options->lease_seconds,
              "Seconds without a new step after which a worker counts as hung");
  add_seconds(verb, "--checkpoint", options->checkpoint_seconds,
              "Seconds between checkpoints of a realisation");
  add_seconds(verb, "--backup", options->backup_seconds, "Seconds between backups of the database");
  verb->add_flag("--jsonl", options->jsonl,
                 "What happens as JSON on standard output, one object a line, instead of the table");
  verb->add_option("--notify", options->notify,
                   "Command of the shell for the end, whatever ends the run but a faulty file or another "
                   "owner; told by PECLET_SUMMARY, PECLET_EXIT_CODE, PECLET_CAMPAIGN and PECLET_DIRECTORY")
      ->type_name("COMMAND");
  add_accept_engine(verb, options->accept_engine);
  verb->add_flag("--quiet", options->quiet, "No progress on stderr");
  verb->add_flag("--force", options->force, "Use a network file system all the same, at your own risk");
  verbs.choose(verb, options, run_campaign);
}

}  // namespace

void add_running_verbs(VerbSet& verbs) {
  add_init(verbs);
  add_validate(verbs);
  add_plan(verbs);
  add_run(verbs);
}

}  // namespace peclet::runner
