#include "runner/page/jamming.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/engines/command.h"
#include "runner/owner/open_campaign.h"
#include "runner/page/swept.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/own_files.h"

namespace peclet::runner {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

bool is_soft(const JammingPoint& point, double softest) {
  constexpr double largest_over_mean = 10;
  if (point.overlap) return *point.overlap > softest;
  return point.largest_overlap && *point.largest_overlap > largest_over_mean * softest;
}

// Sets the state, and what the seeds of the look, or all that have ended, say.
void judge(JammingPoint& made, Database& database, const PointSummary& point, double softest) {
  const int end = point.looks.empty() ? std::numeric_limits<int>::max() : point.looks.back().seeds;
  RunningEstimate overlaps;
  for (const RealisationRecord& seed : database.realisations(point.point.id)) {
    made.cpu_seconds += seed.cpu_seconds.value_or(0);
    const bool counts = seed.seed < end && seed.state == SeedState::done;
    if (counts && seed.largest_overlap) overlaps.add(*seed.largest_overlap);
  }
  if (overlaps.estimate().count > 0) made.largest_overlap = overlaps.estimate().mean;
  const Endings& endings = point.endings;
  made.ended = endings.ended;
  made.jammed = endings.jammed;
  if (point.point.suspect) {
    made.state = "suspect";
  } else if (made.ended == 0) {
    made.state = "open";
  } else if (endings.has_jammed()) {
    made.state = "jammed";
  } else if (2 * endings.lost >= endings.ended) {
    made.state = "lost";
  } else if (endings.has_partly_jammed()) {
    made.state = "partly jammed";
  } else {
    made.state = is_soft(made, softest) ? "soft" : "flowing";
  }
}

Estimate estimate_of(const Json& point, const std::optional<std::size_t>& column) {
  const Json numbers = column ? point.at("estimates").at(*column) : Json();
  if (numbers.is_null()) return {0, not_known, not_known};
  const auto number = [&](std::size_t place) {
    return numbers[place].is_number() ? numbers[place].get<double>() : not_known;
  };
  return {numbers[3].get<int>(), number(0), number(1)};
}

void require_fractions(const Swept& axis, const std::string& name) {
  const bool are_fractions = axis.numeric && std::all_of(axis.numbers.begin(), axis.numbers.end(),
                                                         [](double phi) { return phi > 0 && phi < 1; });
  if (are_fractions && !axis.pointer.empty()) return;
  throw InputError("", "--over", name, "must be a swept volume fraction: numbers > 0 and < 1");
}

// Sets "μ = 0.5, Pe = 10", by which curves are told apart, and the same by pointer. A key without a symbol
// has the last step of its pointer.
void name_curve(JammingCurve& curve, const std::vector<const Swept*>& by, const Json& point,
                std::size_t place) {
  curve.settings = Json::object();
  for (const Swept* const one : by) {
    curve.name += fmt::format("{}{} = {}", curve.name.empty() ? "" : ", ", one->name, one->words[place]);
    curve.settings[one->pointer] = point.at("settings").value(one->pointer, Json());
  }
}

}  // namespace

JammingCurves read_curves(Database& database, const CurveChoice& choice) {
  const MeasuredSweep sweep = read_sweep(database);
  const Swept& axis = chosen_axis(sweep.swept, choice.over, "--over");
  require_fractions(axis, choice.over);
  const std::vector<const Swept*> by = curves_by(sweep.swept, axis);
  const std::vector<Drawable>& drawables = sweep.page.drawables;
  std::optional<std::size_t> column, overlaps;
  if (!drawables.empty()) column = chosen_column(drawables, bare(choice.quantity));
  for (std::size_t place = 0; place < drawables.size(); ++place) {
    if (drawables[place].path == "mean_overlap") overlaps = place;
  }
  JammingCurves made{sweep.status.campaign.name, choice.quantity, axis.pointer, {}};
  std::map<std::string, std::size_t> places;  // of curves, by their settings
  for (std::size_t i = 0; i < sweep.status.points.size(); ++i) {
    const PointSummary& summary = sweep.status.points[i];
    const Json& json = sweep.page.points[i];
    JammingCurve named;
    name_curve(named, by, json, i);
    const auto [place, is_new] = places.emplace(named.settings.dump(), made.curves.size());
    if (is_new) made.curves.push_back(std::move(named));
    JammingPoint point;
    point.label = summary.point.label;
    point.fraction = axis.numbers[i];
    point.estimate = estimate_of(json, column);
    if (const Estimate overlap = estimate_of(json, overlaps); overlap.count > 0) {
      point.overlap = overlap.mean;
    }
    judge(point, database, summary, choice.softest);
    made.curves[place->second].points.push_back(std::move(point));
  }
  for (JammingCurve& curve : made.curves) {
    std::stable_sort(curve.points.begin(), curve.points.end(),
                     [](const JammingPoint& a, const JammingPoint& b) { return a.fraction < b.fraction; });
  }
  return made;
}

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
