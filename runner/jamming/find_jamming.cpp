#include "runner/jamming/find_jamming.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <stdexcept>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "contract/input_file.h"
#include "contract/output_file.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/document_edit.h"
#include "runner/engines/command.h"
#include "runner/owner/open_campaign.h"
#include "runner/statistics/look_json.h"
#include "runner/store/own_files.h"
#include "runner/text/quoting.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

void check_usage(const JammingOptions& options) {
  if (options.common_exponent && options.exponent)
    throw InputError("", "", "--common-exponent", "does not go together with --exponent");
  if (options.common_exponent && options.by == "steepest")
    throw InputError("", "", "--common-exponent", "is of the law, which --by steepest leaves out");
  if (options.propose) return;
  if (options.budget) throw InputError("", "", "--budget", "is for --propose");
  if (!options.write.empty()) throw InputError("", "", "--write", "is for --propose");
}

// Requires nothing of the campaign, so that a refusal comes before the work.
void check_new_file(const fs::path& file) {
  if (file.empty()) return;
  if (fs::symlink_status(file).type() != fs::file_type::not_found) {
    throw InputError(file.string(), "", "--write",
                     "is there already, and is never replaced: name another file");
  }
  check_output(file);
}

// The campaign file as its author wrote it; without one, as it was last run.
struct Source {
  fs::path file;
  std::string text;
};

Source source_of(const JammingOptions& options, const CampaignRecord& campaign) {
  const fs::path file = campaign_file_of(options.campaign);
  if (fs::is_regular_file(file)) return {file, read_input(file)};
  return {options.campaign, campaign.document.dump(2) + '\n'};
}

Json json_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json curves_json(const JammingCurves& campaign) {
  Json curves = Json::array();
  for (const JammingCurve& curve : campaign.curves) {
    Json points = Json::array();
    for (const JammingPoint& point : curve.points) {
      points.push_back({{"label", point.label},
                        {"fraction", point.fraction},
                        {"state", point.state},
                        {"mean", number_json(point.estimate.mean)},
                        {"standard_error", number_json(point.estimate.standard_error)},
                        {"count", point.estimate.count},
                        {"seeds", point.ended},
                        {"jammed", point.jammed},
                        {"overlap", json_or_null(point.overlap)},
                        {"largest_overlap", json_or_null(point.largest_overlap)},
                        {"cpu_seconds", point.cpu_seconds}});
    }
    curves.push_back({{"name", curve.name}, {"settings", curve.settings}, {"points", points}});
  }
  return curves;
}

// What the script reads; `sweep` is that of the source, if points are to be proposed.
Json document_of(const JammingOptions& options, const JammingCurves& campaign, const Json& sweep) {
  return {{"campaign", campaign.campaign},
          {"quantity", campaign.quantity},
          {"over", campaign.over},
          {"softest", options.curves.softest},
          {"by", options.by},
          {"exponent", json_or_null(options.exponent)},
          {"common_exponent", options.common_exponent},
          {"unit_prefactor", options.unit_prefactor},
          {"above", options.above},
          {"propose", options.propose},
          {"budget", json_or_null(options.budget)},
          {"json", options.json},
          {"sweep", sweep},
          {"curves", curves_json(campaign)}};
}

// The script of the package that was installed with this program or is in its source; else the one of a
// package that Python finds by itself.
std::vector<std::string> script_command() {
  const fs::path package = own_folder().parent_path() / "lib/python3/dist-packages/peclet";
  if (fs::exists(package / "jamming_report.py")) return {"python3", (package / "jamming_report.py").string()};
  if (const std::optional<fs::path> source = own_file("python/peclet/jamming_report.py"))
    return {"python3", source->string()};
  return {"python3", "-m", "peclet.jamming_report"};
}

// Throws std::runtime_error if Python, its modules or the script are missing.
Json fitted(const Json& document) {
  constexpr std::chrono::minutes patience(60);
  const std::vector<std::string> command = script_command();
  // The present folder may have any file of the name of a module.
  std::vector<std::string> words{"env", "PYTHONSAFEPATH=1"};
  words.insert(words.end(), command.begin(), command.end());
  const CommandAnswer said = run_command(words, patience, document.dump());
  if (said.succeeded()) return Json::parse(said.output);
  throw std::runtime_error(
      fmt::format("jamming: the fits need python3 with NumPy (Debian: python3-numpy); `{}` has not run: {}",
                  fmt::join(command, " "), said.complaint()));
}

// Throws InputError for a campaign with these points that none may be.
void write_campaign(const fs::path& written, const std::string& source, const Json& sweep) {
  const std::string text = with_value(source, {"sweep"}, sweep);
  parse_campaign(parse_json_input(text, written.string()), written.string());
  write_durably(written, text);
}

std::string written_message(const JammingOptions& options, const CampaignDirectory& directory) {
  return fmt::format("wrote {0}; `peclet run {1} --directory {2}` adds its points to what there is\n",
                     options.write.string(), shell_word(options.write.string()),
                     shell_word(directory.root().string()));
}

}  // namespace

JammingAnswer find_jamming(const JammingOptions& options) {
  check_usage(options);
  check_new_file(options.write);
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  const CampaignRecord campaign = open.database.campaign();
  const JammingCurves curves = read_curves(open.database, options.curves);
  Source source;
  Json sweep = Json::array();
  if (options.propose) {
    source = source_of(options, campaign);
    sweep = parse_json_input(source.text, source.file.string()).value("sweep", sweep);
  }
  const Json found = fitted(document_of(options, curves, sweep));
  if (found.contains("refused")) {
    const auto [place, value, rule] = found["refused"].get<std::array<std::string, 3>>();
    throw InputError(source.file.string(), place, value, rule);
  }
  JammingAnswer answer{found.at("text").get<std::string>(), ""};
  if (const std::string note = difference_from_file(options.campaign, options.directory, campaign);
      !note.empty()) {
    answer.message = fmt::format("note: {}\n", note);
  }
  if (!options.write.empty() && found.at("sweep").is_array()) {
    write_campaign(options.write, source.text, found["sweep"]);
    answer.message += written_message(options, open.directory);
  }
  return answer;
}

}  // namespace peclet::runner
