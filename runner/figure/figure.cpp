#include "runner/figure/figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "contract/input_error.h"
#include "contract/nearest_name.h"
#include "runner/figure/swept.h"
#include "runner/reports/status.h"
#include "runner/text/number_text.h"

namespace peclet::runner {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string bare(const std::string& path) { return path.starts_with('/') ? path.substr(1) : path; }

bool is_called(const Drawable& one, const std::string& name) {
  return one.path == name || (!one.element.empty() && one.name + '/' + one.element == name);
}

// Of a list its elements are meant, of which there may be many: its name, and one of them.
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

Standing standing_of(const Json& point) {
  if (!point.at("decided").get<bool>()) return Standing::provisional;
  const std::optional<Verdict> verdict = verdict_of(point.at("standing").get<std::string>());
  return verdict && is_reached(*verdict) ? Standing::converged : Standing::undecided;
}

double number_or_none(const Json& value) { return value.is_number() ? value.get<double>() : none; }

// Whether the point has a number of the quantity. At one that has jammed a number of half of its seeds
// or fewer is that of those which happened to flow.
bool has_number(const Json& point, const Json& estimate) {
  if (estimate.is_null() || !estimate[0].is_number()) return false;
  const Json& endings = point.at("endings");
  return !endings.at("has_jammed").get<bool>() || 2 * estimate[3].get<int>() > endings.at("ended").get<int>();
}

Mark jammed_mark(const Json& point, double x) {
  Mark mark{point.at("label").get<std::string>(), x, none, none, none};
  mark.count = point.at("endings").at("ended").get<int>();
  mark.standing = standing_of(point);
  mark.jam = Jam::above;
  return mark;
}

Mark mark_of(const Json& point, const Json& estimate, double x, const std::string& path) {
  Mark mark{point.at("label").get<std::string>(), x};
  if (point.at("endings").at("has_jammed").get<bool>()) mark.jam = Jam::at_number;
  mark.mean = estimate[0].get<double>();
  mark.standard_error = number_or_none(estimate[1]);
  mark.half_width = number_or_none(estimate[2]);
  mark.count = estimate[3].get<int>();
  mark.standing = standing_of(point);
  if (const Json allowed = point.at("good_enough").value(path, Json()); allowed.is_number()) {
    mark.good_enough = allowed.get<double>();
  }
  return mark;
}

Label curve_name(const std::vector<const Swept*>& by, std::size_t point) {
  Label label;
  for (const Swept* const one : by) {
    if (!label.empty()) label.push_back({", "});
    label.insert(label.end(), one->name.begin(), one->name.end());
    label.push_back({" = " + one->words[point]});
  }
  return label;
}

// What of a mark has to be seen. Bars of numbers that are not decided may still be enormous.
std::vector<double> ends(const Mark& mark) {
  if (!mark.has_place()) return {};
  if (mark.standing == Standing::provisional || !std::isfinite(mark.half_width)) return {mark.mean};
  return {mark.mean, mark.mean - mark.half_width, mark.mean + mark.half_width};
}

// Scales, and the range of what is drawn.
void set_ranges(Figure& figure, const FigureChoice& choice) {
  std::vector<double> x, y, means;
  for (const Curve& curve : figure.curves) {
    for (const Mark& mark : curve.marks) {
      x.push_back(mark.x);
      if (mark.has_place()) means.push_back(mark.mean);
      for (const double end : ends(mark)) y.push_back(end);
    }
  }
  const auto asked = [&](char axis) { return choice.scale && choice.scale->find(axis) != std::string::npos; };
  const bool numeric = figure.x.words.empty();
  figure.x.range.log = numeric && (choice.scale ? asked('x') : is_logarithmic(x));
  figure.y.range.log = choice.scale ? asked('y') : is_logarithmic(y);
  const auto leaves_the_axis = [&](const Mark& mark) {
    return figure.y.range.log && mark.has_place() && !(mark.mean > 0);
  };
  // What a logarithmic axis has no place for.
  const auto is_hidden = [&](const Mark& mark) {
    return (figure.x.range.log && !(mark.x > 0)) || (leaves_the_axis(mark) && mark.jam == Jam::none);
  };
  for (Curve& curve : figure.curves) {
    for (Mark& mark : curve.marks) {
      if (mark.jam == Jam::at_number && leaves_the_axis(mark)) mark.jam = Jam::below;
    }
    figure.hidden += static_cast<int>(std::erase_if(curve.marks, is_hidden));
    if (!figure.tolerance) continue;
    for (const Mark& mark : curve.marks) {
      if (!mark.good_enough || mark.jam != Jam::none) continue;
      y.push_back(mark.mean - *mark.good_enough);
      y.push_back(mark.mean + *mark.good_enough);
    }
  }
  std::erase_if(figure.curves, [](const Curve& curve) { return curve.marks.empty(); });
  const auto range_of = [](std::vector<double> numbers, bool log) {
    std::erase_if(numbers, [&](double number) { return !std::isfinite(number) || (log && number <= 0); });
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    return numbers.empty() ? AxisRange{0, 1, false} : AxisRange{*low, *high, log};
  };
  figure.x.range = range_of(x, figure.x.range.log);
  figure.y.range = range_of(y, figure.y.range.log);
  figure.tolerance = figure.tolerance && figure.has_tolerance();
  if (figure.y.range.log) {
    // A bar that reaches almost down to zero must not squeeze all else: it is cut off.
    const double lowest = range_of(means, true).low / 3;
    figure.y.range.low = std::max(figure.y.range.low, lowest);
  }
}

}  // namespace

