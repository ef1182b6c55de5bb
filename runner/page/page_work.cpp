// Who works on what, and who did last.
#include <algorithm>

#include "runner/page/page_parts.h"

namespace peclet::runner {
namespace {

// However long a campaign is, as many as a chart can show.
constexpr int most_attempts = 300;

using Places = std::map<std::int64_t, std::size_t>;  // in the list of points, by PointRecord::id

Places places_of(const CampaignStatus& status) {
  Places places;
  for (std::size_t i = 0; i < status.points.size(); ++i) places[status.points[i].point.id] = i;
  return places;
}

// The last attempts in the order in which they began. One that runs has no end but when it was last heard of.
Json attempts_json(Connection& connection, const Places& places) {
  Statement query(
      connection,
      "SELECT a.point_id, a.seed, a.worker, a.host, a.started_at, coalesce(a.ended_at, "
      "l.renewed_at, a.started_at), a.outcome FROM attempt a LEFT JOIN lease l USING (attempt_id) "
      "ORDER BY a.attempt_id DESC LIMIT ?");
  query.bind(most_attempts);
  Json list = Json::array();
  while (query.step()) {
    const auto place = places.find(query.integer(0));
    if (place == places.end()) continue;
    list.push_back({{"point", place->second},
                    {"seed", query.integer(1)},
                    {"worker", query.integer(2)},
                    {"host", query.text(3)},
                    {"began", query.text(4)},
                    {"ended", query.text(5)},
                    {"outcome", query.text(6)}});
  }
  std::reverse(list.begin(), list.end());
  return list;
}

Json workers_json(const CampaignStatus& status) {
  Json list = Json::array();
  if (!status.owner) return list;
  for (std::size_t i = 0; i < status.points.size(); ++i) {
    for (const LeaseRecord& lease : status.points[i].leases) {
      list.push_back({{"worker", lease.worker},
                      {"point", i},
                      {"seed", lease.seed},
                      {"phase", lease.phase},
                      {"step", lease.step},
                      {"steps", lease.steps},
                      {"strain", lease.strain}});
    }
  }
  return list;
}

}  // namespace

Json page_work(Database& database, const CampaignStatus& status) {
  return {{"now", workers_json(status)},
          {"attempts", attempts_json(database.connection(), places_of(status))}};
}

}  // namespace peclet::runner
