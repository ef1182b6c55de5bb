// Verbs that change what a campaign is to do.
#include <memory>

#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void add_patience(CLI::App* verb, double& seconds) {
  add_number(verb, "--wait", seconds, number_from(0),
             "Seconds to wait for the process that runs the campaign; 0: not at all")
      ->type_name("SECONDS")
      ->capture_default_str();
}

void add_set(VerbSet& verbs) {
  const auto options = std::make_shared<SetOptions>();
  CLI::App* const verb =
      verbs.add("set", "Change target, points or priorities of a campaign, also while it runs",
                "peclet set flow-curve.json --tolerance 0.03 --maximum 2000");
  add_file(verb, options->campaign);
  add_directory(verb, options->directory);
  add_number(verb, "--tolerance", options->tolerance, *campaign_keys().find("/target/relative_tolerance"),
             "/target/relative_tolerance; 5 % is written 0.05");
  add_number(verb, "--absolute-tolerance", options->absolute_tolerance,
             *campaign_keys().find("/target/absolute_tolerance"),
             "/target/absolute_tolerance, where the campaign has that");
  add_number(verb, "--confidence", options->confidence, *campaign_keys().find("/target/confidence"),
             "/target/confidence");
  add_number(verb, "--minimum", options->minimum, *campaign_keys().find("/realisations/minimum"),
             "/realisations/minimum: seeds before the first look");
  add_number(verb, "--maximum", options->maximum, *campaign_keys().find("/realisations/maximum"),
             "/realisations/maximum: seeds after which a point is capped");
  verb->add_option("--keep-files", options->keep_files,
                   "/keep_files: all, none, or of how many first seeds of each point files are kept");
  verb->add_option("--point", options->points, "Point that is to have the priority; may be repeated")
      ->allow_extra_args(false);
  add_number(verb, "--priority", options->priority, whole_number(-1'000'000, 1'000'000),
             "Points of a higher one are served first; 0 unless set");
  add_patience(verb, options->patience);
  verbs.choose(verb, options);
}

void add_cancel(VerbSet& verbs) {
  const auto options = std::make_shared<CancelOptions>();
  CLI::App* const verb = verbs.add("cancel", "Give points no more seeds, also while the campaign runs",
                                   "peclet cancel flow-curve.json peclet=10");
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->points,
                   "Labels of points, their values alone, or 4 or more digits of their hashes")
      ->required();
  add_directory(verb, options->directory);
  verb->add_flag("--undo", options->undo, "Take them up again");
  add_patience(verb, options->patience);
  verbs.choose(verb, options);
}

void add_retry(VerbSet& verbs) {
  const auto options = std::make_shared<RetryOptions>();
  CLI::App* const verb = verbs.add("retry", "Queue seeds again that were given up, with a clean record",
                                   "peclet retry flow-curve.json peclet=10 --seed 17");
  add_file_or_folder(verb, options->campaign);
  verb->add_option(
      "point", options->points,
      "Labels of points, their values alone, or 4 or more digits of their hashes; all unless given");
  add_directory(verb, options->directory);
  add_number(verb, "--seed", options->seeds, whole_number(0, 2'147'483'647),
             "Of the one point that is named; may be repeated; all unless given")
      ->allow_extra_args(false);
  add_patience(verb, options->patience);
  verbs.choose(verb, options);
}

}  // namespace

void add_changing_verbs(VerbSet& verbs) {
  add_set(verbs);
  add_cancel(verbs);
  add_retry(verbs);
}

}  // namespace peclet::runner
