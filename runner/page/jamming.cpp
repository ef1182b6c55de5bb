#include "runner/page/jamming.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/quoting.h"
#include "runner/owner/open_campaign.h"
#include "runner/page/package_module.h"
#include "runner/page/swept.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {
namespace {

bool is_soft(const Json& point, double softest) {
  constexpr double largest_over_mean = 10;
  if (point["overlap"].is_number()) return point["overlap"] > softest;
  return point["largest_overlap"].is_number() && point["largest_overlap"] > largest_over_mean * softest;
}

std::string state_of(const PointSummary& point, const Json& known, double softest) {
  const Endings& endings = point.endings;
  if (point.point.suspect) return "suspect";
  if (endings.ended == 0) return "open";
  if (endings.has_jammed()) return "jammed";
  if (2 * endings.lost >= endings.ended) return "lost";
  if (endings.has_partly_jammed()) return "partly jammed";
  return is_soft(known, softest) ? "soft" : "flowing";
}

// Adds the numbers of the point's seeds to `made`. The overlap is that of the seeds of the last stop test, or
// before the first one of all that have ended.
void add_seeds(Json& made, Database& database, const PointSummary& point) {
  const int end = point.stop_tests.empty() ? std::numeric_limits<int>::max() : point.stop_tests.back().seeds;
  RunningEstimate overlaps;
  double cpu_seconds = 0;
  for (const RealisationRecord& seed : database.realisations(point.point.id)) {
    cpu_seconds += seed.cpu_seconds.value_or(0);
    const bool counts = seed.seed < end && seed.state == SeedState::done;
    if (counts && seed.largest_overlap) overlaps.add(*seed.largest_overlap);
  }
  const bool is_known = overlaps.estimate().count > 0;
  made["largest_overlap"] = is_known ? Json(overlaps.estimate().mean) : Json(nullptr);
  made["seeds"] = point.endings.ended;
  made["jammed"] = point.endings.jammed;
  made["cpu_seconds"] = cpu_seconds;
}

// Returns [mean, standard error, half-width, count] of the point, as in KnownPoint; nulls and 0 if unknown.
Json numbers_of(const Json& point, const std::optional<std::size_t>& column) {
  const Json numbers = column ? point.at("estimates").at(*column) : Json();
  return numbers.is_null() ? Json{nullptr, nullptr, nullptr, 0} : numbers;
}

void require_fractions(const Swept& axis, const std::string& name) {
  const bool are_fractions = axis.numeric && std::all_of(axis.numbers.begin(), axis.numbers.end(),
                                                         [](double phi) { return phi > 0 && phi < 1; });
  if (are_fractions && !axis.pointer.empty()) return;
  throw InputError("", "--over", name, "must be a swept volume fraction: numbers > 0 and < 1");
}

// Returns a curve without points, named by its settings: "μ = 0.5, Pe = 10". A key without a symbol is named
// by the last step of its pointer.
Json named_curve(const std::vector<const Swept*>& by, const Json& point, std::size_t place) {
  std::vector<std::string> names;
  Json settings = Json::object();
  for (const Swept* const one : by) {
    names.push_back(one->name + " = " + one->words[place]);
    settings[one->pointer] = point.at("settings").value(one->pointer, Json());
  }
  return {{"name", fmt::format("{}", fmt::join(names, ", "))},
          {"settings", std::move(settings)},
          {"points", Json::array()}};
}

}  // namespace

Json read_curves(Database& database, const CurveChoice& choice) {
  const MeasuredSweep sweep = read_sweep(database);
  const Swept& axis = chosen_axis(sweep.swept, choice.over);
  require_fractions(axis, choice.over);
  const std::vector<const Swept*> by = curves_by(sweep.swept, axis);
  const std::vector<Drawable>& drawables = sweep.page.drawables;
  std::optional<std::size_t> column, overlaps;
  if (!drawables.empty()) column = chosen_column(drawables, bare(choice.quantity));
  for (std::size_t place = 0; place < drawables.size(); ++place) {
    if (drawables[place].path == "mean_overlap") overlaps = place;
  }
  Json curves = Json::array();
  std::map<Json, std::size_t> places;  // of curves, by their settings
  for (std::size_t i = 0; i < sweep.status.points.size(); ++i) {
    const PointSummary& summary = sweep.status.points[i];
    const Json& known = sweep.page.points[i];
    Json named = named_curve(by, known, i);
    const auto [place, is_new] = places.emplace(named["settings"], curves.size());
    if (is_new) curves.push_back(std::move(named));
    const Json viscosity = numbers_of(known, column);
    Json point = {{"label", summary.point.label}, {"fraction", axis.numbers[i]},
                  {"mean", viscosity[0]},         {"standard_error", viscosity[1]},
                  {"count", viscosity[3]},        {"overlap", numbers_of(known, overlaps)[0]}};
    add_seeds(point, database, summary);
    point["state"] = state_of(summary, point, choice.softest);
    curves[place->second]["points"].push_back(std::move(point));
  }
  for (Json& curve : curves) {
    std::stable_sort(curve["points"].begin(), curve["points"].end(),
                     [](const Json& a, const Json& b) { return a["fraction"] < b["fraction"]; });
  }
  return {{"campaign", sweep.status.campaign.name},
          {"quantity", choice.quantity},
          {"over", axis.pointer},
          {"curves", std::move(curves)}};
}

namespace {

void check_usage(const JammingOptions& options) {
  if (options.common_exponent && options.exponent)
    throw InputError("", "", "--common-exponent", "does not go together with --exponent");
  if (options.common_exponent && options.by == "steepest")
    throw InputError("", "", "--common-exponent", "belongs to the law, which --by steepest leaves out");
  if (options.propose) return;
  if (options.budget) throw InputError("", "", "--budget", "is for --propose");
  if (!options.write.empty()) throw InputError("", "", "--write", "is for --propose");
}

// Returns the document that the script reads: the curves and the options. `sweep` is for proposals.
Json document_of(const JammingOptions& options, Json curves, const Json& sweep) {
  curves.update({{"softest", options.curves.softest},
                 {"by", options.by},
                 {"exponent", json_or_null(options.exponent)},
                 {"common_exponent", options.common_exponent},
                 {"unit_prefactor", options.unit_prefactor},
                 {"above", options.above},
                 {"propose", options.propose},
                 {"budget", json_or_null(options.budget)},
                 {"json", options.json},
                 {"sweep", sweep}});
  return curves;
}

}  // namespace

Proposal find_jamming(const JammingOptions& options) {
  check_usage(options);
  check_new_file(options.write);
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  const CampaignRecord campaign = open.database.campaign();
  const Json curves = read_curves(open.database, options.curves);
  CampaignSource source;
  Json sweep = Json::array();
  if (options.propose) {
    source = source_of(options.campaign, campaign);
    sweep = sweep_of(source);
  }
  const Json found = answer_of_package("jamming", "jamming_report", "NumPy (Debian: python3-numpy)",
                                       document_of(options, curves, sweep), source.file.string());
  Proposal answer{found.at("text").get<std::string>(), ""};
  if (const std::string note = difference_from_file(options.campaign, options.directory, campaign);
      !note.empty()) {
    answer.message = fmt::format("note: {}\n", note);
  }
  if (!options.write.empty() && found.at("sweep").is_array()) {
    answer.message +=
        write_proposed(options.write, with_value(source.text, {"sweep"}, found["sweep"]), open.directory);
  }
  return answer;
}

}  // namespace peclet::runner
