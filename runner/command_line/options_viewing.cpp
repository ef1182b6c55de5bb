// Verbs that show, export or draw a campaign, and change nothing.
#include <fmt/format.h>

#include <optional>

#include "contract/named_files.h"
#include "runner/command_line/list.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/command_line/watch.h"
#include "runner/page/joined_page.h"
#include "runner/page/page_html.h"
#include "runner/page/supplement.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

// The options of verbs that read a campaign; each verb adds those that it uses.
struct ViewOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::string point;  // label, or at least 4 digits of the hash; "": all points
  std::optional<int> seed;
  bool json = false;
  bool paths = false;  // only the paths of files
  bool check = false;  // the exit code tells the state of the campaign
  bool csv = false, in_long = false, canonical = false;
  std::filesystem::path output;  // "": standard output
  std::filesystem::path bundle;  // "": no archive of everything
  bool quiet = false;            // no message about where the output was written
};

int show_status(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  const CampaignStatus status = read_status(open.database, current_owner(open.directory));
  print(options.json ? status_json(status).dump(2) + '\n' : status_table(status) + workers_text(status));
  if (const std::string note = difference_from_file(options.campaign, options.directory, status.campaign);
      !note.empty()) {
    say(fmt::format("note: {}\n", note));
  }
  return options.check ? exit_code_of(status) : 0;
}

void add_status(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      show_status, "status", "Show the progress of every point, also while the campaign runs",
      {0, 1, 2, 3, 4, 6}, R"(
Shows for every point the seeds that have ended, their mean with its standard error, the interval at the
last stop test, and the verdict. Only reads, and may be used at any time.

  peclet status flow-curve.json --check
  # for programs; schema/README.md describes it
  peclet status flow-curve.json --json
)");
  add_campaign(verb, *options);
  add_json(verb, options->json);
  verb->add_flag("--check", options->check,
                 "Exit with 0 (every point is converged or complete), 3 (every point is decided, but some "
                 "otherwise), 4 (not finished) or 6 (a point is suspect)");
}

struct ListOptions {
  std::filesystem::path folder = ".";
  bool json = false;
};

std::string list_campaigns(const ListOptions& options) {
  const std::vector<ListedCampaign> campaigns = campaigns_below(options.folder);
  return options.json ? list_json(campaigns).dump(2) + '\n' : list_table(campaigns);
}

void add_list(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ListOptions>(
      list_campaigns, "list", "List the campaigns in a folder and below it", {0, 1, 2}, R"(
Shows for every campaign that has been run how many of its points are decided, its seeds and their processor
time, its state and the time to go. A campaign is running, stopped, handed-over (to a batch system),
converged, ended (decided, but some points are capped, failed or cancelled, or lost seeds), suspect or
unreadable. Links are not followed.

  peclet list ~/suspensions
  # the campaigns that `peclet run` would continue
  peclet list --json | jq -r '.[] | select(.state == "stopped") | .campaign'
)");
  add_option(verb, "folder FOLDER", options->folder, "Folder to search; the working folder unless given");
  add_json(verb, options->json);
}

void add_watch(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<WatchOptions>(
      watch_campaign, "watch", "Show the status in a terminal, kept up to date", {0, 1, 2, 3, 4, 6}, R"(
Ends when every point is decided, or at Ctrl-C, with the exit code of `status --check`. Does not affect the
campaign. Waits for the first run of a campaign that has not been run yet. If the terminal has room, the
mean of all seeds that have ended is drawn over the swept parameter. If the output is not a terminal, the
table is printed whenever it changes.

  peclet watch flow-curve.json
)");
  add_campaign(verb, *options);
  add_number(verb, "--interval SECONDS", options->interval_seconds, number_from(0.1, 86'400),
             "Seconds between two updates")
      ->capture_default_str();
}

std::string explanation(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  return options.json ? explain_json(open.database, open.directory, options.point).dump(2) + '\n'
                      : explain(open.database, open.directory, options.point);
}

void add_explain(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      explanation, "explain", "Explain the verdicts of points, and what comes next", {0, 1, 2, 6}, R"(
A point is named by its label (peclet=10 volume_fraction=0.5), by its values alone as in a row of the tables
("10 0.5"), or by the beginning of its hash.

Lists the stop tests at a point, a bootstrap interval beside Student's, lost seeds with the last message of
their engines, whether the measured window is long enough, and what would help the point to converge.

  peclet explain flow-curve.json peclet=10
  # all points
  peclet explain flow-curve.peclet
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point,
             "Label of a point, its values alone, or 4 or more digits of its hash; all points unless given");
  add_json(verb, options->json);
}

