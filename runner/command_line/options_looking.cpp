// Verbs that look at a campaign, or draw it, and change nothing.
#include <fmt/format.h>

#include <optional>

#include "contract/named_files.h"
#include "runner/campaign/quoting.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/command_line/watch.h"
#include "runner/page/figure.h"
#include "runner/page/jamming.h"
#include "runner/page/page_html.h"
#include "runner/page/supplement.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

// What verbs that look at a campaign are told; each has the options that it adds.
struct ViewOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::string point;  // label, or at least 4 digits of the hash; "": all points
  std::optional<int> seed;
  bool json = false;
  bool paths = false;  // of files, and nothing else
  bool check = false;  // the exit code says how the campaign stands
  bool csv = false, in_long = false, canonical = false;
  std::filesystem::path output;  // "": standard output
  std::filesystem::path bundle;  // "": no archive of everything
  bool quiet = false;            // does not say where it is
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
      show_status, "status", "Show how far every point is, also while it runs", {0, 1, 2, 3, 4, 6}, R"(
Shows the seeds that have ended, the mean and its standard error so far, the interval at the last stop test
and the verdict of every point. It only reads, and may be used at any time.

  peclet status flow-curve.json --check
  # for programs; schema/README.md describes it
  peclet status flow-curve.json --json
)");
  add_campaign(verb, *options);
  add_json(verb, options->json);
  verb->add_flag("--check", options->check,
                 "Leave with 0 (every point converged or complete), 3 (decided, but not so), 4 (not "
                 "finished) or 6 (suspect)");
}

void add_watch(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<WatchOptions>(
      watch_campaign, "watch", "Show the status in a terminal, kept up to date", {0, 1, 2, 3, 4, 6}, R"(
Ends when every point is decided, with the exit code that `status --check` would have, or at Ctrl-C,
which does nothing to the campaign. A campaign that has not been run yet is waited for. Where the terminal
has room, the mean so far is drawn over the swept parameter. Off a terminal the table is printed whenever
it changes.

  peclet watch flow-curve.json
)");
  add_campaign(verb, *options);
  add_number(verb, "--interval SECONDS", options->interval_seconds, number_from(0.1, 86'400),
             "Seconds between stop tests")
      ->capture_default_str();
}

std::string explanation(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  return options.json ? explain_json(open.database, open.directory, options.point).dump(2) + '\n'
                      : explain(open.database, open.directory, options.point);
}

void add_explain(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      explanation, "explain", "Say why points are where they are, and what comes next", {0, 1, 2, 6}, R"(
A point is named by its label (peclet=10 volume_fraction=0.5), by its values alone as in a row of the
tables ("10 0.5"), or by the beginning of its hash.

Lists the stop tests at a point, a bootstrap interval beside Student's, lost seeds with what their engines
said last, whether the window is long enough, and what would bring the point further.

  peclet explain flow-curve.json peclet=10
  # all points
  peclet explain flow-curve.peclet
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point,
             "Label of a point, its values alone, or 4 or more digits of its hash; all unless given");
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
A scene may ask its engine for files beside the numbers, as final.xyz of "files": {"final_configuration":
true}. They lie in the campaign's folder, named by point and seed; those that /keep_files throws away are
listed, and nothing is left of them.

  peclet files flow-curve.json peclet=10 --paths
  # draws what the first seed has left
  peclet-engine snapshot $(peclet files flow-curve.json 10 --paths | head -1) --output spheres.png
  ovito $(peclet files flow-curve.json 10 --paths | head -1)
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point, "As of explain; all unless given");
  CLI::Option* const paths = verb->add_flag("--paths", options->paths, "The paths alone, a line each");
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
The canonical form holds what depends on campaign, seeds and engine alone, so that two runs of one
campaign can be compared byte by byte, however many workers they had and whatever killed them.
--output replaces a file whole, follows a link, writes to a device, a FIFO or /dev/stdout, and says on
standard error where it wrote, unless --quiet.

Estimates are of the seeds of each point's last stop test. --csv has a column for every scalar that was
measured, --long a row for every number, with names, units and axes as the engine gives them.

--bundle makes the supplement of a paper: campaign file, JSON and both kinds of CSV in canonical form, the
page of `report`, the figure of `plot` with its script, engines and versions, SHA-256 of each file, and a README
that says what is what and how to make it again. All files are of one state of the campaign, and a campaign at
rest gives the same bytes at any time.

  peclet export flow-curve.json --csv --output flow-curve.csv
  # one number for all results
  peclet export flow-curve.json --canonical | sha256sum
  # profiles and distributions, too
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
                     "CSV with one row per point, quantity and element: profiles and distributions, too");
  in_long->excludes(json)->excludes(csv);
  CLI::Option* const canonical =
      verb->add_flag("--canonical", options->canonical,
                     "Only what depends on campaign, seeds and engine: equal runs give equal bytes");
  CLI::Option* const output = add_output(verb, options->output);
  CLI::Option* const bundle =
      add_option(verb, "--bundle FILE", options->bundle,
                 "All of it in one archive, for a paper's supplement: a file that ends in .tar.gz");
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
      print_results, "results", "Print every stored result whole, one JSON object a line", {0, 1, 2, 6}, R"(
