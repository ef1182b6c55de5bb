#include "runner/archive/supplement_readme.h"

#include <fmt/format.h>

#include "contract/provenance.h"
#include "runner/text/number_text.h"
#include "runner/text/quoting.h"

namespace peclet::runner {

std::string supplement_readme(const CampaignStatus& status) {
  const CampaignRecord& campaign = status.campaign;
  const std::string file = shell_word(campaign.name + ".json");
  const std::string confidence = percent(campaign.target.target.confidence);
  std::string text = fmt::format(
      "# {0}\n\n"
      "A campaign of peclet {1}: averages over independent realisations, each with its {2} interval.\n\n"
      "```\n{3}```\n\n",
      campaign.name, version(), confidence, status_table(status));
  text += fmt::format(
      "| file | what it is |\n"
      "|---|---|\n"
      "| `{0}.json` | the campaign: scene, sweep, target |\n"
      "| `results.csv` | a row for each point: the estimate that decides, and the mean of every scalar |\n"
      "| `numbers.csv` | a row for each point, quantity and element, with names, symbols and units: profiles "
      "and "
      "distributions, too |\n"
      "| `results.json` | all of it, and every realisation |\n"
      "| `report.html` | a page for a browser: any quantity over any swept parameter, how each mean came "
      "about "
      "|\n"
      "| `figure.py` | the target over the sweep, drawn by matplotlib: `python3 figure.py figure.pdf` |\n"
      "| `provenance.json` | engines, versions, times |\n"
      "| `SHA256SUMS` | of each of these files: `sha256sum --check SHA256SUMS` |\n\n",
      campaign.name);
  text += fmt::format(
      "## Which number\n\n"
      "`mean` and `half_width` in `results.csv` are those by which the campaign stopped, with the control "
      "variate "
      "where there is one.\n"
      "The table above, the page, the figure and `points/*/look` in `results.json` have the same two "
      "numbers. Means "
      "in `numbers.csv` and\n"
      "`points/*/quantities` are of the same seeds, and their half-widths of the same level.\n\n"
      "## Make it again\n\n"
      "```\n"
      "peclet run {0}\n"
      "peclet export {0} --canonical | cmp - results.json\n"
      "peclet export {0} --csv --canonical | cmp - results.csv\n"
      "peclet plot {0} --output figure.py\n"
      "```\n\n"
      "The engines of `provenance.json` give the same bytes. Those of another version, compiler or "
      "instruction set "
      "may differ from the\nlast digit on, and agree within the errors.\n",
      file);
  return text;
}

}  // namespace peclet::runner
