// Who works on what, and who did last.
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

Json attempts_json(Database& database, const Places& places) {
  Json list = Json::array();
  for (const AttemptSpan& span : database.last_attempts(most_attempts)) {
    const auto place = places.find(span.point);
    if (place == places.end()) continue;
    list.push_back({{"point", place->second},
                    {"seed", span.seed},
                    {"worker", span.worker},
                    {"host", span.host},
                    {"began", span.began},
                    {"ended", span.ended},
                    {"outcome", span.outcome}});
  }
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
  return {{"now", workers_json(status)}, {"attempts", attempts_json(database, places_of(status))}};
}

}  // namespace peclet::runner
