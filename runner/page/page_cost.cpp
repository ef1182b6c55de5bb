// What the campaign has cost and is expected to cost, and who works on it.
#include <cmath>

#include "runner/page/page_parts.h"
#include "runner/statistics/forecast.h"

namespace peclet::runner {
namespace {

// Of the seeds that have ended, by point.
std::map<std::int64_t, Cost> costs(Connection& connection) {
  Statement query(
      connection,
      "SELECT point_id, count(cpu_seconds), total(cpu_seconds), total(cpu_seconds * cpu_seconds) FROM "
      "realisation GROUP BY point_id");
  std::map<std::int64_t, Cost> found;
  while (query.step()) {
    found[query.integer(0)] = {static_cast<int>(query.integer(1)), query.real(2), query.real(3)};
  }
  return found;
}

// Of the target's observables.
std::vector<Estimate> so_far(Database& database, const PointRecord& point, std::size_t observables) {
  std::vector<RunningEstimate> sums(observables);
  for (const std::optional<Outcome>& outcome : database.outcomes(point.id)) {
    if (!outcome) continue;
    for (std::size_t place = 0; place < observables; ++place) {
      const Observation of = outcome->of(place);
      if (!std::isnan(of.value)) sums[place].add(of.value + of.control);
    }
  }
  std::vector<Estimate> estimates;
  estimates.reserve(sums.size());
  for (const RunningEstimate& sum : sums) estimates.push_back(sum.estimate());
  return estimates;
}

// Processor time, as one worker after another would take it; null where nothing is known yet.
Json to_go(Database& database, const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  const std::size_t observables = target.target.observables().size();
  std::map<std::int64_t, Cost> cost = costs(database.connection());
  std::vector<PointForecast> points;
  for (const PointSummary& point : status.points) {
    PointForecast forecast;
    forecast.cost = cost[point.point.id];
    forecast.decided = !point.open();
    forecast.ended = point.counts.terminal();
    forecast.running = point.counts.running;
    if (!forecast.decided) forecast.so_far = so_far(database, point.point, observables);
    points.push_back(std::move(forecast));
  }
  const std::optional<TimeToGo> found = time_to_go(points, target.target, target.minimum, target.maximum, 1);
  if (!found) return nullptr;
  return {{"likely", found->likely}, {"low", found->low}, {"high", found->high}};
}

}  // namespace

Json page_progress(Database& database, const CampaignStatus& status) {
  int decided = 0, ended = 0, lost = 0, surplus = 0, running = 0;
  std::size_t workers = 0;
  double cpu_seconds = 0;
  std::map<std::string, int> standings;
  for (const PointSummary& point : status.points) {
    ++standings[standing_word(point)];
    decided += point.decided ? 1 : 0;
    ended += point.counts.terminal();
    lost += point.lost();
    surplus += point.surplus();
    running += point.counts.running;
    workers += point.leases.size();
    cpu_seconds += point.counts.cpu_seconds;
  }
  int handed_over = 0;
  for (const HandedOver& bundle : status.handed_over) handed_over += bundle.seeds;
  return {{"points", status.points.size()},
          {"decided", decided},
          {"standings", standings},
          {"seeds",
           {{"ended", ended},
            {"lost", lost},
            {"surplus", surplus},
            {"running", running},
            {"handed_over", handed_over}}},
          {"cpu_seconds", cpu_seconds},
          {"cpu_seconds_to_go", to_go(database, status)},
          {"owner", status.owner ? Json(*status.owner) : Json(nullptr)},
          {"workers", status.owner ? Json(workers) : Json(nullptr)}};
}

}  // namespace peclet::runner
