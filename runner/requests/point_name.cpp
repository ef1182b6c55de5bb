#include "runner/requests/point_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "contract/input_error.h"
#include "runner/text/quoting.h"

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

}  // namespace peclet::runner
