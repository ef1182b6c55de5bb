#include "runner/page/figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "contract/errors.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "runner/page/page_data.h"
#include "runner/page/page_html.h"
#include "runner/page/swept.h"
#include "runner/reports/status.h"
#include "runner/store/vocabulary.h"

namespace peclet::runner {
namespace {

constexpr std::string_view seal = "# sha256 of all above: ";

std::string bare(const std::string& path) { return path.starts_with('/') ? path.substr(1) : path; }

bool is_called(const Drawable& one, const std::string& name) {
  return one.path == name || (!one.element.empty() && one.name + '/' + one.element == name);
}

// Names of all quantities; of a list, which may be long, its name and its first element.
std::string names_of(const std::vector<Drawable>& drawables) {
  std::vector<std::string> names;
  for (const Drawable& one : drawables) {
    if (one.element.empty()) {
      names.push_back(one.path);
    } else if (one.path == one.name + "/0" || one.path == one.name + "/0/0") {
      names.push_back(one.name + '/' + one.element + " ...");
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::size_t chosen_column(const std::vector<Drawable>& drawables, const std::string& name) {
  if (drawables.empty()) throw InputError("", "--quantity", name, "nothing has been measured yet");
  for (std::size_t column = 0; column < drawables.size(); ++column) {
    if (is_called(drawables[column], name)) return column;
  }
  std::vector<std::string> names;
  names.reserve(drawables.size());
  for (const Drawable& one : drawables) {
    names.push_back(one.element.empty() ? one.path : one.name + '/' + one.element);
  }
  const std::string meant = suggestion(name, names);
  throw InputError("", "--quantity", name,
                   meant.empty() ? "must be a number that is measured: " + names_of(drawables)
                                 : "must be a number that is measured" + meant);
}

void require_tolerance(const Target& target, const std::string& path) {
  for (const Criterion& criterion : target.criteria()) {
    if (target.has_tolerance() && bare(criterion.observable) == path) return;
  }
  throw InputError("", "--band", path, "has no tolerance: the campaign does not aim at it");
}

// "converged" of a point that has converged or is complete, "undecided" of one that has ended otherwise,
// "provisional" of one still open.
const char* standing_of(const Json& point) {
  if (!point.at("decided").get<bool>()) return "provisional";
  const std::optional<Verdict> verdict = verdict_of(point.at("standing").get<std::string>());
  return verdict && is_reached(*verdict) ? "converged" : "undecided";
}

// Whether the point has a number of the quantity. If the point has jammed, a mean over half of its seeds or
// fewer is not its own: it is the mean of those that happened to flow.
bool has_number(const Json& point, const Json& estimate) {
  if (estimate.is_null() || !estimate[0].is_number()) return false;
  const Json& endings = point.at("endings");
  return !endings.at("has_jammed").get<bool>() || 2 * estimate[3].get<int>() > endings.at("ended").get<int>();
}

Json point_json(const Json& point, const Json& estimate, const std::string& path) {
  const bool is_known = has_number(point, estimate);
  const auto number = [&](std::size_t place) { return is_known ? estimate[place] : Json(nullptr); };
  return {{"label", point.at("label")},
          {"settings", point.at("settings")},
          {"mean", number(0)},
          {"standard_error", number(1)},
          {"half_width", number(2)},
          {"good_enough", is_known ? point.at("good_enough").value(path, Json()) : Json(nullptr)},
          {"count", is_known ? estimate[3] : point.at("endings").at("ended")},
          {"standing", standing_of(point)},
          {"jammed", point.at("endings").at("has_jammed")}};
}

void require_numbers(const Json& points, const Swept& axis, const FigureChoice& choice,
                     const std::string& quantity) {
  const auto is_log = [&](char name) {
    return choice.scale && choice.scale->find(name) != std::string::npos;
  };
  bool has_number = false, has_jammed = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Json& mean = points[i].at("mean");
    has_jammed = has_jammed || points[i].at("jammed").get<bool>();
    if (!mean.is_number()) continue;
    has_number = true;
    const bool is_hidden =
        (is_log('y') && mean.get<double>() <= 0) || (is_log('x') && axis.numeric && axis.numbers[i] <= 0);
    if (!is_hidden) return;
  }
  throw InputError("", "--quantity", quantity,
                   has_number   ? "has no number that a logarithmic axis has a place for"
                   : has_jammed ? "has no number at any point: those that have ended have jammed"
                                : "has no number at any point yet");
}

}  // namespace

Json figure_data(Database& database, const FigureChoice& choice) {
  const CampaignStatus status = read_status(database);
  KnownPoints known;
  const PagePoints page = page_points(database, status, known);
  const Target& target = status.campaign.target.target;
  const std::string wanted = bare(choice.quantity.empty() ? target.observable : choice.quantity);
  const std::size_t column = chosen_column(page.drawables, wanted);
  const Drawable& quantity = page.drawables[column];
  if (choice.tolerance) require_tolerance(target, quantity.path);
  const Json parameters = page_parameters(status, kept_vocabulary(database));
  const std::vector<Swept> swept = swept_parameters(parameters, page.points);
  const Swept& axis = chosen_axis(swept, choice.over, "--over");
  Json points = Json::array();
  for (const Json& point : page.points) {
    points.push_back(point_json(point, point.at("estimates")[column], quantity.path));
  }
  require_numbers(points, axis, choice, quantity.path);
  return {{"campaign", status.campaign.name},
          {"quantity",
           {{"path", quantity.path},
            {"name", quantity.name},
            {"element", quantity.element},
            {"symbol", quantity.symbol},
            {"unit", quantity.unit}}},
          {"over", axis.pointer},
          {"confidence", target.confidence},
          {"log", choice.scale ? Json(*choice.scale) : Json(nullptr)},
          {"tolerance", choice.tolerance},
          {"parameters", parameters},
          {"points", points}};
}

std::string figure_script(const Json& data) {
  // A line for each member and each point, so that people can read and change them. Between r""" and """
  // nothing ends the string: JSON has a backslash before every quotation mark within a text, and never three
  // around one.
  std::vector<std::string> lines, points;
  for (const auto& [name, value] : data.items()) {
    if (name != "points") lines.push_back(fmt::format("\"{}\": {}", name, canonical_json(value)));
  }
  for (const Json& point : data.at("points")) points.push_back("  " + canonical_json(point));
  lines.push_back(fmt::format("\"points\": [\n{}]", fmt::join(points, ",\n")));
  std::string script = drawing_script;
  script += fmt::format(
      "\n\nFIGURE = json.loads(r\"\"\"{{{}}}\"\"\")\n\nif __name__ == \"__main__\":\n    main(FIGURE)\n",
      fmt::join(lines, ",\n "));
  return script + std::string(seal) + sha256(script) + '\n';
}

bool is_own_script(std::string_view text) {
  const std::size_t last = text.rfind(seal);
  if (last == std::string_view::npos) return false;
  return text.substr(last + seal.size()) == sha256(text.substr(0, last)) + '\n';
}

}  // namespace peclet::runner
