// The scene in words: what the sweep sets, what all points share, and what the engine calls each key.
#include <algorithm>
#include <set>

#include "runner/page/page_data.h"

namespace peclet::runner {
namespace {

std::set<std::string> swept_pointers(const CampaignStatus& status) {
  std::set<std::string> pointers;
  for (const PointSummary& point : status.points) {
    for (const auto& [pointer, value] : point.point.settings.items()) pointers.insert(pointer);
  }
  return pointers;
}

}  // namespace

Json page_parameters(const CampaignStatus& status, const Vocabulary& words) {
  Json list = Json::array();
  for (const std::string& pointer : swept_pointers(status)) list.push_back(words.key(pointer));
  return list;
}

Json page_scene(const CampaignStatus& status, const Vocabulary& words) {
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
    list.push_back(words.key(pointer));
    list.back()["value"] = value;
  }
  return list;
}

}  // namespace peclet::runner
