// Verbs that draw curves, fit laws to them, and say which points would improve them.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "contract/named_files.h"
#include "runner/campaign/quoting.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/page/figure.h"
#include "runner/page/fit.h"
#include "runner/page/jamming.h"
#include "runner/reports/next.h"

namespace peclet::runner {
namespace {

struct CurveOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  bool json = false;
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // no message about where the output was written
};

// The options of `peclet plot`: `json` prints the numbers and draws nothing, `quiet` prints no notes.
struct PlotOptions : CurveOptions {
  FigureChoice choice;
  std::vector<std::filesystem::path> others;  // campaigns in the same figure
};

// Returns the data of the figure of one campaign or of several.
Json figure_of(const PlotOptions& options) {
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  if (options.others.empty()) return figure_data(open.database, options.choice);
  std::vector<OpenCampaign> others = open_beside(open, options.others);
  std::vector<NamedCampaign> sources{{open.database, open.database.campaign().name}};
  for (OpenCampaign& other : others) sources.push_back({other.database, other.database.campaign().name});
  return figure_data_of_several(sources, options.choice);
}

// The files of a figure: the picture and the script beside it.
class FigureFiles {
 public:
  // Throws InputError for a name that no picture can have, and for files that must not be replaced. "" is
  // standard output.
  explicit FigureFiles(const std::filesystem::path& output)
      : output_(output),
        form_(output.empty() ? PictureForm::svg : picture_form(output)),
        script_(output.empty() ? "" : script_beside(output)) {
    if (output.empty()) return;
    check_output(output);
    check_output(script_);
  }

  // Writes the script first, so that the numbers are there even if the picture cannot be drawn. Throws
  // NotDrawn.
  void write(const Json& figure, bool quiet) const {
    const std::string script = figure_script(figure);
    if (!output_.empty()) deliver(script, script_, quiet);
    if (form_ == PictureForm::script) return;
    try {
      const Picture picture = drawn(script, form_);
      deliver(picture.bytes, output_, quiet);
      if (!quiet) say(picture.said);
    } catch (const NotDrawn& fault) {
      throw NotDrawn(
          output_.empty()
              ? fmt::format("{}; --json prints the numbers", fault.what())
              : fmt::format("{}; {} has the numbers, and draws them with matplotlib: python3 {} {}",
                            fault.what(), script_.string(), shell_word(script_.string()),
                            shell_word(output_.string())));
    }
  }

