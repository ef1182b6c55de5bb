// The verb that draws a campaign.
#include <fmt/format.h>

#include <memory>

#include "contract/output_file.h"
#include "runner/command_line/open_to_look.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/figure/figure.h"
#include "runner/figure/picture.h"
#include "runner/text/quoting.h"

namespace peclet::runner {
namespace {

struct PlotOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  FigureChoice choice;
  std::filesystem::path output;  // "": SVG on standard output
  bool json = false;             // the numbers, and no picture
  bool quiet = false;            // does not say where it is, and what is left out
};

// The script is written first: it has the numbers where no picture can be drawn.
void draw_campaign(const PlotOptions& options) {
  const bool into_file = !options.output.empty() && !options.json;
  const PictureForm form = into_file ? picture_form(options.output) : PictureForm::svg;
  const std::filesystem::path beside = into_file ? script_beside(options.output) : "";
  if (!options.output.empty()) check_output(options.output);
  if (into_file) check_output(beside);
  OpenCampaign open = open_to_look(options.campaign, options.directory);
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

}  // namespace

void add_drawing_verbs(VerbSet& verbs) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* const verb = verbs.add(
      "plot", "Draw a measured quantity over a swept parameter, with the script of the figure",
      "peclet plot flow-curve.json --output flow-curve.pdf",
      page(
          R"(
Draws every point with its interval at the campaign's confidence, a curve for each value of what else is
swept. Numbers are those of `export`: the target's are the ones that decide, with the control variate where
there is one. Open marks have not converged; those with dashed bars may still change. Crosses have jammed.

The name of --output says the form. Pictures are drawn by matplotlib, through python3 of PATH. Beside a
picture lies its script, of the same name and the ending .py, which holds the numbers and draws the figure
again by itself. Where there is no python3 with matplotlib only the script is written, and the exit code is 1.
A script that somebody has changed is never replaced. Axes are logarithmic where the numbers lie more evenly
then.
)",
          {{"peclet plot flow-curve.json --quantity pressure --over volume_fraction --log y --output p.svg",
            ""},
           {"peclet plot flow-curve.json --band > flow-curve.svg", "with the tolerance around each mean"},
           {"peclet plot flow-curve.json --quantity stress/total/xy --output xy.png",
            "one component of the stress"},
           {"peclet plot flow-curve.json --output xy.py", "the script alone, which needs no matplotlib yet"}},
          {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_option("--quantity", options->choice.quantity,
                   "Number to draw, as `export` calls it; the campaign's target unless given")
      ->type_name("NAME");
  verb->add_option(
          "--over", options->choice.over,
          "Swept parameter of the axis: its pointer or the last word of it; the one with most values "
          "unless given")
      ->type_name("PARAMETER");
  verb->add_option("--log", options->choice.scale, "Axes that are logarithmic; those that fit unless given")
      ->type_name("AXES")
      ->check(CLI::IsMember({"none", "x", "y", "xy"}));
  verb->add_flag("--band", options->choice.tolerance, "A band around each mean as wide as the tolerance");
  verb->add_option("--output", options->output,
                   "File to write, ending in .svg, .png, .pdf or .py; SVG on standard output unless given")
      ->type_name(value_name::file);
  verb->add_flag("--json", options->json, "Print the numbers as JSON, and draw nothing");
  verb->add_flag("--quiet", options->quiet, "Do not say on stderr where it was written");
  verbs.choose(verb, options, draw_campaign);
}

}  // namespace peclet::runner