The database holds results deflated; this prints them as their engines wrote them, with blocks, costs and where
they come from, and with the point and whether its last stop test counts the seed ("deciding"). One that is extra
must not enter a mean: which seeds end first depends on the machine. Also while the campaign runs.

  peclet results flow-curve.json peclet=10 > runs.jsonl
  # the values of all points, for R, Julia and others: schema/README.md
  peclet results flow-curve.json | jq -c 'select(.deciding) | .result.mean.relative_viscosity'
  # one realisation
  peclet results flow-curve.json peclet=10 --seed 3 | jq .result
)");
  add_campaign(verb, *options);
  add_option(verb, "point POINT", options->point,
             "Label of a point, or 4 or more digits of its hash; all unless given");
  add_option(verb, "--seed SEED", options->seed, "Of this seed only")->check(CLI::NonNegativeNumber);
}

void write_report(const ViewOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  deliver(report_html(open.database, current_owner(open.directory)), options.output, options.quiet);
}

void add_report(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ViewOptions>(
      write_report, "report", "Make one HTML page of a campaign, for a colleague or a notebook", {0, 1, 2, 6},
      R"(
The page has every measured quantity over any swept parameter with its intervals, how the mean of each
point came about, tables that sort, lost seeds by cause, what every mark means, where the numbers come from
and the commands that make them again. Every chart can be saved as CSV, SVG and a script of matplotlib. It
is one file that needs no other and no network, and runs in a browser with JavaScript; print it from there.
A database at rest gives the same bytes at any time.

  peclet report flow-curve.json --output flow-curve.html
)");
  add_campaign(verb, *options);
  add_output(verb, options->output);
  add_quiet(verb, options->quiet);
}

