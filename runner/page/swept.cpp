#include "runner/page/swept.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/store/point_store.h"

namespace peclet::runner {
namespace {

// Returns the names of all quantities; a list, which may be long, has only its first element here.
std::string names_of(const std::vector<Drawable>& drawables) {
  std::vector<std::string> names;
  for (const Drawable& one : drawables) {
    const bool is_first = one.path == one.name + "/0" || one.path == one.name + "/0/0";
    if (one.element.empty() || is_first) names.push_back(name_of(one) + (is_first ? " ..." : ""));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string name_of(const Drawable& one) {
  return one.element.empty() ? one.path : one.name + '/' + one.element;
}

std::size_t chosen_column(const std::vector<Drawable>& drawables, const std::string& name,
                          const std::vector<std::string>& others) {
  if (drawables.empty()) throw InputError("", "--quantity", name, "nothing has been measured yet");
  std::vector<std::string> names, paths;
  for (const Drawable& one : drawables) {
    names.push_back(name_of(one));
    paths.push_back(one.path);
  }
  // A path may be the name of another element, whose value on the axis is a whole number: paths come first.
  for (const std::vector<std::string>& known : {paths, names}) {
    const auto found = std::ranges::find(known, name);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  }
  names.insert(names.end(), others.begin(), others.end());
  const std::string meant = suggestion(name, names),
                    along = others.empty() ? "" : fmt::format("; along an axis: {}", fmt::join(others, ", "));
  throw InputError(
      "", "--quantity", name,
      "must be a measured quantity" + (meant.empty() ? ": " + names_of(drawables) + along : meant));
}

namespace {

std::string last_step(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

// Returns the text of a value in a figure. A value that is too long is named by its place among all, from 1.
std::string word_of(const Json& value, const std::vector<Json>& distinct) {
  constexpr std::size_t longest = 26;
  if (value.is_null()) return "–";
  if (value.is_number()) return fmt::format("{:.6g}", value.get<double>());
  if (value.dump().size() > longest) {
    const auto place = std::find(distinct.begin(), distinct.end(), value) - distinct.begin();
    return fmt::format("#{}", place + 1);
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Swept column(const Json& parameter, const Json& points) {
  Swept made{parameter.at("pointer").get<std::string>(), parameter.at("symbol").get<std::string>()};
  if (made.name.empty()) made.name = last_step(made.pointer);
  std::vector<Json> cells, distinct;
  for (const Json& point : points) {
    cells.push_back(point.at("settings").value(made.pointer, Json()));
    if (std::find(distinct.begin(), distinct.end(), cells.back()) == distinct.end())
      distinct.push_back(cells.back());
  }
  made.numeric = std::all_of(cells.begin(), cells.end(), [](const Json& cell) { return cell.is_number(); });
  for (const Json& cell : cells) {
    const auto place = std::find(distinct.begin(), distinct.end(), cell) - distinct.begin();
    made.numbers.push_back(made.numeric ? cell.get<double>() : static_cast<double>(place));
    made.words.push_back(word_of(cell, distinct));
  }
  for (const Json& value : distinct) made.values.push_back(word_of(value, distinct));
  return made;
}

Swept points_themselves(const Json& points) {
  Swept made{"", "point"};
  for (const Json& point : points) {
    made.numbers.push_back(static_cast<double>(made.values.size()));
    made.values.push_back(point.at("label").get<std::string>());
  }
  made.words = made.values;
  return made;
}

}  // namespace

bool is_called(const Swept& one, const std::string& name) {
  return one.pointer == name || one.pointer == '/' + name || last_step(one.pointer) == name;
}

void keep_points(MeasuredSweep& sweep, const std::function<bool(const Json& point)>& is_kept) {
  Json points = Json::array();
  std::vector<PointSummary> summaries;
  for (std::size_t i = 0; i < sweep.page.points.size(); ++i) {
    if (!is_kept(sweep.page.points[i])) continue;
    points.push_back(std::move(sweep.page.points[i]));
    summaries.push_back(std::move(sweep.status.points[i]));
  }
  sweep.page.points = std::move(points);
  sweep.status.points = std::move(summaries);
}

namespace {

// Returns the only parameter with this name. Throws InputError at `option`.
const Swept& called(const std::vector<Swept>& swept, const std::string& name, const char* option) {
  std::vector<std::string> names;
  std::vector<const Swept*> found;
  for (const Swept& one : swept) {
    if (one.pointer.empty()) continue;
    names.push_back(one.pointer);
    if (is_called(one, name)) found.push_back(&one);
  }
  if (found.size() == 1) return *found.front();
  if (names.empty()) throw InputError("", option, name, "must not be given: the campaign sweeps nothing");
  const std::string allowed = fmt::format("must be the name of one swept parameter: {}{}",
                                          fmt::join(names, ", "), suggestion('/' + name, names));
  throw InputError("", option, name, allowed);
}

}  // namespace

Json campaign_parameter() {
  return {{"pointer", "campaign"}, {"words", "campaign"}, {"symbol", ""}, {"unit", ""}, {"meaning", ""}};
}

Json value_in(const Json& scene, const std::string& pointer) {
  const bool is_key = pointer.starts_with('/') && scene.contains(Json::json_pointer(pointer));
  return is_key ? scene.at(Json::json_pointer(pointer)) : Json();
}

std::vector<Swept> swept_columns(const Json& parameters, const Json& points) {
  std::vector<Swept> swept;
  for (const Json& parameter : parameters) swept.push_back(column(parameter, points));
  if (swept.empty()) swept.push_back(points_themselves(points));
  return swept;
}

namespace {

bool is_equal(const Json& one, const Json& other) {
  if (!one.is_number() || !other.is_number()) return one == other;
  const double a = one.get<double>(), b = other.get<double>();
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));  // as `where` of the Python package
}

bool is_any(const std::vector<Json>& values, const Json& value) {
  return std::any_of(values.begin(), values.end(), [&](const Json& one) { return is_equal(one, value); });
}

// The values that --where gives, by the pointer of their parameter.
using Wanted = std::map<std::string, std::vector<Json>>;

Wanted wanted_values(const std::vector<std::string>& where, const Json& parameters, const Json& points) {
  const std::vector<Swept> swept = swept_columns(parameters, points);
  Wanted wanted;
  for (const std::string& text : where) {
    const std::size_t sign = text.find('=');
    if (sign == 0 || sign == std::string::npos)
      throw InputError("", "--where", text, "must be NAME=VALUE, such as peclet=10");
    const Swept& parameter = called(swept, text.substr(0, sign), "--where");
    const std::string word = text.substr(sign + 1);
    std::vector<Json> values{word};  // a text, or what it says as JSON
    if (const Json value = Json::parse(word, nullptr, false); !value.is_discarded()) values.push_back(value);
    const auto has = [&](const Json& point) {
      return is_any(values, point.at("settings").value(parameter.pointer, Json()));
    };
    if (!std::any_of(points.begin(), points.end(), has)) {
      throw InputError("", "--where", text,
                       fmt::format("must be a value of a point: {}", fmt::join(parameter.values, ", ")));
    }
    std::vector<Json>& all = wanted[parameter.pointer];
    all.insert(all.end(), values.begin(), values.end());
  }
  return wanted;
}

bool is_wanted(const Json& point, const Wanted& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const auto& one) {
    return is_any(one.second, point.at("settings").value(one.first, Json()));
  });
}

// Removes the points that are not wanted.
void select(MeasuredSweep& sweep, const std::vector<std::string>& where) {
  const Wanted wanted = wanted_values(where, sweep.parameters, sweep.page.points);
  keep_points(sweep, [&](const Json& point) { return is_wanted(point, wanted); });
  if (sweep.page.points.empty()) {
    throw InputError("", "--where", fmt::format("{}", fmt::join(where, " ")),
                     "must hold at a point: no point has these values together");
  }
}

// True if the value of `other` follows from that of `axis`.
bool in_step(const Swept& other, const Swept& axis) {
  std::map<double, double> partner;
  for (std::size_t i = 0; i < axis.numbers.size(); ++i) {
    if (partner.emplace(axis.numbers[i], other.numbers[i]).first->second != other.numbers[i]) return false;
  }
  return true;
}

}  // namespace

MeasuredSweep read_sweep(Database& database, const std::vector<std::string>& where) {
  MeasuredSweep sweep;
  sweep.status = read_status(database);
  KnownPoints known;
  sweep.page = page_points(database, sweep.status, known);
  sweep.parameters = page_parameters(sweep.status, kept_vocabulary(database));
  if (!where.empty()) select(sweep, where);
  sweep.swept = swept_columns(sweep.parameters, sweep.page.points);
  return sweep;
}

const Swept& chosen_axis(const std::vector<Swept>& swept, const std::string& name) {
  if (!name.empty()) return called(swept, name, "--over");
  const auto rank = [](const Swept& one) {
    return one.distinct() < 2 ? 0 : (one.numeric ? 1'000'000 : 0) + one.distinct();
  };
  return *std::max_element(swept.begin(), swept.end(),
                           [&](const Swept& a, const Swept& b) { return rank(a) < rank(b); });
}

std::vector<const Swept*> curves_by(const std::vector<Swept>& swept, const Swept& axis) {
  std::vector<const Swept*> others;
  for (const Swept& one : swept) {
    if (&one != &axis && one.distinct() > 1 && !in_step(one, axis)) others.push_back(&one);
  }
  return others;
}

}  // namespace peclet::runner
