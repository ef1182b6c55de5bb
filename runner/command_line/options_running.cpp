// Verbs that set a campaign up and run it.
#include <memory>

#include "runner/command_line/verb_set.h"
#include "runner/verbs/plan_campaign.h"

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
      verbs.add("init", "Write a small campaign to begin with", "peclet init flow-curve.json");
  verb->add_option("campaign", options->campaign, "Campaign file (JSON) that is not there yet")
      ->required()
      ->type_name(value_name::campaign_file);
  verbs.choose(verb, options);
}

void add_validate(VerbSet& verbs) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* const verb = verbs.add("validate", "Check a campaign and all its scenes; writes nothing",
                                   "peclet validate flow-curve.json");
  add_file(verb, options->campaign);
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options);
}

void add_plan(VerbSet& verbs) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* const verb = verbs.add(
      "plan", "Say how much work a campaign is: seeds, hours, finish; writes nothing without --pilot",
      "peclet plan flow-curve.json --pilot 4 --workers 8");
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
  verbs.choose(verb, options);
}

void add_run(VerbSet& verbs) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* const verb =
      verbs.add("run", "Run a campaign until every point is decided; go on with one that was stopped",
                "peclet run flow-curve.json --workers 8");
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
  add_accept_engine(verb, options->accept_engine);
  verb->add_flag("--quiet", options->quiet, "No progress on stderr");
  verb->add_flag("--force", options->force, "Use a network file system all the same, at your own risk");
  verbs.choose(verb, options);
}

}  // namespace

void add_running_verbs(VerbSet& verbs) {
  add_init(verbs);
  add_validate(verbs);
  add_plan(verbs);
  add_run(verbs);
}

}  // namespace peclet::runner
