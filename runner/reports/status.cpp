#include "runner/reports/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/exit_codes.h"
#include "runner/reports/prediction_text.h"
#include "runner/statistics/look_json.h"

namespace peclet::runner {
namespace {

Json lease_json(const LeaseRecord& lease) {
  return {
      {"seed", lease.seed},   {"worker", lease.worker}, {"phase", lease.phase},          {"step", lease.step},
      {"steps", lease.steps}, {"strain", lease.strain}, {"renewed_at", lease.renewed_at}};
}

Json bundles_json(const std::vector<HandedOver>& bundles) {
  Json list = Json::array();
  for (const HandedOver& bundle : bundles) {
    list.push_back({{"bundle", bundle.bundle},
                    {"job", bundle.job.empty() ? Json(nullptr) : Json(bundle.job)},
                    {"seeds", bundle.seeds}});
  }
  return list;
}

Json point_json(const PointSummary& point) {
  Json workers = Json::array();
  for (const LeaseRecord& lease : point.leases) workers.push_back(lease_json(lease));
  Json kept_apart = Json::array();
  for (const KeptApart& kept : point.kept_apart)
    kept_apart.push_back({{"engine", kept.engine}, {"results", kept.results}});
  const StateCounts& counts = point.counts;
  return {{"label", point.point.label},
          {"hash", point.point.hash},
          {"settings", point.point.settings},
          {"verdict", point.decided ? Json(to_string(point.looks.back().verdict)) : Json(nullptr)},
          {"suspect", point.point.suspect},
          {"cancelled", point.point.cancelled},
          {"priority", point.point.priority},
          {"kept_apart", kept_apart},
          {"seeds",
           {{"wanted", point.wanted},
            {"wanted_ended", point.wanted_ended},
            {"queued", counts.queued},
            {"running", counts.running},
            {"done", counts.done},
            {"failed", counts.failed},
            {"quarantined", counts.quarantined},
            {"surplus", point.surplus()}}},
          {"losses", point.losses},
          {"loss_reasons", point.loss_reasons},
          {"flags", point.flags},
          {"reservations", reservations(point)},
          {"endings", to_json(point.endings)},
          {"so_far", estimate_json(point.so_far)},
          {"look", point.looks.empty() ? Json(nullptr) : look_json(point.looks.back())},
          {"cpu_seconds", counts.cpu_seconds},
          {"prediction", prediction_json(point)},
          {"workers", workers}};
}

}  // namespace

CampaignStatus read_status(Database& database) {
  CampaignStatus status;
  status.campaign = database.campaign();
  status.points = summarise_points(database, status.campaign.target);
  status.forecasts = forecasts_of(database, status.points);
  status.handed_over = BundleStore(database.connection()).handed_over();
  if (status.handed_over.empty()) {
    const TargetRecord& target = status.campaign.target;
    status.to_go = time_to_go(status.forecasts, target.target, target.minimum, target.maximum,
                              std::max(1, database.last_workers()));
  }
  return status;
}

int standing(const CampaignStatus& status) {
  const auto any = [&](auto is) { return std::any_of(status.points.begin(), status.points.end(), is); };
  if (any([](const PointSummary& point) { return point.point.suspect; })) return ExitCode::integrity;
  if (any([](const PointSummary& point) { return point.open(); })) return ExitCode::unfinished;
  // A point that was cancelled early may have no look.
  const auto is_whole = [](const PointSummary& point) {
    if (!point.decided) return false;
    const Verdict verdict = point.looks.back().verdict;
    return is_reached(verdict) && !has_losses(verdict);
  };
  return std::all_of(status.points.begin(), status.points.end(), is_whole) ? ExitCode::done
                                                                           : ExitCode::unconverged;
}

int ending(const CampaignStatus& status, bool finished) {
  const int code = standing(status);
  if (code == ExitCode::integrity) return code;
  if (!finished) return ExitCode::stopped;
  return code == ExitCode::unfinished ? ExitCode::unconverged : code;
}

std::string standing_word(const PointSummary& point) {
  if (point.decided) return to_string(point.looks.back().verdict);
  return point.point.cancelled ? "cancelled" : "open";
}

std::string verdict_text(const PointSummary& point) {
  std::string text = standing_word(point);
  if (point.decided && has_losses(point.looks.back().verdict)) {
    text += fmt::format("({})", point.looks.back().lost);
  } else if (point.lost() > 0) {
    text += fmt::format(", {} lost", point.lost());
  }
  for (const std::string& reservation : reservations(point)) text += ", " + reservation;
  if (point.decided && point.point.cancelled) text += ", cancelled";
  if (point.point.priority != 0) text += fmt::format(", priority {}", point.point.priority);
  return text;
}

std::vector<std::string> reservations(const PointSummary& point) {
  std::vector<std::string> found;
  if (point.endings.has_jammed()) found.emplace_back("jammed");
  if (!point.looks.empty() && point.looks.back().transient) found.emplace_back("transient");
  if (!point.looks.empty() && point.looks.back().untested) found.emplace_back("no-transient-test");
  if (point.decided && is_skewed(point.looks.back(), point.confidence)) found.emplace_back("skewed");
  if (!point.looks.empty() && point.looks.back().near_maximum) found.emplace_back("near-maximum");
  if (!point.without_interval.empty())
    found.emplace_back(point.looks.back().repeated.empty() ? "equal-values" : "repeated-seeds");
  if (point.earlier_look > 0) found.emplace_back("earlier-look");
  for (const auto& [code, count] : point.flags) {
    if (code == "jammed" && point.endings.has_jammed()) continue;  // said already
    found.push_back(fmt::format("{} flagged {}", count, code));
  }
  if (point.point.suspect) found.emplace_back("suspect");
  return found;
}

Json status_json(const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  Json points = Json::array();
  for (const PointSummary& point : status.points) points.push_back(point_json(point));
  return {{"schema_version", 1},
          {"campaign", status.campaign.name},
          {"target", to_json(target.target)},
          {"realisations", {{"minimum", target.minimum}, {"maximum", target.maximum}}},
          {"owner", status.owner ? Json(*status.owner) : Json(nullptr)},
          {"standing", standing(status)},
          {"seconds_to_go", to_json(status.to_go)},
          {"handed_over", bundles_json(status.handed_over)},
          {"points", points}};
}

}  // namespace peclet::runner
