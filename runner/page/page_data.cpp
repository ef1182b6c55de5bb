#include "runner/page/page_data.h"

#include "contract/sha256.h"
#include "runner/page/page_parts.h"
#include "runner/reports/export.h"

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

Json warnings_json(const CampaignStatus& status, const std::vector<FirstResult>& first) {
  Json list = Json::array();
  for (std::size_t place = 0; place < first.size(); ++place) {
    for (const Json& warning : first[place].warnings) {
      list.push_back({{"point", status.points[place].point.label},
                      {"code", warning.value("code", "")},
                      {"message", warning.value("message", "")}});
    }
  }
  return list;
}

}  // namespace

Json page_data(Database& database, std::optional<std::int64_t> owner) {
  CampaignStatus status = read_status(database);
  status.owner = owner;
  const PagePoints points = page_points(database, status);
  const std::string results = sha256(export_csv(database, true));
  return {{"schema_version", 1},
          {"campaign", status.campaign.name},
          {"target", target_json(status.campaign.target)},
          {"progress", page_progress(database, status)},
          {"parameters", page_parameters(status)},
          {"quantities", quantities_json(points.drawables)},
          {"points", points.points},
          {"meanings", page_meanings(status)},
          {"warnings", warnings_json(status, points.first)},
          {"scene", page_scene(status)},
          {"provenance", page_provenance(database, status, results)},
          {"commands", page_commands(status, results)},
          {"document", status.campaign.document}};
}

}  // namespace peclet::runner
