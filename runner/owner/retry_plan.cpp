#include "runner/owner/retry_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "contract/errors.h"
#include "runner/campaign/quoting.h"

namespace peclet::runner {
namespace {

// "10 0.5" of "peclet=10 volume_fraction=0.5": what stands in the row of a table.
std::string values_in(const std::string& label) {
  std::istringstream words(label);
  std::string values;
  for (std::string word; words >> word;) {
    const std::size_t sign = word.find('=');
    if (sign != std::string::npos) values += (values.empty() ? "" : " ") + word.substr(sign + 1);
  }
  return values;
}

bool has_name(const PointRecord& point, const std::string& name) {
  return values_in(point.label) == name || (name.size() >= 4 && point.hash.starts_with(name));
}

}  // namespace

std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].label == name) return i;
    if (has_name(points[i], name)) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  constexpr std::size_t most_labels = 12;
  std::vector<std::string> labels;
  labels.reserve(std::min(points.size(), most_labels));
  for (std::size_t i = 0; i < std::min(points.size(), most_labels); ++i)
    labels.push_back(shell_word(points[i].label));
  throw InputError(
      "", "", name,
      fmt::format(
          "must be the label of one point, its values alone, or 4 or more digits of its hash; labels: {}{}",
          fmt::join(labels, ", "), points.size() > most_labels ? ", ..." : ""));
}

namespace {

constexpr const char* would_repeat = "ended with the engine's own verdict, and would end so again";

// Why a seed that was named cannot be retried; "" when it can.
std::string obstacle(const std::vector<RealisationRecord>& realisations, int seed) {
  const auto found = std::find_if(realisations.begin(), realisations.end(),
                                  [&](const RealisationRecord& record) { return record.seed == seed; });
  if (found == realisations.end()) return "has never been queued";
  switch (found->state) {
    case SeedState::quarantined:
      return "";
    case SeedState::failed:
      return fmt::format("{} ({})", would_repeat, found->cause);
    case SeedState::done:
      return "has completed";
    case SeedState::queued:
    case SeedState::running:
      return "was not given up: it is " + std::string(to_string(found->state));
  }
  return "";
}

void check_named(Database& database, const std::vector<PointRecord>& points, const std::vector<int>& seeds) {
  if (seeds.empty()) return;
  if (points.size() != 1) throw InputError("", "", "--seed", "needs the one point whose seeds are meant");
  const std::vector<RealisationRecord> realisations = database.realisations(points.front().id);
  for (const int seed : seeds) {
    if (const std::string why = obstacle(realisations, seed); !why.empty()) {
      throw InputError("", "", fmt::format("--seed {}", seed),
                       fmt::format("cannot be retried: at {} it {}", points.front().label, why));
    }
  }
}

template <typename Item>
std::string listed(const std::vector<Item>& items, const char* separator = ", ") {
  constexpr std::size_t most = 12;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(most, items.size()));
  std::string text = fmt::format("{}", fmt::join(items.begin(), items.begin() + shown, separator));
  if (items.size() > most) text += fmt::format("{}and {} more", separator, items.size() - most);
  return text;
}

std::string plural(std::size_t count) { return fmt::format("{} seed{}", count, count == 1 ? "" : "s"); }

}  // namespace

RetryPlan plan_retry(Database& database, const std::vector<PointRecord>& points,
                     const std::vector<int>& seeds) {
  check_named(database, points, seeds);
  RetryPlan plan;
  std::size_t retried = 0, failed = 0;
  std::vector<std::string> where;
  for (const PointRecord& point : points) {
    std::vector<int> chosen;
    for (const RealisationRecord& record : database.realisations(point.id)) {
      const bool is_meant =
          seeds.empty() || std::find(seeds.begin(), seeds.end(), record.seed) != seeds.end();
      if (record.state == SeedState::failed) ++failed;
      if (record.state == SeedState::quarantined && is_meant) chosen.push_back(record.seed);
    }
    if (chosen.empty()) continue;
    retried += chosen.size();
    where.push_back(fmt::format("{} seed{} {}", point.label, chosen.size() == 1 ? "" : "s", listed(chosen)));
    plan.seeds[point.id] = std::move(chosen);
  }
  plan.message = retried == 0 ? "no seed was given up: there is nothing to retry"
                              : fmt::format("{} queued again, with a clean record: {}", plural(retried),
                                            listed(where, "; "));
  if (failed > 0 && seeds.empty()) plan.message += fmt::format("; {} {}", plural(failed), would_repeat);
  return plan;
}

}  // namespace peclet::runner
