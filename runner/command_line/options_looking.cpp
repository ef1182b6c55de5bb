// Verbs that look at a campaign and change nothing.
#include <fmt/format.h>

#include <memory>

#include "contract/output_file.h"
#include "runner/archive/supplement.h"
#include "runner/command_line/open_to_look.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/page/page_html.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/results.h"
#include "runner/reports/status.h"
#include "runner/store/locks.h"
#include "runner/verbs/files.h"
#include "runner/verbs/serve.h"
#include "runner/verbs/watch.h"

namespace peclet::runner {
namespace {

int show_status(const StatusOptions& options) {
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  CampaignStatus status = read_status(open.database);
  status.owner = current_owner(open.directory);
  print(options.json ? status_json(status).dump(2) + '\n' : status_table(status) + workers_text(status));
  if (const std::string note = difference_from_file(options.campaign, options.directory, status.campaign);
      !note.empty()) {
    say(fmt::format("note: {}\n", note));
  }
  return options.check ? standing(status) : 0;
}

void add_status(VerbSet& verbs) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* const verb = verbs.add(
      "status", "Show how far every point is, also while it runs", "peclet status flow-curve.json --check",
      page(R"(
Shows the seeds that have ended, the mean and its standard error so far, the interval at the last look
and the verdict of every point. It only reads, and may be used at any time.
)",
           {{"peclet status flow-curve.json --json", "for programs; schema/README.md describes it"}},
           {0, 1, 2, 3, 4, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_flag("--json", options->json, "For programs");
  verb->add_flag(
      "--check", options->check,
      "Leave with 0 (every point converged or complete), 3 (decided, but not so), 4 (not finished) or "
      "6 (suspect)");
  verbs.choose(verb, options, show_status);
}

void add_watch(VerbSet& verbs) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* const verb =
      verbs.add("watch", "Show the status in a terminal, kept up to date", "peclet watch flow-curve.json",
                page(R"(
Ends when every point is decided, with the exit code that `status --check` would have, or at Ctrl-C,
which does nothing to the campaign. A campaign that has not been run yet is waited for. Where the terminal
has room, the mean so far is drawn over the swept parameter. Off a terminal the table is printed whenever
it changes.
)",
                     {}, {0, 1, 2, 3, 4, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  add_number(verb, "--interval", options->interval_seconds, number_from(0.1, 86'400), "Seconds between looks")
      ->type_name("SECONDS")
      ->capture_default_str();
  verbs.choose(verb, options, watch_campaign);
}

void show_explanation(const ExplainOptions& options) {
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  print(options.json ? explain_json(open.database, open.directory, options.point).dump(2) + '\n'
                     : explain(open.database, open.directory, options.point));
}

void add_explain(VerbSet& verbs) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* const verb = verbs.add("explain", "Say why points are where they are, and what comes next",
                                   "peclet explain flow-curve.json peclet=10",
                                   page(R"(
A point is named by its label (peclet=10 volume_fraction=0.5), by its values alone as in a row of the
tables ("10 0.5"), or by the beginning of its hash.

Lists the looks at a point, a bootstrap interval beside Student's, lost seeds with what their engines
said last, whether the window is long enough, and what would bring the point further.
)",
                                        {{"peclet explain flow-curve.peclet", "all points"}}, {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->point,
                   "Label of a point, its values alone, or 4 or more digits of its hash; all unless given")
      ->type_name("POINT");
  add_directory(verb, options->directory);
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, show_explanation);
}

void show_files(const FilesOptions& options) {
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  print(list_files(open.database, open.directory, options));
}

void add_files(VerbSet& verbs) {
  const auto options = std::make_shared<FilesOptions>();
  CLI::App* const verb = verbs.add("files", "List the files that realisations have left beside their results",
                                   "peclet files flow-curve.json peclet=10 --paths",
                                   page(R"(
A scene may ask its engine for files beside the numbers, as final.xyz of "files": {"final_configuration":
true}. They lie in the campaign's folder, named by point and seed; those that /keep_files throws away are
listed, and nothing is left of them.
)",
                                        {{"peclet-engine snapshot $(peclet files flow-curve.json 10 --paths "
                                          "| head -1) --output spheres.png",
                                          "draws what the first seed has left"},
                                         {"ovito $(peclet files flow-curve.json 10 --paths | head -1)", ""}},
                                        {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->point, "As of explain; all unless given")->type_name("POINT");
  add_directory(verb, options->directory);
  CLI::Option* const paths = verb->add_flag("--paths", options->paths, "The paths alone, a line each");
  verb->add_flag("--json", options->json, "For programs")->excludes(paths);
  verbs.choose(verb, options, show_files);
}

void export_campaign(const ExportOptions& options) {
  if (!options.bundle.empty()) {
    check_supplement_name(options.bundle);
    check_output(options.bundle);
    OpenCampaign whole = open_to_look(options.campaign, options.directory);
    deliver(supplement(whole.database, current_owner(whole.directory)), options.bundle, options.quiet);
    return;
  }
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  const auto text = [&] {
    switch (options.format) {
      case ExportFormat::json:
        return export_json(open.database, options.canonical);
      case ExportFormat::csv:
        return export_csv(open.database, options.canonical);
      case ExportFormat::long_csv:
        return export_long_csv(open.database);
    }
    return std::string();
  };
  deliver(text(), options.output, options.quiet);
}

void add_export(VerbSet& verbs) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* const verb = verbs.add(
      "export", "Print the results for programs to read",
      "peclet export flow-curve.json --csv --output flow-curve.csv",
      page(
          R"(
The canonical form holds what depends on campaign, seeds and engine alone, so that two runs of one
campaign can be compared byte by byte, however many workers they had and whatever killed them.
--output replaces a file whole, follows a link, writes to a device, a FIFO or /dev/stdout, and says on
standard error where it wrote, unless --quiet.

Estimates are of the seeds of each point's last look. --csv has a column for every scalar that was
measured, --long a row for every number, with names, units and axes as the engine gives them.

--bundle makes the supplement of a paper: campaign file, JSON and both kinds of CSV in canonical form, the
page of `report`, the figure of `plot` with its script, engines and versions, SHA-256 of each file, and a README
that says what is what and how to make it again. All files are of one state of the campaign, and a campaign at
rest gives the same bytes at any time.
)",
          {{"peclet export flow-curve.json --canonical | sha256sum", "one number for all results"},
           {"peclet export flow-curve.json --long --output all.csv", "profiles and distributions, too"},
           {"peclet export flow-curve.json --bundle flow-curve.tar.gz", "everything, for a paper's readers"}},
          {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  CLI::Option* const json = verb->add_flag_callback(
      "--json", [options] { options->format = ExportFormat::json; },
      "Everything, seed by seed (the default)");
  CLI::Option* const csv = verb->add_flag_callback(
      "--csv", [options] { options->format = ExportFormat::csv; },
      "One row per point, with the mean of every scalar");
  csv->excludes(json);
  CLI::Option* const in_long = verb->add_flag_callback(
      "--long", [options] { options->format = ExportFormat::long_csv; },
      "CSV with one row per point, quantity and element: profiles and distributions, too");
  in_long->excludes(json)->excludes(csv);
  CLI::Option* const canonical =
      verb->add_flag("--canonical", options->canonical,
                     "Only what depends on campaign, seeds and engine: equal runs give equal bytes");
  CLI::Option* const output =
      verb->add_option("--output", options->output,
                       "File to write, whole or not at all; standard output unless given")
          ->type_name(value_name::file);
  CLI::Option* const bundle = verb->add_option("--bundle", options->bundle,
                                               "All of it in one archive, for a paper's supplement: a file "
                                               "that ends in .tar.gz")
                                  ->type_name(value_name::file);
  for (CLI::Option* const other : {json, csv, in_long, canonical, output}) bundle->excludes(other);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options, export_campaign);
}

void print_results(const ResultsOptions& options) {
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  for_each_result_line(open.database, options.point, options.seed,
                       [](const std::string& line) { print(line + '\n'); });
}

void add_results(VerbSet& verbs) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* const verb = verbs.add(
      "results", "Print every stored result whole, one JSON object a line",
      "peclet results flow-curve.json peclet=10 > runs.jsonl",
      page(R"(
The database holds results deflated; this prints them as their engines wrote them, with blocks, costs and where
they come from, and with the point and whether its last look counts the seed ("deciding"). One that is surplus
must not enter a mean: which seeds end first depends on the machine. Also while the campaign runs.
)",
           {{"peclet results flow-curve.json | jq -c 'select(.deciding) | .result.mean.relative_viscosity'",
             "the values of all points, for R, Julia and others: schema/README.md"},
            {"peclet results flow-curve.json peclet=10 --seed 3 | jq .result", "one realisation"}},
           {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option("point", options->point,
                   "Label of a point, or 4 or more digits of its hash; all unless given")
      ->type_name("POINT");
  add_directory(verb, options->directory);
  verb->add_option("--seed", options->seed, "Of this seed only")
      ->type_name("SEED")
      ->check(CLI::NonNegativeNumber);
  verbs.choose(verb, options, print_results);
}

void write_report(const ReportOptions& options) {
  OpenCampaign open = open_to_look(options.campaign, options.directory);
  deliver(report_html(open.database, current_owner(open.directory)), options.output, options.quiet);
}

void add_report(VerbSet& verbs) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* const verb =
      verbs.add("report", "Make one HTML page of a campaign, for a colleague or a notebook",
                "peclet report flow-curve.json --output flow-curve.html",
                page(R"(
The page has every measured quantity over any swept parameter with its intervals, how the mean of each
point came about, tables that sort, lost seeds by cause, what every mark means, where the numbers come from
and the commands that make them again. Every chart can be saved as CSV, SVG and a script of matplotlib. It
is one file that needs no other and no network, and runs in a browser with JavaScript; print it from there.
A database at rest gives the same bytes at any time.
)",
                     {}, {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_option("--output", options->output,
                   "File to write, whole or not at all; standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options, write_report);
}

void add_serve(VerbSet& verbs) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* const verb = verbs.add(
      "serve", "Show the page of a campaign in a browser, kept up to date", "peclet serve flow-curve.json",
      page(R"(
Prints the address of the page that `peclet report` makes, live: numbers come as seeds end, and what was
chosen on it stays. May be started before, while and after the campaign runs, and only reads. The address is
reached from this machine alone, by everybody who has an account on it; from elsewhere through ssh. Ends at
Ctrl-C or SIGTERM, which does nothing to the campaign, with the exit code that `status --check` would have.
)",
           {{"ssh -L 7325:localhost:7325 cluster", "then http://localhost:7325/ here is the page there"}},
           {0, 1, 2, 3, 4, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  add_number(verb, "--port", options->port, whole_number(0, 65'535),
             "Port to listen on; 0 is any that is free")
      ->capture_default_str();
  verbs.choose(verb, options, serve_campaign);
}

}  // namespace

void add_looking_verbs(VerbSet& verbs) {
  add_status(verbs);
  add_watch(verbs);
  add_explain(verbs);
  add_files(verbs);
  add_export(verbs);
  add_results(verbs);
  add_report(verbs);
  add_serve(verbs);
}

}  // namespace peclet::runner
