#include "runner/campaign/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "contract/errors.h"
#include "contract/key_table.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "runner/campaign/number_text.h"

namespace peclet::runner {
namespace {

constexpr std::size_t most_points = 100'000;

[[noreturn]] void refuse_points(const std::string& file) {
  throw InputError(file, "/sweep", fmt::format("more than {} points", most_points),
                   fmt::format("must make at most {} points", most_points));
}

const char* const pointer_rule =
    "must be a JSON pointer into the scene, such as \"/fluid/viscosity\", or an array of them";

bool is_pointer(const Json& set) {
  if (!set.is_string()) return false;
  const auto& text = set.get_ref<const std::string&>();
  if (text.size() < 2 || text.front() != '/') return false;
  try {
    const Json::json_pointer parsed(text);
    return true;
  } catch (const Json::exception&) {  // a ~ that escapes nothing
    return false;
  }
}

std::vector<std::string> read_pointers(const Json& set, const std::string& where, const std::string& file) {
  if (!set.is_array()) {
    if (!is_pointer(set)) throw InputError(file, where, shortened(set), pointer_rule);
    return {set.get<std::string>()};
  }
  if (set.empty()) throw InputError(file, where, "[]", pointer_rule);
  std::vector<std::string> pointers;
  for (const Json& pointer : set) {
    if (!is_pointer(pointer)) {
      throw InputError(file, fmt::format("{}/{}", where, pointers.size()), shortened(pointer), pointer_rule);
    }
    pointers.push_back(pointer.get<std::string>());
  }
  return pointers;
}

std::vector<std::vector<Json>> read_rows(const Json& entry, std::size_t pointers, const std::string& where,
                                         const std::string& file) {
  std::vector<std::vector<Json>> rows;
  for (const Json& value : entry.at("values")) {
    if (!entry.at("set").is_array()) {
      rows.push_back({value});
      continue;
    }
    if (!value.is_array() || value.size() != pointers) {
      throw InputError(
          file, fmt::format("{}/{}", where, rows.size()), shortened(value),
          fmt::format("must be an array with one value for each pointer of set, {} in all", pointers));
    }
    rows.emplace_back(value.begin(), value.end());
  }
  return rows;
}

// Returns true if both pointers name the same value, or one a part of the other.
bool overlap(const std::string& one, const std::string& other) {
  const auto [shorter, longer] = one.size() < other.size() ? std::pair(one, other) : std::pair(other, one);
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '/');
}

void refuse_conflicts(const std::vector<SweepEntry>& sweep, const std::string& file) {
  std::vector<std::string> seen;
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    for (const std::string& pointer : sweep[entry].pointers) {
      const auto other =
          std::find_if(seen.begin(), seen.end(), [&](const auto& known) { return overlap(known, pointer); });
      if (other != seen.end()) {
        throw InputError(file, fmt::format("/sweep/{}/set", entry), pointer,
                         *other == pointer
                             ? "must be set once only"
                             : fmt::format("must not overlap with {}, which the sweep sets, too", *other));
      }
      seen.push_back(pointer);
    }
  }
}

// Returns value k of a range.
Json value_of_range(const Json& range, int k) {
  const int last = range.at("points").get<int>() - 1;
  if (k == 0 || k == last) return range.at(k == 0 ? "from" : "to");
  const double from = range.at("from").get<double>(), to = range.at("to").get<double>(),
               share = 1.0 * k / last;
  const bool is_logarithmic = range.at("spaced") == "log";
  double value =
      is_logarithmic ? std::exp(std::lerp(std::log(from), std::log(to), share)) : std::lerp(from, to, share);
  // Where a linear range crosses zero, rounding leaves a residue.
  if (!is_logarithmic && std::abs(value) < 1e-12 * std::max(std::abs(from), std::abs(to))) value = 0;
  return Json::parse(fmt::format("{:.6g}", value));  // a value that labels and tables can show
}

Json values_of_range(const Json& range, const std::string& where, const std::string& file) {
  for (const char* const end : {"from", "to"}) {
    if (range.at("spaced") == "log" && range.at(end).get<double>() <= 0) {
      throw InputError(file, fmt::format("{}/{}", where, end), shortened(range.at(end)),
                       "must be above 0 for logarithmic spacing");
    }
  }
  Json values = Json::array();
  for (int k = 0; k < range.at("points").get<int>(); ++k) values.push_back(value_of_range(range, k));
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k] == values[k - 1]) {
      throw InputError(file, where, shortened(range),
                       "must have values that differ in their first six digits");
    }
  }
  return values;
}

}  // namespace

