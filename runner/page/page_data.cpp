#include "runner/page/page_data.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "contract/sha256.h"
#include "runner/page/page_details.h"
#include "runner/page/page_parts.h"
#include "runner/reports/export.h"
#include "runner/store/vocabulary.h"

namespace peclet::runner {
namespace {

Json target_json(const TargetRecord& target) {
  Json json = to_json(target.target);
  json["text"] = to_string(target.target);
  json["minimum"] = target.minimum;
  json["maximum"] = target.maximum;
  return json;
}

Json quantities_json(const std::vector<Drawable>& drawables) {
  Json list = Json::array();
  for (const Drawable& one : drawables) {
    list.push_back({{"path", one.path},
                    {"name", one.name},
                    {"element", one.element},
                    {"symbol", one.symbol},
                    {"unit", one.unit}});
  }
  return list;
}

Json warnings_json(const CampaignStatus& status, const KnownPoints& known) {
  Json list = Json::array();
  for (const PointSummary& point : status.points) {
    for (const Json& warning : known.at(point.point.id).first.warnings) {
      list.push_back({{"point", point.point.label},
                      {"code", warning.value("code", "")},
                      {"message", warning.value("message", "")}});
    }
  }
  return list;
}

Json details_of(Database& database, const PointSummary& point, const TargetRecord& target, int seeds) {
  const int end = point.looks.empty() ? std::numeric_limits<int>::max() : point.looks.back().seeds;
  return point_details(database, point.point.id, end, target, seeds);
}

// Of as many seeds of each as can be read in a second or two.
void add_details(Database& database, const CampaignStatus& status, Json& points) {
  constexpr int most_results = 1000, fewest_seeds = 4;
  const int each = std::clamp(most_results / std::max(1, static_cast<int>(points.size())), fewest_seeds,
                              most_detailed_seeds);
  for (std::size_t place = 0; place < points.size(); ++place) {
    points[place]["details"] = details_of(database, status.points[place], status.campaign.target, each);
  }
}

}  // namespace

Json PageReader::read(Database& database, std::optional<std::int64_t> owner, bool whole) {
  status_ = read_status(database);
  status_.owner = owner;
  const CampaignStatus& status = status_;
  const Vocabulary words = kept_vocabulary(database);
  PagePoints points = page_points(database, status, known_);
  if (whole) add_details(database, status, points.points);
  const std::string results = whole ? sha256(export_csv(database, true)) : "";
  return {{"schema_version", 1},
          {"campaign", status.campaign.name},
          {"target", target_json(status.campaign.target)},
          {"progress", page_progress(status)},
          {"parameters", page_parameters(status, words)},
          {"quantities", quantities_json(points.drawables)},
          {"derived", words.derived()},
          {"points", std::move(points.points)},
          {"work", page_work(database, status)},
          {"meanings", page_meanings(status)},
          {"warnings", warnings_json(status, known_)},
          {"scene", page_scene(status, words)},
          {"provenance", page_provenance(database, status, results)},
          {"commands", page_commands(status, results)},
          {"document", status.campaign.document}};
}

const PointSummary* PageReader::find(const std::string& hash) const {
  const auto found = std::find_if(status_.points.begin(), status_.points.end(),
                                  [&](const PointSummary& point) { return point.point.hash == hash; });
  return found == status_.points.end() ? nullptr : &*found;
}

std::optional<std::string> PageReader::key(const std::string& hash) const {
  const PointSummary* const point = find(hash);
  return point == nullptr ? std::nullopt : std::optional(known_.at(point->point.id).key);
}

Json PageReader::details(Database& database, const std::string& hash) const {
  return details_of(database, *find(hash), status_.campaign.target, most_detailed_seeds);
}

Json page_data(Database& database, std::optional<std::int64_t> owner) {
  return PageReader().read(database, owner, true);
}

}  // namespace peclet::runner