std::string files(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  return list_files(open.database, open.directory, {options.point, options.paths, options.json});
}

void add_files(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      files, "files", "List the files that realisations have left beside their results", {0, 1, 2, 6},
      R"(
A scene may ask its engine for files beside the numbers; "files": {"final_configuration": true} gives
final.xyz. They lie in the campaign's folder, by point and seed. Files that /keep_files removes are listed,
but no longer exist.

  peclet files flow-curve.json peclet=10 --paths
  # draws the final configuration of the first seed
  peclet-engine snapshot $(peclet files flow-curve.json 10 --paths | head -1) --output spheres.png
  ovito $(peclet files flow-curve.json 10 --paths | head -1)
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point, "Point, named as for explain; all points unless given");
  CLI::Option* const paths =
      verb->add_flag("--paths", options->paths, "Print only the paths, one on each line");
  add_json(verb, options->json)->excludes(paths);
}

void export_campaign(const ViewOptions& options) {
  if (!options.bundle.empty()) {
    check_supplement_name(options.bundle);
    check_output(options.bundle);
    OpenCampaign whole = open_for_viewing(options.campaign, options.directory);
    deliver(supplement(whole.database, current_owner(whole.directory)), options.bundle, options.quiet);
    return;
  }
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  deliver(options.csv       ? export_csv(open.database, options.canonical)
          : options.in_long ? export_long_csv(open.database)
                            : export_json(open.database, options.canonical),
          options.output, options.quiet);
}

void add_export(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      export_campaign, "export", "Print the results for programs to read", {0, 1, 2, 6}, R"(
The canonical form holds only what depends on campaign, seeds and engine. Two runs of one campaign can
therefore be compared byte by byte, for any number of workers and after any interruption. A file named by
--output is replaced as a whole; links are followed, and devices, FIFOs and /dev/stdout are written to.
Unless --quiet is given, standard error says where the output was written.

Estimates are over the seeds of each point's last stop test. --csv has a column for every scalar that was
measured, --long a row for every number, with names, units and axes as the engine gives them.

--bundle makes the supplement of a paper: campaign file, JSON and both kinds of CSV in canonical form, the
page of `report`, the script of the figure of `plot`, engines and versions, the SHA-256 of each file, and a
README that describes the files and how to reproduce them. All files show one state of the campaign. A
campaign that does not run gives the same bytes at any time.

  peclet export flow-curve.json --csv --output flow-curve.csv
  # one checksum for all results
  peclet export flow-curve.json --canonical | sha256sum
  # also profiles and distributions
  peclet export flow-curve.json --long --output all.csv
  # everything, for a paper's readers
  peclet export flow-curve.json --bundle flow-curve.tar.gz
)");
  add_campaign(verb, *options);
  CLI::Option* const json = verb->add_flag("--json")->description("Everything, seed by seed (the default)");
  CLI::Option* const csv =
      verb->add_flag("--csv", options->csv, "One row per point, with the mean of every scalar");
  csv->excludes(json);
  CLI::Option* const in_long =
      verb->add_flag("--long", options->in_long,
                     "CSV with one row per point, quantity and element, also for profiles and distributions");
  in_long->excludes(json)->excludes(csv);
  CLI::Option* const canonical =
      verb->add_flag("--canonical", options->canonical,
                     "Only what depends on campaign, seeds and engine: equal runs give equal bytes");
  CLI::Option* const output = add_output(verb, options->output);
  CLI::Option* const bundle =
      add_option(verb, "--bundle FILE", options->bundle,
                 "Archive for a paper's supplement, with all of these; its name ends in .tar.gz or .tgz");
  for (CLI::Option* const other : {json, csv, in_long, canonical, output}) bundle->excludes(other);
  add_quiet(verb, options->quiet);
}

