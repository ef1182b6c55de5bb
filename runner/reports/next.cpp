#include "runner/reports/next.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/sweep.h"
#include "runner/campaign/text_table.h"
#include "runner/owner/open_campaign.h"
#include "runner/reports/status.h"
#include "runner/statistics/curve_proposal.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {
namespace {

// A curve with its points that have means, and what is proposed for it.
struct Planned {
  std::string name;  // "volume_fraction=0.45"; "" for a single curve
  std::size_t known = 0;
  std::optional<CurvePlan> plan{};  // none while too few points are known

  double width() const { return plan->proposals.empty() ? plan->width : plan->proposals.back().width; }
  double seconds() const {
    double sum = 0;
    for (const CurveProposal& proposal : plan->proposals) sum += proposal.cost;
    return sum;
  }
};

// Returns the settings that all points of the curve share: "volume_fraction=0.45".
std::string name_of(const Curve& curve, const std::vector<PointSummary>& points) {
  const Json& first = points[curve.points.front()].point.settings;
  return settings_text(first, [&](const std::string& pointer) {
    return std::ranges::all_of(curve.points, [&](std::size_t i) {
      return points[i].point.settings.value(pointer, Json()) == first.at(pointer);
    });
  });
}

// Returns the points of the curve whose means have logarithms.
std::vector<KnownOnCurve> known_on(const Curve& curve, const std::vector<PointSummary>& points) {
  std::vector<KnownOnCurve> known;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const PointSummary& point = points[curve.points[k]];
    const bool is_tested = !point.stop_tests.empty();
    const Estimate estimate = is_tested ? point.stop_tests.back().controlled : point.all_seeds;
    const int seeds = is_tested ? point.stop_tests.back().seeds : point.counts.terminal();
    const double seconds = point.counts.cpu_seconds / std::max(1, point.counts.terminal());
    if (!CurveFit::takes(estimate)) continue;
    constexpr double shortest = 1e-6;  // a clock may have measured 0 s
    known.push_back({{curve.axis[k], estimate.mean, estimate.standard_error, estimate.count},
                     seeds,
                     std::max(shortest, seconds)});
  }
  return known;
}

Planned planned(const Curve& curve, const std::vector<PointSummary>& points, const TargetRecord& target,
                const NextOptions& options) {
  Planned made{name_of(curve, points)};
  const bool is_even = target.target.tolerance.is_even;
  const std::vector<KnownOnCurve> known = known_on(curve, points);
  made.known = known.size();
  const ProposalBounds bounds{
      .width = target.target.tolerance.value, .cost = options.budget, .new_points = options.points};
  made.plan =
      plan_curve(known, is_even, stop_test_schedule(target.minimum, target.maximum), target.level(), bounds);
  return made;
}

std::string text_of(const Planned& curve, const Target& target) {
  const std::string heading = curve.name.empty() ? "" : curve.name + ": ";
  if (!curve.plan) {
    return fmt::format("{}the means of {} are known, and a curve needs {}\n", heading,
                       counted(curve.known, "point"), CurveFit::fewest_points);
  }
  const CurvePlan& plan = *curve.plan;
  std::string text = fmt::format("{}the largest half-width of the band is {}, at {} = {}\n", heading,
                                 percent(plan.width), target.over(), fmt::format("{:g}", plan.at));
  if (plan.proposals.empty()) {
    return text +
           (plan.width <= target.tolerance.value
                ? fmt::format("  nothing to add: the tolerance is {:g} %\n", 100 * target.tolerance.value)
                : std::string("  nothing can be added within the budget and the maximum\n"));
  }
  TextTable table;
  table.add_column(target.over());
  table.add_column("point", TextTable::Align::left);
  for (const char* const title : {"seeds", "processor time", "largest half-width then"})
    table.add_column(title);
  for (const CurveProposal& proposal : plan.proposals) {
    table.add_row({fmt::format("{:g}", proposal.axis), proposal.is_new ? "new" : "old",
                   fmt::format("{} to {}", proposal.from, proposal.to), duration_text(proposal.cost),
                   percent(proposal.width)});
  }
  return text + table.text("  ") +
         fmt::format("  processor time {}; largest half-width then {}\n", duration_text(curve.seconds()),
                     percent(curve.width()));
}

