#include "runner/archive/supplement.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "runner/archive/supplement_readme.h"
#include "runner/figure/figure.h"
#include "runner/page/page_html.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "runner/text/utc_time.h"

namespace peclet::runner {
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
