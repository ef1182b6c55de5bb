// The scene in words: what the sweep sets, what all points share, and what the schema says of each key.
#include <algorithm>
#include <cctype>
#include <set>

#include "runner/page/key_names.h"
#include "runner/page/page_assets.h"
#include "runner/page/page_parts.h"

namespace peclet::runner {
namespace {

const Json& schema() {
  static const Json parsed = Json::parse(scene_schema);
  return parsed;
}

// What the schema of the project's own scenes says of a key; "" for scenes of other engines. Units are in
// brackets.
std::string meaning_of(const std::string& pointer) {
  const Json* place = &schema();
  for (std::size_t at = 1; at <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const std::string step = pointer.substr(at, end - at);
    at = end + 1;
    if (const auto items = place->find("items"); items != place->end()) {
      place = &*items;
      continue;
    }
    const auto properties = place->find("properties");
    if (properties == place->end()) return "";
    const auto below = properties->find(step);
    if (below == properties->end()) return "";
    place = &*below;
  }
  return place->value("description", "");
}

// A key with what is said of it: its meaning, and words and symbol where it has some.
Json described(const std::string& pointer) {
  Json key{{"pointer", pointer}, {"meaning", meaning_of(pointer)}};
  if (const KeyName* const name = key_name(pointer)) {
    key["words"] = name->words;
    key["symbol"] = name->symbol;
  }
  return key;
}

std::set<std::string> swept_pointers(const CampaignStatus& status) {
  std::set<std::string> pointers;
  for (const PointSummary& point : status.points) {
    for (const auto& [pointer, value] : point.point.settings.items()) pointers.insert(pointer);
  }
  return pointers;
}

}  // namespace

Json page_parameters(const CampaignStatus& status) {
  Json list = Json::array();
  for (const std::string& pointer : swept_pointers(status)) {
    list.push_back(described(pointer));
  }
  return list;
}

Json page_scene(const CampaignStatus& status) {
  Json list = Json::array();
  if (status.points.empty()) return list;
  const std::set<std::string> swept = swept_pointers(status);
  const auto is_swept = [&](const std::string& pointer) {
    return std::any_of(swept.begin(), swept.end(), [&](const std::string& set) {
      return pointer == set || pointer.starts_with(set + '/');
    });
  };
  const Json flat = status.points.front().point.scene.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (is_swept(pointer)) continue;
    list.push_back(described(pointer));
    list.back()["value"] = value;
  }
  return list;
}

}  // namespace peclet::runner