void print_results(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  for_each_result_line(open.database, options.point, options.seed,
                       [](const std::string& line) { print(line + '\n'); });
}

void add_results(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      print_results, "results", "Print every stored result whole, one JSON object per line", {0, 1, 2, 6}, R"(
Prints each result as its engine wrote it, with blocks, costs and provenance. Adds the point, and whether
its last stop test counts the seed ("deciding"). Extra seeds must not enter a mean, because it depends on
the machine which of them have ended. May be used while the campaign runs.

  peclet results flow-curve.json peclet=10 > runs.jsonl
  # the values of all points, for R, Julia and others: schema/README.md
  peclet results flow-curve.json | jq -c 'select(.deciding) | .result.mean.relative_viscosity'
  # one realisation
  peclet results flow-curve.json peclet=10 --seed 3 | jq .result
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point,
             "Label of a point, or 4 or more digits of its hash; all points unless given");
  add_option(verb, "--seed SEED", options->seed, "Print this seed only")->check(CLI::NonNegativeNumber);
}

struct ReportOptions : ViewOptions {
  std::vector<std::filesystem::path> others;  // campaigns on the same page
};

void write_report(const ReportOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  if (options.others.empty()) {
    deliver(report_html(open.database, current_owner(open.directory)), options.output, options.quiet);
    return;
  }
  std::vector<OpenCampaign> others = open_beside(open, options.others);
  std::vector<NamedCampaign> sources{{open.database, open.database.campaign().name}};
  for (OpenCampaign& other : others) sources.push_back({other.database, other.database.campaign().name});
  deliver(page_html(joined_page(sources)), options.output, options.quiet);
}

void add_report(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ReportOptions>(
      write_report, "report", "Make one HTML page of a campaign, for a colleague or a notebook", {0, 1, 2, 6},
      R"(
The page shows every measured quantity over any swept parameter with its intervals, the convergence of the
mean of each point, tables that sort, lost seeds by cause, the meaning of every mark, the provenance of the
numbers, and the commands that reproduce them. Every chart can be saved as CSV, as SVG and as a matplotlib
script. The page is one file, which needs no network but a browser with JavaScript, and can be printed from
there. A database that does not change gives the same bytes at any time.

--with adds the points of another campaign with the same target, whose names then tell their curves apart.

  peclet report flow-curve.json --output flow-curve.html
  # two campaigns on one page
  peclet report rough.json --with smooth.json --output both.html
)");
  add_campaign(verb, *options);
  add_option(verb, "--with CAMPAIGN", options->others,
             "Another campaign on the same page, its file or its .peclet folder; may be repeated")
      ->allow_extra_args(false);
  add_output(verb, options->output);
  add_quiet(verb, options->quiet);
}

void add_serve(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ServeOptions>(
      serve_campaign, "serve", "Show the page of a campaign in a browser, kept up to date",
      {0, 1, 2, 3, 4, 6}, R"(
Prints the address of a live page. It is the page of `peclet report`, updated as seeds end; choices on it
are kept. May be started before, during and after a run, and only reads. The address can be reached only
from this machine, by everyone who has an account on it; from other machines through ssh. Ends at Ctrl-C or
SIGTERM, with the exit code of `status --check`, and does not affect the campaign.

  peclet serve flow-curve.json
  # then the page of the cluster is http://localhost:7325/ here
  ssh -L 7325:localhost:7325 cluster
)");
  add_campaign(verb, *options);
  add_number(verb, "--port", options->port, whole_number(0, 65'535),
             "Port to listen on; 0 takes any free one")
      ->capture_default_str();
}

}  // namespace

void add_viewing_verbs(VerbSet& verbs) {
  add_status(verbs);
  add_list(verbs);
  add_watch(verbs);
  add_explain(verbs);
  add_files(verbs);
  add_export(verbs);
  add_results(verbs);
  add_report(verbs);
  add_serve(verbs);
}

}  // namespace peclet::runner
