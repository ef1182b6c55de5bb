#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "runner/campaign/number_text.h"
#include "runner/reports/status.h"

namespace peclet::runner {
namespace {

// Returns the parameter with the most values, of those that are numbers at every point; "" without one.
std::string swept_most(const CampaignStatus& status) {
  std::map<std::string, std::set<double>> values;
  for (const auto& [pointer, value] : status.points.front().point.settings.items()) {
    const auto is_number_at = [&, name = pointer](const PointSummary& point) {
      return point.point.settings.contains(name) && point.point.settings[name].is_number();
    };
    if (!std::all_of(status.points.begin(), status.points.end(), is_number_at)) continue;
    for (const PointSummary& point : status.points) {
      values[pointer].insert(point.point.settings[pointer].get<double>());
    }
  }
  const auto most = std::max_element(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
  return most == values.end() ? "" : most->first;
}

std::string last_step(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

// The height of a mean between the smallest and the largest one, from 0 to 1.
class Scale {
 public:
  explicit Scale(const std::vector<double>& means) {
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    constexpr double decades_from = 5;
    logarithmic_ = *low > 0 && *high >= decades_from * *low;
    low_ = along(*low);
    width_ = along(*high) - low_;
  }
  double height(double mean) const { return width_ > 0 ? (along(mean) - low_) / width_ : 0; }

 private:
  double along(double mean) const { return logarithmic_ ? std::log(mean) : mean; }
  bool logarithmic_ = false;
  double low_ = 0, width_ = 0;
};

// The means over the axis; NaN without a mean, infinite if the point has jammed.
using Points = std::map<double, double>;
constexpr double jammed = std::numeric_limits<double>::infinity();

const char* sign(double mean, const Scale& scale) {
  constexpr std::array<const char*, 8> bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  if (std::isnan(mean)) return "·";
  if (mean == jammed) return "×";
  return bars[static_cast<std::size_t>(std::lround(7 * scale.height(mean)))];
}

// Returns the first and the last mean as "5.39 to 8.52".
std::string ends(const Points& curve) {
  std::vector<double> means;
  for (const auto& [x, mean] : curve) {
    if (std::isfinite(mean)) means.push_back(mean);
  }
  if (means.empty()) return "-";
  return means.size() == 1 ? rough(means.front()) : rough(means.front()) + " to " + rough(means.back());
}

}  // namespace

std::string settings_text(const Json& settings, const std::function<bool(const std::string&)>& is_named) {
  std::string text;
  for (const auto& [pointer, value] : settings.items()) {
    if (!is_named(pointer)) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", last_step(pointer),
                        value.is_number() ? rough(value.get<double>()) : value.dump());
  }
  return text;
}

std::string curve_text(const CampaignStatus& status, std::size_t width) {
  constexpr std::size_t fewest = 3, widest = 48;
  if (status.points.empty()) return "";
  const std::string axis = swept_most(status);
  const auto is_beside = [&](const std::string& pointer) { return pointer != axis; };
  std::map<std::string, Points> curves;
  std::vector<double> means;
  for (const PointSummary& point : status.points) {
    if (axis.empty()) break;
    const double estimate = point.decided ? point.stop_tests.back().controlled.mean : point.all_seeds.mean;
    const double mean = point.endings.has_jammed() ? jammed : estimate;
    curves[settings_text(point.point.settings, is_beside)][point.point.settings[axis].get<double>()] = mean;
    if (std::isfinite(mean)) means.push_back(mean);
  }
  std::size_t name = 0, values = 0;
  for (const auto& [beside, curve] : curves) {
    name = std::max(name, beside.size());
    values = std::max(values, curve.size());
  }
  if (means.size() < fewest || values < fewest) return "";
  const Scale scale(means);
  const std::size_t each = std::clamp<std::size_t>(widest / values, 1, 4);
  const Points& first = curves.begin()->second;
  std::string text = fmt::format("{} over {}, {} to {}\n", status.campaign.target.target.observable,
                                 last_step(axis), rough(first.begin()->first), rough(first.rbegin()->first));
  std::size_t longest = text.size() - 1;
  for (const auto& [beside, curve] : curves) {
    const std::string numbers = ends(curve);
    longest = std::max(longest, name + (name > 0 ? 2 : 0) + each * values + 2 + numbers.size());
    const std::string gap(each * (values - curve.size()) + 2, ' ');
    if (name > 0) text += fmt::format("{:<{}}  ", beside, name);
    for (const auto& [x, mean] : curve) {
      for (std::size_t i = 0; i < each; ++i) text += sign(mean, scale);
    }
    text += gap + numbers + '\n';
  }
  return longest <= width ? text : "";
}

}  // namespace peclet::runner