 private:
  std::filesystem::path output_;
  PictureForm form_;
  std::filesystem::path script_;
};

void draw_campaign(const PlotOptions& options) {
  if (options.json) {
    if (!options.output.empty()) check_output(options.output);
    deliver(figure_of(options).dump(1) + '\n', options.output, options.quiet);
    return;
  }
  const FigureFiles files(options.output);
  files.write(figure_of(options), options.quiet);
}

void add_plot(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<PlotOptions>(
      draw_campaign, "plot", "Draw measured quantities over a swept parameter or an axis of their own",
      {0, 1, 2, 6}, R"(
Draws every point with its interval at the campaign's confidence, and a curve for each combination of values
of the other swept parameters. Numbers are those of `export`. Those of the target are the deciding ones,
with the control variate if there is one. Open marks are points that have not converged; those with dashed
bars are provisional. Crosses are points that have jammed.

A quantity with an axis of numbers (strain, time, frequency, r, y) is drawn along it: a curve for each
point, with the interval of the mean as a band. Dashed curves are provisional. A quantity with further axes
needs their elements, as profiles/stress/total/xy.

--scale-x and --scale-y divide an axis by a number in its unit, or by a number that follows from the scene:
times and stresses such as brownian_time, shear_time, thermal_stress, critical_stress, repulsion_stress. An
axis in 1 / time is multiplied by a time.

--with adds the points of another campaign. Curves then have the campaign's name; a parameter that one of the
campaigns does not sweep has the value of its scene, or – if that has none. --where names parameters that all
of them sweep.

The ending of --output chooses the form. Pictures are drawn with matplotlib, by the python3 in PATH. Beside
the picture a script of the same name and the ending .py is written, which holds the numbers and draws the
figure again by itself. Without python3 or matplotlib only the script is written, and the exit code is 1. A
script that was changed is never replaced. Axes are logarithmic if the numbers then lie more evenly.

  peclet plot flow-curve.json --output flow-curve.pdf
  peclet plot flow-curve.json --quantity pressure --over volume_fraction --log y --output p.svg
  # with the tolerance around each mean
  peclet plot flow-curve.json --band > flow-curve.svg
  # one component of the stress
  peclet plot flow-curve.json --quantity stress/total/xy --output xy.png
  # a stress over strain, at some of the points
  peclet plot flow-curve.json --quantity transient/shear_stress --where peclet=10 --output start.svg
  # both moduli in units of k_B T / a^3 over the frequency in Brownian times
  peclet plot moduli.json --quantity linear_response/storage --quantity linear_response/loss \
    --scale-x brownian_time --scale-y thermal_stress --output moduli.pdf
  # viscosity over the rate that was measured at each stress
  peclet plot thickening.json --quantity apparent_viscosity --over shear_rate --output rate.pdf
  # two campaigns in one figure
  peclet plot rough.json --with smooth.json --over volume_fraction --output both.pdf
  # the script alone, which needs no matplotlib yet
  peclet plot flow-curve.json --output xy.py
)");
  add_campaign(verb, *options);
  add_option(verb, "--with CAMPAIGN", options->others,
             "Another campaign in the same figure, its file or its .peclet folder; may be repeated")
      ->allow_extra_args(false);
  add_option(verb, "--quantity NAME", options->choice.quantities,
             "Quantity to draw, as `export` calls it; the campaign's target unless given; may be repeated")
      ->allow_extra_args(false);
  add_option(verb, "--over PARAMETER", options->choice.over,
             "Swept parameter on the axis: its pointer or the last word of it; or a derived number, such as "
             "peclet, or a measured one, such as shear_rate; the parameter with most values unless given");
  add_option(verb, "--where NAME=VALUE", options->choice.where,
             "Draw only points with this value of a swept parameter; may be repeated")
      ->allow_extra_args(false);
  add_option(verb, "--scale-x NUMBER", options->choice.scale_x,
             "Number, or name of a derived number, by which the horizontal axis is divided");
  add_option(verb, "--scale-y NUMBER", options->choice.scale_y,
             "Number, or name of a derived number, by which the quantity is divided");
  add_option(verb, "--log AXES", options->choice.log, "Logarithmic axes; chosen by the numbers unless given")
      ->check(CLI::IsMember({"none", "x", "y", "xy"}));
  verb->add_flag("--band", options->choice.tolerance, "Draw the tolerance as a band around each mean");
  add_option(verb, "--output FILE", options->output,
             "File to write, ending in .svg, .png, .pdf or .py; SVG on standard output unless given");
  verb->add_flag("--json", options->json, "Print the numbers as JSON, and draw nothing");
  add_quiet(verb, options->quiet);
}

// The options of `peclet fit`: `output` is a picture beside the text on standard output.
struct FitOptions : CurveOptions {
  FitChoice choice;
};

void fit_campaign(const FitOptions& options) {
  std::optional<FigureFiles> files;
  if (!options.output.empty()) files.emplace(options.output);
  OpenCampaign open = open_for_viewing(options.campaign, options.directory);
  const FitAnswer answer = fit_law(open.database, options.choice, options.json);
  print(answer.text);
  if (!files) return;
  if (answer.figure.is_null()) throw NotDrawn("there is no picture: no curve determines the law");
  files->write(answer.figure, options.quiet);
}

void add_fit(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<FitOptions>(
      fit_campaign, "fit", "Fit a law to the points of a sweep, with intervals from the seeds", {0, 1, 2, 6},
      R"(
Fits a law to each curve of the campaign, and prints its parameters with intervals of 95 %, chi^2 with its
probability p, and the parameters without the points at either end of the axis. Intervals are those of
redraws: every point is drawn again with the error of its seeds. A parameter whose interval reaches the end of
its search is not determined. A small p says that the law does not describe the points.

Over the volume fraction, divergence fits a viscosity, and mu-of-j friction and volume fraction over the
viscous number, from relative_viscosity and pressure. wyart-cates fits a viscosity over volume fraction and
given stress; jammed points are lower bounds. Over a rate, cross fits a viscosity between two plateaus, and
herschel-bulkley a stress, or a viscosity that is multiplied by the axis. maxwell fits a spectrum of relaxation
times to storage_modulus and loss_modulus over the frequency.

The fits need python3 in PATH with NumPy and SciPy, and the package peclet, which is installed with this
program. If one of them is missing, the verb exits with 1 and says what is missing. --output also draws the
points and the law with its band of 95 %, with matplotlib, as `peclet plot` does.

  peclet fit dense.json --law divergence
  # the form of Maron and Pierce, at dense points only
  peclet fit dense.json --law divergence --fix prefactor=1 --fix exponent=2 --from 0.5
  peclet fit thickening.json --law wyart-cates --free exponent --output thickening.pdf
  # with the pressure along the gradient
  peclet fit dense.json --law mu-of-j --quantity stress/total/yy
  # for programs; schema/README.md
  peclet fit flow-curve.json --law cross --json
)");
  add_campaign(verb, *options);
  add_option(verb, "--law NAME", options->choice.law, "Law to fit")
      ->required()
      ->check(CLI::IsMember(law_names()));
  add_option(verb, "--quantity NAME", options->choice.quantity,
             "Number to fit, as `export` calls it, with mu-of-j the pressure; that of the law or the target "
             "unless given");
  add_option(
      verb, "--over PARAMETER", options->choice.over,
      "Swept parameter on the axis: its pointer or the last word of it; that of the law or the one with "
      "most values unless given");
  add_option(verb, "--fix NAME=VALUE", options->choice.fixed, "Parameter that is not fitted; may be repeated")
      ->allow_extra_args(false);
  add_option(verb, "--free NAME", options->choice.free,
             "Parameter that is fitted although the law has a value for it; may be repeated")
      ->allow_extra_args(false);
  add_number(verb, "--from", options->choice.from, number_from(0), "Smallest value of the axis");
  add_number(verb, "--to", options->choice.to, number_from(0), "Largest value of the axis");
  add_option(verb, "--output FILE", options->output, "Picture to write, ending in .svg, .png, .pdf or .py");
  add_json(verb, options->json);
  add_quiet(verb, options->quiet);
}

void show(const Proposal& proposal) {
  print(proposal.text);
  if (!proposal.message.empty()) say(proposal.message);
}

void show_jamming(const JammingOptions& options) { show(find_jamming(options)); }

void show_next(const NextOptions& options) { show(propose_next(options)); }

void add_law_options(CLI::App* verb, JammingOptions& options) {
  add_option(verb, "--by DEFINITION", options.by, "Definition of the jamming point; both unless given")
      ->check(CLI::IsMember({"law", "steepest"}));
  add_number(verb, "--exponent", options.exponent, number_above(0),
             "Exponent of the law; fitted unless given");
  verb->add_flag("--common-exponent", options.common_exponent, "Fit one exponent for all curves");
  verb->add_flag("--unit-prefactor", options.unit_prefactor,
                 "Use the law (1 - phi / phi_m)^-exponent, which is 1 without particles");
  add_number(verb, "--above", options.above, number_from(0), "Viscosity above which points enter the law")
      ->capture_default_str();
  add_number(verb, "--softest", options.curves.softest, number_above(0),
             "Largest mean overlap of contacts, in radii, with which spheres count as hard")
      ->capture_default_str();
}

void add_proposing_options(CLI::App* verb, JammingOptions& options) {
  verb->add_flag("--propose", options.propose,
                 "Say which fractions to run next, with a patch of the campaign file");
  add_number(verb, "--budget SECONDS", options.budget, number_above(0),
             "Processor time for the proposed points; one point for each curve unless given");
  add_option(verb, "--write FILE", options.write,
             "New campaign file with the proposed points; a file that is there is never replaced");
}

void add_jamming(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<JammingOptions>(
      show_jamming, "jamming", "Estimate the volume fraction of jamming from the points of a sweep",
      {0, 1, 2, 6}, R"(
Makes a curve of viscosity over volume fraction for each combination of values of the other swept
parameters, and estimates its jamming point phi_m by two definitions. One is where the viscosity diverges,
by a power law A (1 - phi / phi_m)^-beta that is fitted to the flowing points above a viscosity of 10. The
other is where the viscosity rises most steeply. Errors follow from the scatter of the seeds. If the points
do not determine phi_m, the reason is given.

A point is jammed if half of its seeds or more ended with the engine's causes overlap, packing or jammed. It
is soft, and left out of the law, if its contacts overlap by more than 0.1 % of a radius in the mean. If
results have no mean overlap, it is soft if the largest overlap exceeds ten times this limit.

--propose names the fraction that would tell most: the one that reduces the error of the law, or, if there
is no law yet, the one half-way between the points that flow and those that are jammed. Fractions are added
to the sweep, for all curves. Points that have been run are not run again.

The fits need python3 in PATH with NumPy, and the package peclet, which is installed with this program. If
one of them is missing, the verb exits with 1 and says what is missing and which command has failed.

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

void add_next(VerbSet& verbs) {
  const auto [verb, options] = verbs.add<NextOptions>(
      show_next, "next", "Say which seeds would lower the largest error of a curve most", {0, 1, 2, 6}, R"(
For a campaign whose target has a curve. Looks at the band between the points, too, and proposes new values of
the axis, or more seeds of old points, until the band is within the tolerance everywhere. Each step lowers the
band where it is widest by the seeds that do so most for their processor time. Spread and cost of a seed at a
new value are those between its neighbours. The proposal follows from the stored results alone. Few points at a
time cost least: run them, and ask again.

More seeds at points that have met the tolerance are asked for by a smaller tolerance. Points that have been
run are not run again.

  peclet next flow-curve.json
  # a campaign file with points for an hour of processor time
  peclet next flow-curve.json --budget 3600 --write next.json
)");
  add_campaign(verb, *options);
  add_number(verb, "--budget SECONDS", options->budget, number_above(0),
             "Processor time for each curve; without it, as much as the tolerance takes");
  add_number(verb, "--points NUMBER", options->points, whole_number(0, 1000),
             "New points of each curve, at most; 0: more seeds at old points only")
      ->capture_default_str();
  add_option(verb, "--write FILE", options->write,
             "New campaign file with the proposed points; a file that is there is never replaced");
  add_json(verb, options->json);
}

}  // namespace

void add_curve_verbs(VerbSet& verbs) {
  add_plot(verbs);
  add_jamming(verbs);
  add_fit(verbs);
  add_next(verbs);
}

}  // namespace peclet::runner
