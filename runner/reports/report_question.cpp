// The first section of a report: what was asked.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runner/reports/report_sections.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

constexpr std::size_t most_lines = 40;

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : canonical_json(value);
}

// Every number and word of the scene that is the same at all points, by its pointer.
std::string shared_scene(const std::vector<PointSummary>& points) {
  if (points.empty()) return "";
  std::set<std::string> swept;
  for (const PointSummary& point : points) {
    for (const auto& [pointer, value] : point.point.settings.items()) swept.insert(pointer);
  }
  const auto is_swept = [&](const std::string& pointer) {
    for (const std::string& set : swept) {
      if (pointer == set || pointer.starts_with(set + '/')) return true;
    }
    return false;
  };
  std::string list;
  std::size_t lines = 0;
  const Json flat = points.front().point.scene.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (is_swept(pointer)) continue;
    if (++lines <= most_lines) list += list_item(pointer, value_text(value));
  }
  if (lines > most_lines) list += list_item("and more", "see the campaign at the end of this page");
  return list.empty() ? "" : "<p>All points share this scene:</p>\n<dl class=\"scene\">\n" + list + "</dl>\n";
}

// "peclet: 10, 100, 1000" for what differs.
std::string swept_values(const std::vector<PointSummary>& points) {
  std::string list;
  if (points.empty()) return "";
  for (const auto& [pointer, first] : points.front().point.settings.items()) {
    std::vector<std::string> values;
    for (const PointSummary& point : points) {
      const std::string text = value_text(point.point.settings.value(pointer, Json()));
      if (std::find(values.begin(), values.end(), text) == values.end()) values.push_back(text);
    }
    std::string all;
    for (const std::string& value : values) all += (all.empty() ? "" : ", ") + value;
    list += list_item(pointer, all);
  }
  if (list.empty()) return "";
  return fmt::format("<p>{} points, which differ in:</p>\n<dl>\n", points.size()) + list + "</dl>\n";
}

}  // namespace

std::string question_section(const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  return fmt::format(
             "<section>\n<p>{} at {:g} % confidence, with {} to {} independent realisations "
             "(seeds) of every point.</p>\n",
             escaped(to_string(target.target)), 100 * target.target.confidence, target.minimum,
             target.maximum) +
         swept_values(status.points) + shared_scene(status.points) + "</section>\n";
}

}  // namespace peclet::runner
