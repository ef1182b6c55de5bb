#include "runner/requests/campaign_changes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "runner/text/number_text.h"

namespace peclet::runner {
namespace {

void compare(std::vector<std::string>& changes, const char* what, const std::string& before,
             const std::string& after) {
  if (before != after) changes.push_back(fmt::format("{} {} -> {}", what, before, after));
}

std::string also_text(const Target& target) { return target.also.empty() ? "none" : to_string(target.also); }

// "minimum 10 -> 20"; where one of both is fixed, "realisations 8 to 100 -> 16".
void compare_realisations(std::vector<std::string>& changes, const TargetRecord& before,
                          const Campaign& after) {
  const int minimum = after.minimum_realisations, maximum = after.maximum_realisations;
  if (!before.target.has_tolerance() || !after.target.has_tolerance()) {
    compare(changes, "realisations", range_text(before.minimum, before.maximum),
            range_text(minimum, maximum));
    return;
  }
  compare(changes, "minimum", std::to_string(before.minimum), std::to_string(minimum));
  compare(changes, "maximum", std::to_string(before.maximum), std::to_string(maximum));
}

std::string exact_percent(double share) { return fmt::format("{:.6g} %", 100 * share); }

std::string points_text(std::ptrdiff_t count, const char* what) {
  return fmt::format("{} point{} {}", count, count == 1 ? "" : "s", what);
}

void compare_points(std::vector<std::string>& changes, Database& database, const Campaign& campaign) {
  std::set<std::string> before, after;
  for (const PointRecord& point : database.points()) before.insert(point.hash);
  for (const StatePoint& point : campaign.points) after.insert(point.hash);
  const auto missing_in = [](const std::set<std::string>& those, const std::set<std::string>& these) {
    return std::count_if(these.begin(), these.end(),
                         [&](const std::string& hash) { return !those.contains(hash); });
  };
  if (const auto added = missing_in(before, after); added > 0) changes.push_back(points_text(added, "added"));
  if (const auto left = missing_in(after, before); left > 0) changes.push_back(points_text(left, "left out"));
}

}  // namespace

std::string describe_changes(Database& database, const Campaign& campaign) {
  const CampaignRecord known = database.campaign();
  const Target& before = known.target.target;
  const Target& after = campaign.target;
  std::vector<std::string> changes;
  compare(changes, "observable", before.observable, after.observable);
  compare(changes, "tolerance", to_string(before.tolerance), to_string(after.tolerance));
  compare(changes, after.has_tolerance() ? "further targets" : "also shown", also_text(before),
          also_text(after));
  compare(changes, "confidence", exact_percent(before.confidence), exact_percent(after.confidence));
  compare_realisations(changes, known.target, campaign);
  const auto kept = [](const Json& document) { return document.value("keep_files", Json("all")).dump(); };
  compare(changes, "files kept", kept(known.document), kept(campaign.document));
  compare_points(changes, database, campaign);
  if (!changes.empty()) return fmt::format("{}", fmt::join(changes, "; "));
  return known.document == campaign.document ? "nothing differs" : "the file, in nothing that decides";
}

}  // namespace peclet::runner
