#include "runner/page/supplement.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/errors.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/page/figure.h"
#include "runner/page/page_html.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"

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

namespace {

// When a seed last ended; before the first one, when the campaign was last taken up.
std::string last_change(Database& database, const CampaignRecord& campaign) {
  const std::string last_end = database.last_end();
  return last_end.empty() ? campaign.updated_at : last_end;
}

Json provenance_json(Database& database, const CampaignRecord& campaign) {
  Json engines = Json::array();
  for (const EngineRecord& engine : database.engines()) {
    engines.push_back({{"identity", engine.identity}, {"provenance", engine.provenance}});
  }
  const Json& own = provenance();
  return {{"schema_version", 1},
          {"campaign", campaign.name},
          {"campaign_sha256", sha256(canonical_json(campaign.document))},
          {"made_by",
           {{"program", "peclet"},
            {"version", version()},
            {"git_commit", own.value("git_commit", Json())},
            {"git_dirty", own.value("git_dirty", Json())}}},
          {"engines", engines},
          {"machines", database.hosts()},
          {"begun_at", campaign.created_at},
          {"taken_up_at", campaign.updated_at},
          {"last_change_at", last_change(database, campaign)}};
}

std::string sums(const std::vector<ArchivedFile>& files) {
  std::string text;
  for (const ArchivedFile& file : files) text += fmt::format("{}  {}\n", sha256(file.bytes), file.name);
  return text;
}

// Requires a number of the target; refuses it where no figure has a place for one.
Json figure_of(Database& database) try { return figure_data(database, {}); } catch (const InputError& error) {
  throw InputError("", "--bundle", error.value(), error.allowed());
}

}  // namespace

void check_supplement_name(const std::filesystem::path& output) {
  const std::string name = output.filename().string();
  if (name.ends_with(".tar.gz") || name.ends_with(".tgz")) return;
  throw InputError("", "--bundle", output.string(), "must end in .tar.gz or .tgz");
}

std::vector<ArchivedFile> supplement_files(Database& database, std::optional<std::int64_t> owner) {
  const CampaignStatus status = read_status(database);
  const CampaignRecord& campaign = status.campaign;
  const auto has_number = [](const PointSummary& point) { return point.so_far.count > 0; };
  if (std::none_of(status.points.begin(), status.points.end(), has_number)) {
    throw InputError(
        "", "--bundle", campaign.name,
        fmt::format("has no number of {} yet, so that there is nothing to give to readers; `peclet "
                    "explain` says why",
                    campaign.target.target.observable));
  }
  const std::string script = figure_script(figure_of(database));
  std::vector<ArchivedFile> files{{"README.md", supplement_readme(status)},
                                  {campaign.name + ".json", campaign.document.dump(2) + '\n'},
                                  {"results.csv", export_csv(database, true)},
                                  {"numbers.csv", export_long_csv(database)},
                                  {"results.json", export_json(database, true)},
                                  {"report.html", report_html(database, owner)},
                                  {"figure.py", script, true},
                                  {"provenance.json", provenance_json(database, campaign).dump(2) + '\n'}};
  files.push_back({"SHA256SUMS", sums(files)});
  return files;
}

std::string supplement(Database& database, std::optional<std::int64_t> owner) {
  const std::vector<ArchivedFile> files = supplement_files(database, owner);
  const CampaignRecord campaign = database.campaign();
  return gzip(tar(campaign.name, files, seconds_of_utc(last_change(database, campaign))));
}

}  // namespace peclet::runner
