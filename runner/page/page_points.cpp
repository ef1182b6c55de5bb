// The points of the page, with the numbers of each in columns that all share.
#include <map>
#include <utility>

#include "runner/page/page_parts.h"

namespace peclet::runner {
namespace {

// Columns by path and unit, in the order in which they are first met.
class Columns {
 public:
  std::size_t of(const Drawable& one) {
    const auto [known, is_new] = places_.emplace(std::make_pair(one.path, one.unit), drawables.size());
    if (is_new) drawables.push_back(one);
    return known->second;
  }
  std::vector<Drawable> drawables;

 private:
  std::map<std::pair<std::string, std::string>, std::size_t> places_;
};

Json estimates_json(const KnownPoint& known, Columns& columns) {
  Json estimates = Json::array();
  for (std::size_t place = 0; place < known.drawables.size(); ++place) {
    const std::size_t column = columns.of(known.drawables[place]);
    while (estimates.size() <= column) estimates.push_back(nullptr);
    estimates[column] = known.estimates[place];
  }
  return estimates;
}

Json point_json(const PointSummary& point, const std::optional<int>& looked_at) {
  const StateCounts& counts = point.counts;
  return {{"label", point.point.label},
          {"hash", point.point.hash},
          {"settings", point.point.settings},
          {"standing", standing_word(point)},
          {"verdict", verdict_text(point)},
          {"marks", reservations(point)},
          {"decided", point.decided},
          {"seeds",
           {{"looked_at", looked_at ? Json(*looked_at) : Json(nullptr)},
            {"wanted", point.wanted},
            {"wanted_ended", point.wanted_ended},
            {"ended", counts.terminal()},
            {"running", counts.running},
            {"surplus", point.surplus()}}},
          {"endings", to_json(point.endings)},
          {"losses", point.losses},
          {"loss_reasons", point.loss_reasons},
          {"flags", point.flags},
          {"cpu_seconds", counts.cpu_seconds}};
}

std::optional<int> seeds_looked_at(const PointSummary& point) {
  return point.looks.empty() ? std::nullopt : std::optional(point.looks.back().seeds);
}

}  // namespace

PagePoints page_points(Database& database, const CampaignStatus& status, KnownPoints& known) {
  NumberStore book(database.connection());
  Columns columns;
  PagePoints page;
  for (const PointSummary& point : status.points) {
    KnownPoint& of_point = known[point.point.id];
    if (of_point.key != key_of(point, status.campaign.target)) {
      of_point = read_point(database, book, status.campaign.target, point);
    }
    Json json = point_json(point, seeds_looked_at(point));
    json.update(of_point.json);
    json["estimates"] = estimates_json(of_point, columns);
    page.points.push_back(std::move(json));
  }
  // What only later points have is missing at the earlier ones.
  for (Json& point : page.points) {
    while (point["estimates"].size() < columns.drawables.size()) point["estimates"].push_back(nullptr);
  }
  page.drawables = std::move(columns.drawables);
  return page;
}

}  // namespace peclet::runner
