#include "runner/jamming/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "contract/input_error.h"
#include "contract/nearest_name.h"
#include "runner/figure/swept.h"
#include "runner/page/page_parts.h"
#include "runner/reports/status.h"
#include "runner/store/vocabulary.h"

namespace peclet::runner {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

bool is_soft(const JammingPoint& point, double softest) {
  constexpr double largest_over_mean = 10;
  if (point.overlap) return *point.overlap > softest;
  return point.largest_overlap && *point.largest_overlap > largest_over_mean * softest;
}

// Sets the state, and what the seeds of the look, or all that have ended, say.
void judge(JammingPoint& made, Database& database, const PointSummary& point, double softest) {
  const int end = point.looks.empty() ? std::numeric_limits<int>::max() : point.looks.back().seeds;
  RunningEstimate overlaps;
  for (const RealisationRecord& seed : database.realisations(point.point.id)) {
    made.cpu_seconds += seed.cpu_seconds.value_or(0);
    const bool counts = seed.seed < end && seed.state == SeedState::done;
    if (counts && seed.largest_overlap) overlaps.add(*seed.largest_overlap);
  }
  if (overlaps.estimate().count > 0) made.largest_overlap = overlaps.estimate().mean;
  const Endings& endings = point.endings;
  made.ended = endings.ended;
  made.jammed = endings.jammed;
  if (point.point.suspect) {
    made.state = "suspect";
  } else if (made.ended == 0) {
    made.state = "open";
  } else if (endings.has_jammed()) {
    made.state = "jammed";
  } else if (2 * endings.lost >= endings.ended) {
    made.state = "lost";
  } else if (endings.has_partly_jammed()) {
    made.state = "partly jammed";
  } else {
    made.state = is_soft(made, softest) ? "soft" : "flowing";
  }
}

std::optional<std::size_t> place_of(const std::vector<Drawable>& drawables, const std::string& path) {
  for (std::size_t column = 0; column < drawables.size(); ++column) {
    if (drawables[column].path == path) return column;
  }
  return std::nullopt;
}

// The place of the quantity among what has been measured; none where nothing has.
std::optional<std::size_t> column_of(const std::vector<Drawable>& drawables, const std::string& quantity) {
  if (drawables.empty()) return std::nullopt;
  const std::string path = quantity.starts_with('/') ? quantity.substr(1) : quantity;
  if (const std::optional<std::size_t> place = place_of(drawables, path)) return place;
  std::vector<std::string> names;
  names.reserve(drawables.size());
  for (const Drawable& one : drawables) names.push_back(one.path);
  throw InputError("", "--quantity", quantity, "must be a number that is measured" + suggestion(path, names));
}

Estimate estimate_of(const Json& point, const std::optional<std::size_t>& column) {
  const Json numbers = column ? point.at("estimates").at(*column) : Json();
  if (numbers.is_null()) return {0, not_known, not_known};
  const auto number = [&](std::size_t place) {
    return numbers[place].is_number() ? numbers[place].get<double>() : not_known;
  };
  return {numbers[3].get<int>(), number(0), number(1)};
}

void require_fractions(const Swept& axis, const std::string& name) {
  const bool are_fractions = axis.numeric && std::all_of(axis.numbers.begin(), axis.numbers.end(),
                                                         [](double phi) { return phi > 0 && phi < 1; });
  if (are_fractions && !axis.pointer.empty()) return;
  throw InputError("", "--over", name, "must be a swept volume fraction: numbers > 0 and < 1");
}

// Sets "μ = 0.5, Pe = 10", by which curves are told apart, and the same by pointer. A key without a symbol
// has the last step of its pointer.
void name_curve(JammingCurve& curve, const std::vector<const Swept*>& by, const Json& point,
                std::size_t place) {
  curve.settings = Json::object();
  for (const Swept* const one : by) {
    curve.name += fmt::format("{}{} = {}", curve.name.empty() ? "" : ", ", one->name, one->words[place]);
    curve.settings[one->pointer] = point.at("settings").value(one->pointer, Json());
  }
}

}  // namespace

JammingCurves read_curves(Database& database, const CurveChoice& choice) {
  const CampaignStatus status = read_status(database);
  KnownPoints known;
  const PagePoints page = page_points(database, status, known);
  const std::vector<Swept> swept =
      swept_parameters(page_parameters(status, kept_vocabulary(database)), page.points);
  const Swept& axis = chosen_axis(swept, choice.over, "--over");
  require_fractions(axis, choice.over);
  const std::vector<const Swept*> by = curves_by(swept, axis);
  const std::optional<std::size_t> column = column_of(page.drawables, choice.quantity);
  const std::optional<std::size_t> overlaps = place_of(page.drawables, "mean_overlap");
  JammingCurves made{status.campaign.name, choice.quantity, axis.pointer, {}};
  std::map<std::string, std::size_t> places;  // of curves, by their settings
  for (std::size_t i = 0; i < page.points.size(); ++i) {
    JammingCurve named;
    name_curve(named, by, page.points[i], i);
    const auto [place, is_new] = places.emplace(named.settings.dump(), made.curves.size());
    if (is_new) made.curves.push_back(std::move(named));
    JammingPoint point;
    point.label = status.points[i].point.label;
    point.fraction = axis.numbers[i];
    point.estimate = estimate_of(page.points[i], column);
    if (const Estimate overlap = estimate_of(page.points[i], overlaps); overlap.count > 0) {
      point.overlap = overlap.mean;
    }
    judge(point, database, status.points[i], choice.softest);
    made.curves[place->second].points.push_back(std::move(point));
  }
  for (JammingCurve& curve : made.curves) {
    std::stable_sort(curve.points.begin(), curve.points.end(),
                     [](const JammingPoint& a, const JammingPoint& b) { return a.fraction < b.fraction; });
  }
  return made;
}

}  // namespace peclet::runner