bool Figure::has(Standing standing) const {
  return std::any_of(curves.begin(), curves.end(), [&](const Curve& curve) {
    return std::any_of(curve.marks.begin(), curve.marks.end(),
                       [&](const Mark& mark) { return mark.jam == Jam::none && mark.standing == standing; });
  });
}

bool Figure::has_jammed() const {
  return std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return std::any_of(curve.marks.begin(), curve.marks.end(),
                       [](const Mark& mark) { return mark.jam != Jam::none; });
  });
}

bool Figure::has_tolerance() const {
  return std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return std::any_of(curve.marks.begin(), curve.marks.end(),
                       [](const Mark& mark) { return mark.good_enough.has_value(); });
  });
}

Figure make_figure(Database& database, const FigureChoice& choice) {
  const CampaignStatus status = read_status(database);
  KnownPoints known;
  const PagePoints page = page_points(database, status, known);
  const Target& target = status.campaign.target.target;
  const std::string wanted = bare(choice.quantity.empty() ? target.observable : choice.quantity);
  const std::size_t column = chosen_column(page.drawables, wanted);
  const Drawable& quantity = page.drawables[column];
  if (choice.tolerance) require_tolerance(target, quantity.path);
  const std::vector<Swept> swept = swept_parameters(page_parameters(status), page.points);
  const Swept& axis = chosen_axis(swept, choice.over, "--over");
  const std::vector<const Swept*> by = curves_by(swept, axis);

  Figure figure{status.campaign.name, quantity.path, axis.pointer, target.confidence};
  figure.x.title = axis.title;
  if (!axis.numeric) figure.x.words = axis.values;
  figure.y.title = title_of(quantity);
  figure.tolerance = choice.tolerance;
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < page.points.size(); ++i) {
    const Json& point = page.points[i];
    const Json& estimate = point.at("estimates")[column];
    const bool has_jammed = point.at("endings").at("has_jammed").get<bool>(),
               is_known = has_number(point, estimate);
    if (!is_known && !has_jammed) {
      ++figure.absent;
      continue;
    }
    const Label name = curve_name(by, i);
    const auto [place, is_new] = places.emplace(text_of(name), figure.curves.size());
    if (is_new) figure.curves.push_back({name, {}});
    figure.curves[place->second].marks.push_back(
        is_known ? mark_of(point, estimate, axis.numbers[i], quantity.path)
                 : jammed_mark(point, axis.numbers[i]));
  }
  for (Curve& curve : figure.curves) {
    std::stable_sort(curve.marks.begin(), curve.marks.end(),
                     [](const Mark& a, const Mark& b) { return a.x < b.x; });
  }
  set_ranges(figure, choice);
  const auto has_place = [](const Mark& mark) { return mark.has_place(); };
  if (std::none_of(figure.curves.begin(), figure.curves.end(), [&](const Curve& curve) {
        return std::any_of(curve.marks.begin(), curve.marks.end(), has_place);
      })) {
    throw InputError("", "--quantity", quantity.path,
                     figure.hidden > 0     ? "has no number that a logarithmic axis has a place for"
                     : figure.has_jammed() ? "has no number at any point: those that have ended have jammed"
                                           : "has no number at any point yet");
  }
  return figure;
}

std::string left_out(const Figure& figure) {
  std::string text;
  if (figure.absent > 0) {
    text += fmt::format("left out: {} without a number of {} yet\n",
                        counted(static_cast<std::size_t>(figure.absent), "point"), figure.quantity);
  }
  if (figure.hidden > 0) {
    text += fmt::format("left out: {} that {} not positive, for which a logarithmic axis has no place\n",
                        counted(static_cast<std::size_t>(figure.hidden), "number"),
                        figure.hidden == 1 ? "is" : "are");
  }
  return text;
}

}  // namespace peclet::runner
