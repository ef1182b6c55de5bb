// Verbs that change what a campaign is to do.
#include <memory>

#include "runner/campaign/campaign.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/verbs/cancel.h"
#include "runner/verbs/retry.h"
#include "runner/verbs/set.h"

namespace peclet::runner {
namespace {

void add_patience(CLI::App* verb, double& seconds) {
  add_number(verb, "--wait", seconds, number_from(0),
             "Seconds to wait for the process that runs the campaign; 0: not at all")
      ->type_name("SECONDS")
      ->capture_default_str();
}

int tell(const Reply& reply) {
  print(reply.text);
  return reply.exit_code;
}

void add_set(VerbSet& verbs) {
  const auto options = std::make_shared<SetOptions>();
  CLI::App* const verb =
      verbs.add("set", "Change target, points or priorities of a campaign, also while it runs",
                "peclet set flow-curve.json --tolerance 0.03 --maximum 2000",
                page(R"(
Changes target, numbers of seeds or priorities. The values are changed in the campaign's file, of which every
other byte stays, and the campaign takes the file over as it is; without options it does only that, with
points that you have added to the sweep, for instance. A running campaign does so within seconds, and this
verb waits for it; points of a finished one that are no longer decided go on with `peclet run`.
)",
                     {{"peclet set flow-curve.json", "take over a file that was edited"},
                      {"peclet set flow-curve.json --point peclet=10 --priority 1", "this point first"}},
                     {0, 1, 2, 4, 6}));
  add_file(verb, options->campaign);
  add_directory(verb, options->directory);
  add_number(verb, "--tolerance", options->tolerance, *campaign_keys().find("/target/relative_tolerance"),
             "/target/relative_tolerance: 0.05 or 5%");
  add_number(verb, "--absolute-tolerance", options->absolute_tolerance,
             *campaign_keys().find("/target/absolute_tolerance"),
             "/target/absolute_tolerance, where the campaign has that");
  add_number(verb, "--confidence", options->confidence, *campaign_keys().find("/target/confidence"),
             "/target/confidence");
  add_number(verb, "--minimum", options->minimum, *campaign_keys().find("/realisations/minimum"),
             "/realisations/minimum: seeds before the first look");
  add_number(verb, "--maximum", options->maximum, *campaign_keys().find("/realisations/maximum"),
             "/realisations/maximum: seeds after which a point is capped");
  add_number(verb, "--realisations", options->realisations, whole_number(1, most_realisations),
             "/realisations, where their number is fixed: seeds of every point");
  verb->add_option("--keep-files", options->keep_files,
                   "/keep_files: all, none, or of how many first seeds of each point files are kept");
  verb->add_option("--point", options->points, "Point that is to have the priority; may be repeated")
      ->allow_extra_args(false);
  add_number(verb, "--priority", options->priority, whole_number(-1'000'000, 1'000'000),
             "Points of a higher one are served first; 0 unless set");
  add_patience(verb, options->patience);
  verbs.choose(verb, options, [](const SetOptions& given) { return tell(set_campaign(given)); });
}

void add_cancel(VerbSet& verbs) {
  const auto options = std::make_shared<CancelOptions>();
  CLI::App* const verb = verbs.add(
      "cancel", "Give points no more seeds, also while the campaign runs",
      "peclet cancel flow-curve.json peclet=10",
      page(R"(
The points get no more seeds and hold nothing up; seeds that run are saved and put back. What has been done
is kept and shown.
)",
           {{"peclet cancel flow-curve.json peclet=10 --undo", "take it up again"}}, {0, 1, 2, 4, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->points,
                   "Labels of points, their values alone, or 4 or more digits of their hashes")
      ->required();
  add_directory(verb, options->directory);
  verb->add_flag("--undo", options->undo, "Take them up again");
  add_patience(verb, options->patience);
  verbs.choose(verb, options, [](const CancelOptions& given) { return tell(cancel_points(given)); });
}

void add_retry(VerbSet& verbs) {
  const auto options = std::make_shared<RetryOptions>();
  CLI::App* const verb = verbs.add("retry", "Queue seeds again that were given up, with a clean record",
                                   "peclet retry flow-curve.json peclet=10 --seed 17",
                                   page(R"(
Seeds are given up after three failures that were their own: crashes, or no progress. What the engine itself
called failed (an overlap, a step too large) would fail again, and is not retried.
)",
                                        {}, {0, 1, 2, 4, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option(
      "point", options->points,
      "Labels of points, their values alone, or 4 or more digits of their hashes; all unless given");
  add_directory(verb, options->directory);
  add_number(verb, "--seed", options->seeds, whole_number(0, 2'147'483'647),
             "Of the one point that is named; may be repeated; all unless given")
      ->allow_extra_args(false);
  add_patience(verb, options->patience);
  verbs.choose(verb, options, [](const RetryOptions& given) { return tell(retry_seeds(given)); });
}

}  // namespace

void add_changing_verbs(VerbSet& verbs) {
  add_set(verbs);
  add_cancel(verbs);
  add_retry(verbs);
}

}  // namespace peclet::runner