void add_serve(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<ServeOptions>(
      serve_campaign, "serve", "Show the page of a campaign in a browser, kept up to date",
      {0, 1, 2, 3, 4, 6}, R"(
Prints the address of the page that `peclet report` makes, live: numbers come as seeds end, and what was
chosen on it stays. May be started before, while and after the campaign runs, and only reads. The address is
reached from this machine alone, by everybody who has an account on it; from elsewhere through ssh. Ends at
Ctrl-C or SIGTERM, which does nothing to the campaign, with the exit code that `status --check` would have.

  peclet serve flow-curve.json
  # then http://localhost:7325/ here is the page there
  ssh -L 7325:localhost:7325 cluster
)");
  add_campaign(verb, *options);
  add_number(verb, "--port", options->port, whole_number(0, 65'535),
             "Port to listen on; 0 is any that is free")
      ->capture_default_str();
}

// With `json` the numbers, and no picture; with `quiet` it is not said either what is left out.
struct PlotOptions : ViewOptions {
  FigureChoice choice;
};

// The script is written first: it has the numbers where no picture can be drawn.
void draw_campaign(const PlotOptions& options) {
  const bool into_file = !options.output.empty() && !options.json;
  const PictureForm form = into_file ? picture_form(options.output) : PictureForm::svg;
  const std::filesystem::path beside = into_file ? script_beside(options.output) : "";
  if (!options.output.empty()) check_output(options.output);
  if (into_file) check_output(beside);
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  const Json data = figure_data(open.database, options.choice);
  if (options.json) {
    deliver(data.dump(1) + '\n', options.output, options.quiet);
    return;
  }
  const std::string script = figure_script(data);
  if (into_file) deliver(script, beside, options.quiet);
  if (form == PictureForm::script) return;
  try {
    const Picture picture = drawn(script, form);
    deliver(picture.bytes, options.output, options.quiet);
    if (!options.quiet) say(picture.said);
  } catch (const NotDrawn& fault) {
    throw NotDrawn(
        into_file ? fmt::format("{}; {} has the numbers, and draws them where matplotlib is: python3 {} {}",
                                fault.what(), beside.string(), shell_word(beside.string()),
                                shell_word(options.output.string()))
                  : fmt::format("{}; --json prints the numbers", fault.what()));
  }
}

void add_plot(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<PlotOptions>(
      draw_campaign, "plot", "Draw a measured quantity over a swept parameter, with the script of the figure",
      {0, 1, 2, 6}, R"(
Draws every point with its interval at the campaign's confidence, a curve for each value of what else is
swept. Numbers are those of `export`: the target's are the ones that decide, with the control variate where
there is one. Open marks have not converged; those with dashed bars may still change. Crosses have jammed.

The name of --output says the form. Pictures are drawn by matplotlib, through python3 of PATH. Beside a
picture lies its script, of the same name and the ending .py, which holds the numbers and draws the figure
again by itself. Where there is no python3 with matplotlib only the script is written, and the exit code is 1.
A script that somebody has changed is never replaced. Axes are logarithmic where the numbers lie more evenly
then.

  peclet plot flow-curve.json --output flow-curve.pdf
  peclet plot flow-curve.json --quantity pressure --over volume_fraction --log y --output p.svg
  # with the tolerance around each mean
  peclet plot flow-curve.json --band > flow-curve.svg
  # one component of the stress
  peclet plot flow-curve.json --quantity stress/total/xy --output xy.png
  # the script alone, which needs no matplotlib yet
  peclet plot flow-curve.json --output xy.py
)");
  add_campaign(verb, *options);
  add_option(verb, "--quantity NAME", options->choice.quantity,
             "Number to draw, as `export` calls it; the campaign's target unless given");
  add_option(verb, "--over PARAMETER", options->choice.over,
             "Swept parameter of the axis: its pointer or the last word of it; the one with most "
             "values unless given");
  add_option(verb, "--log AXES", options->choice.scale,
             "Axes that are logarithmic; those that fit unless given")
      ->check(CLI::IsMember({"none", "x", "y", "xy"}));
  verb->add_flag("--band", options->choice.tolerance, "A band around each mean as wide as the tolerance");
  add_option(verb, "--output FILE", options->output,
             "File to write, ending in .svg, .png, .pdf or .py; SVG on standard output unless given");
  verb->add_flag("--json", options->json, "Print the numbers as JSON, and draw nothing");
  add_quiet(verb, options->quiet);
}

void show_jamming(const JammingOptions& options) {
  const JammingAnswer answer = find_jamming(options);
  print(answer.text);
  if (!answer.message.empty()) say(answer.message);
}

void add_law_options(CLI::App* verb, JammingOptions& options) {
  add_option(verb, "--by DEFINITION", options.by, "Definition of the jamming point; both unless given")
      ->check(CLI::IsMember({"law", "steepest"}));
  add_number(verb, "--exponent", options.exponent, number_above(0),
             "Exponent of the law; fitted unless given");
  verb->add_flag("--common-exponent", options.common_exponent, "One exponent, fitted, for all curves");
  verb->add_flag("--unit-prefactor", options.unit_prefactor,
                 "A law that is 1 without particles, (1 - phi / phi_m)^-exponent");
  add_number(verb, "--above", options.above, number_from(0),
             "The law is of the points whose viscosity is above")
      ->capture_default_str();
  add_number(verb, "--softest", options.curves.softest, number_above(0),
             "Mean overlap of contacts, in radii, up to which spheres are taken for hard")
      ->capture_default_str();
}

void add_proposing_options(CLI::App* verb, JammingOptions& options) {
  verb->add_flag("--propose", options.propose,
                 "Say which fractions to run next, with a patch of the campaign file");
  add_number(verb, "--budget SECONDS", options.budget, number_above(0),
             "Processor time for what is proposed; one point a curve unless given");
  add_option(verb, "--write FILE", options.write,
             "New campaign file with the proposed points; a file that is there is never replaced");
}

void add_jamming(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<JammingOptions>(
      show_jamming, "jamming", "Estimate the volume fraction of jamming from the points of a sweep",
      {0, 1, 2, 6}, R"(
Makes a curve of viscosity over volume fraction for each value of what else is swept, and gives its jamming
point phi_m by two definitions: where a power law A (1 - phi / phi_m)^-beta through the flowing points above
a viscosity of 10 diverges, and where the viscosity rises most steeply. Errors are of the seeds; where the
points leave phi_m open it is not determined, and the reason is said.

A point is jammed when half of its seeds or more ended so: the engine's causes overlap, packing and jammed.
It is soft, and no part of the law, when its contacts overlap by more than 0.1 % of a radius in the mean; of
results without that mean, when the largest overlap is above ten times as much.

--propose says which fraction would tell most: the one that lessens the error of the law, or where there is no
law yet the one half-way between what flows and what is jammed. Fractions go into the sweep, for all curves.
Points are known by their scenes: what has been run is not run again.

The fits are made by python3 of PATH with NumPy, and by the package peclet that is installed with this program.
Without one of them the verb ends with 1, and says what is missing and what it would have run.

  peclet jamming friction.json
  # the law that holds at all fractions
  peclet jamming friction.json --unit-prefactor --above 1
  # for programs; schema/README.md
  peclet jamming friction.json --by law --exponent 2 --json
  # a campaign file with points for an hour of processor time
  peclet jamming friction.json --propose --budget 3600 --write next.json
)");
  add_campaign(verb, *options);
  add_option(verb, "--over PARAMETER", options->curves.over,
             "Swept volume fraction: its pointer or the last word of it")
      ->capture_default_str();
  add_option(verb, "--quantity NAME", options->curves.quantity, "Viscosity, as `export` calls it")
      ->capture_default_str();
  add_law_options(verb, *options);
  add_proposing_options(verb, *options);
  add_json(verb, options->json);
}

}  // namespace

void add_viewing_verbs(VerbSet& verbs) {
  add_status(verbs);
  add_watch(verbs);
  add_explain(verbs);
  add_files(verbs);
  add_export(verbs);
  add_results(verbs);
  add_report(verbs);
  add_serve(verbs);
  add_plot(verbs);
  add_jamming(verbs);
}

}  // namespace peclet::runner
