// Verbs that look at a campaign and change nothing.
#include <memory>

#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void add_status(VerbSet& verbs) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* const verb = verbs.add("status", "Show how far every point is, also while it runs",
                                   "peclet status flow-curve.json --check");
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_flag("--json", options->json, "For programs");
  verb->add_flag(
      "--check", options->check,
      "Leave with 0 (every point converged), 3 (decided, but not all converged), 4 (not finished) or "
      "6 (suspect)");
  verbs.choose(verb, options);
}

void add_watch(VerbSet& verbs) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* const verb =
      verbs.add("watch", "Show the status in a terminal, kept up to date", "peclet watch flow-curve.json");
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  add_number(verb, "--interval", options->interval_seconds, number_from(0.1, 86'400), "Seconds between looks")
      ->type_name("SECONDS")
      ->capture_default_str();
  verbs.choose(verb, options);
}

void add_explain(VerbSet& verbs) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* const verb = verbs.add("explain", "Say why points are where they are, and what comes next",
                                   "peclet explain flow-curve.json peclet=10");
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->point,
                   "Label of a point, its values alone, or 4 or more digits of its hash; all unless given")
      ->type_name("POINT");
  add_directory(verb, options->directory);
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options);
}

void add_export(VerbSet& verbs) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* const verb = verbs.add("export", "Print the results for programs to read",
                                   "peclet export flow-curve.json --csv --output flow-curve.csv");
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  CLI::Option* const json = verb->add_flag_callback(
      "--json", [options] { options->format = ExportFormat::json; },
      "Everything, seed by seed (the default)");
  CLI::Option* const csv = verb->add_flag_callback(
      "--csv", [options] { options->format = ExportFormat::csv; },
      "One row per point, with the mean of every scalar");
  csv->excludes(json);
  verb->add_flag_callback(
          "--long", [options] { options->format = ExportFormat::long_csv; },
          "CSV with one row per point, quantity and element: profiles and distributions, too")
      ->excludes(json)
      ->excludes(csv);
  verb->add_flag("--canonical", options->canonical,
                 "Only what depends on campaign, seeds and engine: equal runs give equal bytes");
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options);
}

void add_results(VerbSet& verbs) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* const verb = verbs.add("results", "Print every stored result whole, one JSON object a line",
                                   "peclet results flow-curve.json peclet=10 > runs.jsonl");
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->point,
                   "Label of a point, or 4 or more digits of its hash; all unless given")
      ->type_name("POINT");
  add_directory(verb, options->directory);
  verb->add_option("--seed", options->seed, "Of this seed only")
      ->type_name("SEED")
      ->check(CLI::NonNegativeNumber);
  verbs.choose(verb, options);
}

void add_report(VerbSet& verbs) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* const verb =
      verbs.add("report", "Make one HTML page of a campaign, for a colleague or a notebook",
                "peclet report flow-curve.json --output flow-curve.html");
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options);
}

}  // namespace

void add_looking_verbs(VerbSet& verbs) {
  add_status(verbs);
  add_watch(verbs);
  add_explain(verbs);
  add_export(verbs);
  add_results(verbs);
  add_report(verbs);
}

}  // namespace peclet::runner