Json to_json(const Planned& curve) {
  Json json = {{"name", curve.name}, {"known", curve.known}, {"proposals", Json::array()}};
  if (!curve.plan) return json;
  json["width"] = curve.plan->width;
  json["widest_at"] = curve.plan->at;
  json["width_then"] = curve.width();
  for (const CurveProposal& proposal : curve.plan->proposals) {
    json["proposals"].push_back({{"axis", proposal.axis},
                                 {"new", proposal.is_new},
                                 {"seeds", {proposal.from, proposal.to}},
                                 {"cpu_seconds", proposal.cost},
                                 {"width_then", proposal.width},
                                 {"widest_at", proposal.widest_at}});
  }
  return json;
}

// Returns the members of the campaign file to be changed: the sweep with the new points and, for more seeds
// at points that have met the tolerance, a smaller one. Null if nothing is proposed.
Json patch_of(const std::vector<Planned>& curves, const Target& target, Json sweep) {
  Json patch;
  std::vector<double> values;
  double width = target.tolerance.value;
  for (const Planned& curve : curves) {
    if (!curve.plan) continue;
    bool has_old = false;
    for (const CurveProposal& proposal : curve.plan->proposals) {
      has_old = has_old || !proposal.is_new;
      if (proposal.is_new && std::ranges::find(values, proposal.axis) == values.end())
        values.push_back(proposal.axis);
    }
    if (has_old) width = std::min(width, std::ceil(1e3 * curve.plan->width_at_points) / 1e3);
  }
  for (const double value : values) sweep = with_value_along(std::move(sweep), target.over(), value);
  if (!values.empty()) patch["sweep"] = sweep;
  if (width < target.tolerance.value) patch["target"]["curve"]["relative_tolerance"] = width;
  return patch;
}

}  // namespace

Proposal propose_next(const NextOptions& options) {
  check_new_file(options.write);
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  const CampaignRecord campaign = open.database.campaign();
  const Target& target = campaign.target.target;
  const CampaignSource source = source_of(options.campaign, campaign);
  if (!target.tolerance.is_of_curve()) {
    throw InputError(source.file.string(), "/target", to_string(target),
                     "must have a curve: {\"curve\": {\"over\": POINTER, \"relative_tolerance\": 0.05}}; for "
                     "the volume fraction of jamming there is `peclet jamming --propose`");
  }
  const std::vector<PointSummary> points = summarise_points(open.database, campaign.target);
  std::vector<Planned> curves;
  for (const Curve& curve : curves_of(campaign.document, target))
    curves.push_back(planned(curve, points, campaign.target, options));
  const Json written = sweep_of(source);
  const bool is_the_same = written == campaign.document.at("sweep");
  const Json patch = patch_of(curves, target, is_the_same ? whole_sweep(campaign.document, target) : written);

  Proposal answer;
  if (const std::string note = difference_from_file(options.campaign, options.directory, campaign);
      !note.empty())
    answer.message = fmt::format("note: {}\n", note);
  if (options.json) {
    Json json = {
        {"schema_version", 1}, {"campaign", campaign.name}, {"over", target.over()}, {"patch", patch}};
    for (const Planned& curve : curves) json["curves"].push_back(to_json(curve));
    answer.text = json.dump(2) + '\n';
  } else {
    for (const Planned& curve : curves) answer.text += text_of(curve, target);
    if (curves.size() > 1) answer.text += "a new value is added to every curve\n";
    if (!patch.is_null()) answer.text += "patch of the campaign file:\n" + patch.dump() + '\n';
  }
  if (!options.write.empty() && !patch.is_null()) {
    std::string text = source.text;
    if (patch.contains("sweep")) text = with_value(text, {"sweep"}, patch["sweep"]);
    if (patch.contains("target")) {
      text = with_value(text, {"target", "curve", "relative_tolerance"},
                        patch["target"]["curve"]["relative_tolerance"]);
    }
    answer.message += write_proposed(options.write, text, open.directory);
  }
  return answer;
}

}  // namespace peclet::runner
