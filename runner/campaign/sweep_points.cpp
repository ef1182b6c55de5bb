// The grid of a sweep: which scenes there are, and what they are called.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "contract/input_error.h"
#include "contract/sha256.h"
#include "runner/campaign/sweep.h"
#include "runner/campaign/sweep_labels.h"

namespace peclet::runner {
namespace {

constexpr std::size_t most_points = 100'000;

// The element of an array that a step of a pointer names; RFC 6901 allows no leading zeros.
std::optional<std::size_t> element(const Json& array, const std::string& step) {
  std::size_t index = 0;
  const char* const end = step.data() + step.size();
  const auto [stop, error] = std::from_chars(step.data(), end, index);
  const bool is_index = error == std::errc{} && stop == end && (step.size() == 1 || step.front() != '0');
  if (!is_index || index >= array.size()) return std::nullopt;
  return index;
}

[[noreturn]] void refuse_pointer(const std::string& pointer, const std::string& why) {
  throw InputError("", "", pointer, "must name a place in the scene: " + why);
}

std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> steps;
  for (Json::json_pointer path(pointer); !path.empty(); path.pop_back()) steps.push_back(path.back());
  std::reverse(steps.begin(), steps.end());
  return steps;
}

// About the bytes of memory that a document takes: its text, and each of its values.
std::size_t weight_of(const Json& document) {
  constexpr std::size_t of_a_value = 50;
  if (!document.is_structured()) {
    return of_a_value + (document.is_string() ? document.get_ref<const std::string&>().size() : 0);
  }
  std::size_t weight = of_a_value;
  for (const auto& [key, value] : document.items()) {
    weight += weight_of(value) + (document.is_object() ? key.size() : 0);
  }
  return weight;
}

// Each point has a scene of its own. 100 000 ordinary ones are far from this.
void refuse_heavy_scenes(const Json& scene, std::size_t points, const std::string& file) {
  constexpr std::size_t most = 2'000'000'000;
  if (points <= 1 || weight_of(scene) <= most / points) return;
  throw InputError(
      file, "/scene", fmt::format("{} points of about {} bytes", points, weight_of(scene)),
      fmt::format("must be small enough for scenes of all points together to take {} bytes", most));
}

// Which row of each entry makes up a point.
using GridIndex = std::vector<std::size_t>;

std::size_t count_points(const std::vector<SweepEntry>& sweep, const std::string& file) {
  std::size_t count = 1;
  for (const SweepEntry& entry : sweep) {
    count *= entry.rows.size();
    if (count > most_points) {
      throw InputError(file, "/sweep", fmt::format("more than {} points", most_points),
                       fmt::format("must make at most {} points", most_points));
    }
  }
  return count;
}

GridIndex grid_index(const std::vector<SweepEntry>& sweep, std::size_t number) {
  GridIndex index(sweep.size());
  for (std::size_t entry = sweep.size(); entry-- > 0;) {
    index[entry] = number % sweep[entry].rows.size();
    number /= sweep[entry].rows.size();
  }
  return index;
}

StatePoint make_point(const Json& scene, const std::vector<SweepEntry>& sweep, const GridIndex& index,
                      const std::string& file) {
  StatePoint point;
  point.scene = scene;
  point.settings = Json::object();
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    const std::vector<Json>& row = sweep[entry].rows[index[entry]];
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string& pointer = sweep[entry].pointers[i];
      point.settings[pointer] = row[i];
      try {
        set_at(point.scene, pointer, row[i]);
      } catch (const InputError& error) {
        throw error.within(file, fmt::format("/sweep/{}/set", entry));
      }
    }
  }
  point.hash = sha256(canonical_json(point.scene));
  return point;
}

[[noreturn]] void refuse_equal(const std::vector<SweepEntry>& sweep, std::size_t first, std::size_t second,
                               const std::vector<StatePoint>& points, const std::string& label,
                               const std::string& file) {
  const GridIndex one = grid_index(sweep, first), other = grid_index(sweep, second);
  const auto [a, b] = std::mismatch(one.begin(), one.end(), other.begin());
  throw InputError(file, fmt::format("/sweep/{}/values/{}", a - one.begin(), *b), label,
                   fmt::format("must differ from the other points: the scene is that of {}, value {} there",
                               points[first].label, *a));
}

}  // namespace

void set_at(Json& scene, const std::string& pointer, const Json& value) {
  Json* place = &scene;
  for (const std::string& step : steps_of(pointer)) {
    if (place->is_null()) *place = Json::object();  // made by the step before
    if (place->is_array()) {
      const auto index = element(*place, step);
      if (!index)
        refuse_pointer(pointer, fmt::format("there is no {} in an array of {}", step, place->size()));
      place = &(*place)[*index];
    } else if (place->is_object()) {
      place = &(*place)[step];
    } else {
      refuse_pointer(pointer, fmt::format("nothing can be below {}", shortened(*place)));
    }
  }
  *place = value;
}

std::vector<StatePoint> sweep_points(const Json& scene, const std::vector<SweepEntry>& sweep,
                                     const std::string& name, const std::string& file) {
  const SweepLabels labels(sweep);
  const std::size_t count = count_points(sweep, file);
  refuse_heavy_scenes(scene, count, file);
  std::vector<StatePoint> points;
  std::map<std::string, std::size_t> known;
  for (std::size_t number = 0; number < count; ++number) {
    const GridIndex index = grid_index(sweep, number);
    StatePoint point = make_point(scene, sweep, index, file);
    point.label = sweep.empty() ? name : labels.of(index);
    const auto [other, is_new] = known.emplace(point.hash, number);
    if (!is_new) refuse_equal(sweep, other->second, number, points, point.label, file);
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace peclet::runner