Json without_ranges(Json sweep, const std::string& file) {
  std::size_t points = 1;
  for (const Json& entry : sweep) {
    const Json& values = entry.at("values");
    points *= values.is_object() ? values.at("points").get<std::size_t>() : values.size();
    if (points > most_points) refuse_points(file);
  }
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    Json& values = sweep[entry].at("values");
    if (!values.is_object()) continue;
    const std::string where = fmt::format("/sweep/{}/values", entry);
    if (sweep[entry].at("set").is_array()) {
      throw InputError(file, where, shortened(values),
                       "must be a list if set is one: a range has the values of one pointer");
    }
    values = values_of_range(values, where, file);
  }
  return sweep;
}

std::vector<SweepEntry> read_sweep(const Json& sweep, const std::string& file) {
  std::vector<SweepEntry> entries;
  for (const Json& entry : sweep) {
    const std::string where = fmt::format("/sweep/{}", entries.size());
    SweepEntry read;
    read.pointers = read_pointers(entry.at("set"), where + "/set", file);
    read.rows = read_rows(entry, read.pointers.size(), where + "/values", file);
    entries.push_back(std::move(read));
  }
  refuse_conflicts(entries, file);
  return entries;
}

namespace {

std::string last_step(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

bool is_number(const std::string& step) { return step.find_first_not_of("0123456789") == std::string::npos; }

constexpr std::size_t longest_label = 100;

// Returns the value for a label. A value that is too long for a table, or has control characters, becomes its
// place among the values, from 1: "#1".
std::string value_text(const Json& value, std::size_t row) {
  constexpr std::size_t longest = 24;
  const std::string text = value.is_string() ? value.get<std::string>() : canonical_json(value);
  return text.size() <= longest && printable(text) == text ? text : fmt::format("#{}", row + 1);
}

}  // namespace

SweepLabels::SweepLabels(const std::vector<SweepEntry>& sweep) : sweep_(sweep) {
  std::map<std::string, int> uses;
  for (const SweepEntry& entry : sweep) {
    for (const std::string& pointer : entry.pointers) ++uses[last_step(pointer)];
  }
  for (const SweepEntry& entry : sweep) {
    std::vector<std::string>& names = names_.emplace_back();
    for (const std::string& pointer : entry.pointers) {
      const std::string step = last_step(pointer);
      names.push_back(printable(uses[step] == 1 && !is_number(step) ? step : pointer, longest_label));
    }
  }
}

std::string SweepLabels::of(const std::vector<std::size_t>& row_of_entry) const {
  std::string label;
  for (std::size_t entry = 0; entry < sweep_.size(); ++entry) {
    const std::size_t row = row_of_entry[entry];
    for (std::size_t i = 0; i < names_[entry].size(); ++i) {
      if (!label.empty()) label += ' ';
      label += names_[entry][i] + '=' + value_text(sweep_[entry].rows[row][i], row);
    }
  }
  return label;
}

namespace {

// Returns the index of the element that a step of a pointer names; nothing if the array lacks it. RFC 6901
// allows no leading zeros.
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

// Returns roughly the memory of a document [bytes]: its text, and a constant for each of its values.
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

// Throws InputError if the scenes of all points need too much memory. 100 000 ordinary ones need far less.
void refuse_heavy_scenes(const Json& scene, std::size_t points, const std::string& file) {
  constexpr std::size_t most = 2'000'000'000;
  if (points <= 1 || weight_of(scene) <= most / points) return;
  throw InputError(
      file, "/scene", fmt::format("{} points of about {} bytes", points, weight_of(scene)),
      fmt::format("must be so small that the scenes of all points together take at most {} bytes", most));
}

// The row of each entry that makes up a point.
using GridIndex = std::vector<std::size_t>;

std::size_t count_points(const std::vector<SweepEntry>& sweep, const std::string& file) {
  std::size_t count = 1;
  for (const SweepEntry& entry : sweep) {
    count *= entry.rows.size();
    if (count > most_points) refuse_points(file);
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
  throw InputError(
      file, fmt::format("/sweep/{}/values/{}", a - one.begin(), *b), label,
      fmt::format("must differ from the other points: the scene equals that of {}, from value {}",
                  points[first].label, *a));
}

}  // namespace

void set_at(Json& scene, const std::string& pointer, const Json& value) {
  Json* place = &scene;
  for (const std::string& step : steps_of(pointer)) {
    if (place->is_null()) *place = Json::object();  // created by the step before
    if (place->is_array()) {
      const auto index = element(*place, step);
      if (!index)
        refuse_pointer(pointer, fmt::format("an array of length {} has no element {}", place->size(), step));
      place = &(*place)[*index];
    } else if (place->is_object()) {
      place = &(*place)[step];
    } else {
      refuse_pointer(pointer, fmt::format("{} is neither an object nor an array", shortened(*place)));
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

namespace {

// Returns the number of spheres of the point with these rows of the sweep, 1 if its scene has none.
double spheres_of(const Json& scene, const std::vector<SweepEntry>& sweep, const GridIndex& index) {
  const auto count_in = [](const Json& particles) {
    return particles.is_object() ? particles.value("count", Json()) : Json();
  };
  Json count = scene.is_object() ? count_in(scene.value("particles", Json())) : Json();
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    const std::vector<std::string>& pointers = sweep[entry].pointers;
    for (std::size_t i = 0; i < pointers.size(); ++i) {
      const Json& value = sweep[entry].rows[index[entry]][i];
      if (pointers[i] == "/particles/count") count = value;
      if (pointers[i] == "/particles") count = count_in(value);
    }
  }
  return count.is_number() ? count.get<double>() : 1;
}

}  // namespace

std::vector<Curve> curves_over(const std::string& over, const Json& scene,
                               const std::vector<SweepEntry>& sweep, const std::string& file,
                               const std::string& pointer) {
  std::size_t entry = 0, column = 0;
  for (; entry < sweep.size(); ++entry) {
    const std::vector<std::string>& pointers = sweep[entry].pointers;
    column = static_cast<std::size_t>(std::ranges::find(pointers, over) - pointers.begin());
    if (column < pointers.size()) break;
  }
  if (entry == sweep.size())
    throw InputError(file, pointer, over, "must be a pointer that the sweep sets, along which curves run");
  std::vector<double> axis;
  for (const std::vector<Json>& row : sweep[entry].rows) {
    const Json& value = row[column];
    const std::string where = fmt::format("/sweep/{}/values/{}", entry, axis.size());
    if (!value.is_number())
      throw InputError(file, where, shortened(value), "must be a number: it is the axis of curves");
    if (std::ranges::find(axis, value.get<double>()) != axis.end()) {
      throw InputError(file, where, shortened(value),
                       "must differ from the others: it is the axis of curves");
    }
    axis.push_back(value.get<double>());
  }
  if (axis.size() < fewest_of_curve) {
    throw InputError(file, fmt::format("/sweep/{}/values", entry), counted(axis.size(), "value"),
                     fmt::format("must be {} or more, because curves run along {}", fewest_of_curve, over));
  }
  std::map<GridIndex, Curve> curves;  // by the rows of the other entries
  std::size_t points = 1;
  for (const SweepEntry& each : sweep) points *= each.rows.size();
  for (std::size_t point = 0; point < points; ++point) {
    GridIndex index = grid_index(sweep, point);
    const double spheres = spheres_of(scene, sweep, index);
    const std::size_t row = std::exchange(index[entry], 0);
    Curve& curve = curves[index];
    curve.points.push_back(point);
    curve.axis.push_back(axis[row]);
    curve.spheres.push_back(spheres);
  }
  std::vector<Curve> all;
  all.reserve(curves.size());
  for (auto& [others, curve] : curves) all.push_back(std::move(curve));
  return all;
}

Json with_value_along(Json sweep, const std::string& over, double value) {
  for (Json& entry : sweep) {
    const bool is_list = entry["set"].is_array();
    const Json pointers = is_list ? entry["set"] : Json::array({entry["set"]});
    const auto column = static_cast<std::size_t>(std::ranges::find(pointers, Json(over)) - pointers.begin());
    if (column == pointers.size()) continue;
    Json& rows = entry["values"];
    std::vector<double> axis;
    for (const Json& row : rows) axis.push_back((is_list ? row[column] : row).get<double>());
    const bool is_logarithmic = std::ranges::all_of(axis, [](double known) { return known > 0; });
    const auto distance = [&](double known) {
      return is_logarithmic ? std::abs(std::log(known / value)) : std::abs(known - value);
    };
    const auto nearest = std::ranges::min_element(axis, {}, distance) - axis.begin();
    Json row = rows[static_cast<std::size_t>(nearest)];
    const bool is_whole = value == std::floor(value) && std::abs(value) < largest_count;
    (is_list ? row[column] : row) = is_whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
    const auto place = std::ranges::is_sorted(axis) ? std::ranges::upper_bound(axis, value) : axis.end();
    rows.insert(rows.begin() + (place - axis.begin()), std::move(row));
    return sweep;
  }
  return sweep;
}

}  // namespace peclet::runner
