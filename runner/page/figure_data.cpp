// The numbers of a figure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "contract/errors.h"
#include "runner/page/derived_numbers.h"
#include "runner/page/figure.h"
#include "runner/page/quantity_curves.h"
#include "runner/page/swept.h"
#include "runner/statistics/quantity_estimates.h"
#include "runner/store/point_store.h"

namespace peclet::runner {
namespace {

// The quantities of a figure: numbers, which are columns of the page's points, or curves along one axis.
struct Chosen {
  std::vector<Drawable> about;
  std::vector<std::size_t> columns;
  std::vector<QuantityCurve> curves;
};

// Returns the curve with this name at the first point that has it.
std::optional<QuantityCurve> curve_called(Database& database, const MeasuredSweep& sweep,
                                          const std::string& name, std::vector<std::string>& names) {
  for (const PointSummary& point : sweep.status.points) {
    const Json result = first_result(database, point.point.id);
    if (!result.value("mean", Json()).is_object()) continue;
    const std::vector<Quantity> quantities = quantities_of(result);
    if (std::optional<QuantityCurve> curve = find_curve(quantities, name)) return curve;
    if (names.empty()) names = names_of_curves(quantities);
  }
  return std::nullopt;
}

void require_one_unit(const Chosen& chosen) {
  const Drawable& first = chosen.about.front();
  for (const Drawable& one : chosen.about) {
    if (&one != &first && one.path == first.path)
      throw InputError("", "--quantity", one.path, "is given twice");
    if (one.unit != first.unit) {
      throw InputError(
          "", "--quantity", one.path,
          fmt::format("has the unit {}, and {} has {}: the quantities of one frame must have one unit",
                      one.unit, first.path, first.unit));
    }
  }
  if (!chosen.columns.empty() && !chosen.curves.empty()) {
    throw InputError(
        "", "--quantity", chosen.curves.front().about.path,
        fmt::format("has an axis, {}, and another quantity has none: they do not fit in one frame",
                    chosen.curves.front().axis.name));
  }
  for (const QuantityCurve& curve : chosen.curves) {
    const QuantityAxis &axis = curve.axis, &other = chosen.curves.front().axis;
    if (axis.name == other.name && axis.unit == other.unit) continue;
    throw InputError(
        "", "--quantity", curve.about.path,
        fmt::format("has the axis {}, and {} has {}: the quantities of one frame must have one axis",
                    axis.name, chosen.curves.front().about.path, other.name));
  }
}

// Returns the place of the measured number with this name; nothing if there is none.
std::optional<std::size_t> column_called(const std::vector<Drawable>& drawables, const std::string& name) {
  const auto found = std::ranges::find_if(
      drawables, [&](const Drawable& one) { return one.path == name || name_of(one) == name; });
  return found == drawables.end() ? std::nullopt : std::optional<std::size_t>(found - drawables.begin());
}

Chosen chosen_quantities(Database& database, const MeasuredSweep& sweep,
                         const std::vector<std::string>& wanted) {
  Chosen chosen;
  const std::vector<Drawable>& drawables = sweep.page.drawables;
  for (const std::string& given : wanted) {
    const std::string name = bare(given);
    std::vector<std::string> names;
    const std::optional<QuantityCurve> curve =
        column_called(drawables, name) ? std::nullopt : curve_called(database, sweep, name, names);
    if (curve) {
      chosen.curves.push_back(*curve);
      chosen.about.push_back(curve->about);
    } else {
      chosen.columns.push_back(chosen_column(drawables, name, names));
      chosen.about.push_back(drawables[chosen.columns.back()]);
    }
  }
  require_one_unit(chosen);
  return chosen;
}

void require_tolerance(const Target& target, const Chosen& chosen) {
  for (const Drawable& one : chosen.about) {
    const std::vector<Criterion> criteria = target.criteria();
    const bool is_target = std::any_of(criteria.begin(), criteria.end(), [&](const Criterion& criterion) {
      return bare(criterion.observable) == one.path;
    });
    if (!target.has_tolerance() || !is_target) {
      throw InputError("", "--band", one.path, "has no tolerance: it is not a target of the campaign");
    }
  }
}

// Returns "converged" for a point that is converged or complete, "undecided" for one that has ended
// otherwise, "provisional" for an open one.
const char* state_of(const Json& point) {
  if (!point.at("decided").get<bool>()) return "provisional";
  const std::optional<Verdict> verdict = verdict_of(point.at("state").get<std::string>());
  return verdict && is_reached(*verdict) ? "converged" : "undecided";
}

// True if a mean over `count` seeds is that of the point. If the point has jammed, a mean over half of its
// seeds or fewer does not count, because it is that of the seeds that happened to flow.
bool is_of_point(const Json& point, int count) {
  const Json& endings = point.at("endings");
  return !endings.at("has_jammed").get<bool>() || 2 * count > endings.at("ended").get<int>();
}

Json scaled(const Json& value, double factor) {
  return value.is_number() ? Json(factor * value.get<double>()) : value;
}

// Returns what both kinds of figures say of a point.
Json known_of(const Json& point, const std::string& path) {
  return {{"label", point.at("label")},
          {"settings", point.at("settings")},
          {"quantity", path},
          {"state", state_of(point)},
          {"jammed", point.at("endings").at("has_jammed")}};
}

Json mark_json(const Json& point, const Json& estimate, const std::string& path, double factor) {
  const bool is_known =
      !estimate.is_null() && estimate[0].is_number() && is_of_point(point, estimate[3].get<int>());
  const auto number = [&](std::size_t place) { return is_known ? scaled(estimate[place], factor) : Json(); };
  Json curve = point.at("curve").value(path, Json());
  for (Json& value : curve) value = scaled(value, factor);
  Json made = known_of(point, path);
  made.update(
      {{"mean", number(0)},
       {"standard_error", number(1)},
       {"half_width", number(2)},
       {"good_enough", is_known ? scaled(point.at("good_enough").value(path, Json()), factor) : Json()},
       {"curve", std::move(curve)},
       {"count", is_known ? estimate[3] : point.at("endings").at("ended")}});
  return made;
}

// Returns the numbers of a curve, with those that are not the point's as null; without numbers if `found` is
// null.
Json curve_json(const Json& point, const QuantityEstimate* found, const QuantityCurve& curve, double level,
                double factor_x, double factor_y) {
  Json made = known_of(point, curve.about.path);
  for (const char* const member : {"x", "mean", "standard_error", "half_width", "count"})
    made[member] = Json::array();
  if (found == nullptr) return made;
  for (std::size_t k = 0; k < curve.axis.values.size(); ++k) {
    const Estimate& estimate = found->estimates[curve.offset + k];
    const bool is_known = is_of_point(point, estimate.count);
    const auto number = [&](double value) {
      return is_known && std::isfinite(value) ? Json(factor_y * value) : Json();
    };
    made["x"].push_back(factor_x * curve.axis.values[k].get<double>());
    made["mean"].push_back(number(estimate.mean));
    made["standard_error"].push_back(number(estimate.standard_error));
    made["half_width"].push_back(number(half_width(estimate, level)));
    made["count"].push_back(estimate.count);
  }
  return made;
}

// Says whether the axes can show a number of the figure.
class Visible {
 public:
  explicit Visible(const std::optional<std::string>& log) : log_(log.value_or("")) {}
  void add(const Json& point, std::optional<double> x, const Json& mean) {
    has_jammed_ = has_jammed_ || point.at("jammed").get<bool>();
    if (!mean.is_number()) return;
    has_number_ = true;
    const bool is_hidden = (is_log('y') && mean.get<double>() <= 0) || (is_log('x') && x && *x <= 0);
    is_shown_ = is_shown_ || !is_hidden;
  }
  // Throws InputError if there is none.
  void require(const std::string& quantity) const {
    if (is_shown_) return;
    throw InputError("", "--quantity", quantity,
                     has_number_   ? "has no number that a logarithmic axis can show"
                     : has_jammed_ ? "has no number at any point: all points that have ended have jammed"
                                   : "has no number at any point yet");
  }

 private:
  bool is_log(char name) const { return log_.find(name) != std::string::npos; }
  std::string log_;
  bool has_number_ = false, has_jammed_ = false, is_shown_ = false;
};

// Removes the points for which `is_kept` does not hold; returns how many.
std::size_t leave_out(MeasuredSweep& sweep, const std::function<bool(const Json& point)>& is_kept) {
  const std::size_t all = sweep.page.points.size();
  keep_points(sweep, is_kept);
  return all - sweep.page.points.size();
}

// True if the point has a result, and so derived numbers.
bool has_result(const Json& point) { return point.at("groups").is_object(); }

// One figure, made of the points of a sweep.
class Figure {
 public:
  Figure(Database& database, const FigureChoice& choice)
      : database_(database),
        choice_(choice),
        sweep_(read_sweep(database, choice.where)),
        target_(sweep_.status.campaign.target),
        words_(kept_vocabulary(database)),
        chosen_(chosen_quantities(database, sweep_, wanted())) {
    const bool is_by_other = !choice.over.empty() && chosen_.curves.empty() && !is_swept(choice.over);
    const std::optional<std::size_t> measured =
        is_by_other ? column_called(sweep_.page.drawables, bare(choice.over)) : std::nullopt;
    if (is_by_other || !choice.scale_x.empty() || !choice.scale_y.empty()) {
      absent_ = leave_out(sweep_, has_result);
    }
    if (measured) add_measured_parameter(*measured);
    derived_.emplace(words_, sweep_.page.points);
    if (is_by_other && !measured) add_derived_parameter();
  }

  const Json& parameters() const { return sweep_.parameters; }

  // Returns the pointer of the parameter that is to be on the axis.
  std::string pointer_of_axis() const {
    if (!chosen_.curves.empty()) return choice_.over;
    return chosen_axis(swept_columns(sweep_.parameters, sweep_.page.points), choice_.over).pointer;
  }

  // Adds a parameter whose value at each point is that of its scene, null if the scene has none.
  void add_parameter(const Json& parameter) {
    const std::string pointer = parameter.at("pointer");
    sweep_.parameters.push_back(parameter);
    for (std::size_t i = 0; i < sweep_.page.points.size(); ++i) {
      sweep_.page.points[i]["settings"][pointer] = value_in(sweep_.status.points[i].point.scene, pointer);
    }
  }

  // Adds the name of the campaign as a parameter, by which curves of several campaigns are told apart.
  void add_name(const std::string& name) {
    sweep_.parameters.insert(sweep_.parameters.begin(), campaign_parameter());
    for (Json& point : sweep_.page.points) point["settings"]["campaign"] = name;
  }

  // Returns the document; `over` is the parameter on the axis, chosen if empty.
  Json data(const std::string& over = "") {
    if (!over.empty()) choice_.over = over;
    Json quantities = Json::array();
    const AxisScale of_y = scale("--scale-y", choice_.scale_y, chosen_.about.front().unit);
    for (const Drawable& one : chosen_.about) {
      quantities.push_back(to_json(one));
      quantities.back().update({{"scale", of_y.text}, {"unit", of_y.unit}});
    }
    Json data = {
        {"campaign", sweep_.status.campaign.name}, {"quantities", std::move(quantities)},
        {"confidence", target_.target.confidence}, {"log", choice_.log ? Json(*choice_.log) : Json(nullptr)},
        {"tolerance", choice_.tolerance},          {"absent", absent_}};
    data.update(chosen_.curves.empty() ? over_sweep(of_y) : over_axis(of_y));
    return data;
  }

 private:
  std::vector<std::string> wanted() const {
    return choice_.quantities.empty() ? std::vector{target_.target.observable} : choice_.quantities;
  }

  bool is_swept(const std::string& name) const {
    return std::any_of(sweep_.swept.begin(), sweep_.swept.end(),
                       [&](const Swept& one) { return is_called(one, name); });
  }

  // Adds the derived number `over` to the parameters. A name that is not one is left to chosen_axis().
  void add_derived_parameter() {
    const Json parameter = derived_->parameter(choice_.over);
    if (parameter.is_null()) return;
    const std::vector<double> values = derived_->values("--over", choice_.over);
    for (std::size_t i = 0; i < values.size(); ++i) {
      sweep_.page.points[i]["settings"][choice_.over] = values[i];
    }
    const auto [least, largest] = std::ranges::minmax(values);
    if (values.size() > 1 && least == largest) {
      throw InputError("", "--over", choice_.over,
                       fmt::format("is {:.4g} at every point; --scale-x divides an axis by it", least));
    }
    sweep_.parameters.push_back(parameter);
  }

  // Adds a measured number to the parameters: its mean at each point, with an interval. Points without a mean
  // are left out. Curves follow the parameter that would otherwise be on the axis.
  void add_measured_parameter(std::size_t column) {
    const Drawable& about = sweep_.page.drawables[column];
    along_ = chosen_axis(sweep_.swept, "").pointer;
    choice_.over = about.path;
    const auto estimate_of = [&](const Json& point) {
      return mark_json(point, point.at("estimates")[column], "", 1);
    };
    absent_ +=
        leave_out(sweep_, [&](const Json& point) { return estimate_of(point).at("mean").is_number(); });
    for (Json& point : sweep_.page.points) {
      const Json estimate = estimate_of(point);
      point["settings"][about.path] = estimate.at("mean");
      point["x_half_width"] = estimate.at("half_width");
    }
    sweep_.parameters.push_back({{"pointer", about.path},
                                 {"words", about.element.empty() ? "" : name_of(about)},
                                 {"symbol", about.element.empty() ? about.symbol : ""},
                                 {"unit", about.unit},
                                 {"meaning", ""}});
  }

  AxisScale scale(const char* option, const std::string& name, const std::string& unit) const {
    if (name.empty()) return {"", unit, std::vector<double>(sweep_.page.points.size(), 1.0)};
    return derived_->scale(option, name, unit);
  }

  Json over_sweep(const AxisScale& of_y) {
    if (choice_.tolerance) require_tolerance(target_.target, chosen_);
    const std::vector<Swept> swept = swept_columns(sweep_.parameters, sweep_.page.points);
    Swept axis = chosen_axis(swept, choice_.over);
    if (!choice_.scale_x.empty()) scale_parameter(axis);
    Visible visible(choice_.log);
    Json points = Json::array();
    for (std::size_t i = 0; i < sweep_.page.points.size(); ++i) {
      const Json& point = sweep_.page.points[i];
      for (std::size_t q = 0; q < chosen_.columns.size(); ++q) {
        points.push_back(mark_json(point, point.at("estimates")[chosen_.columns[q]], chosen_.about[q].path,
                                   of_y.factors[i]));
        if (point.contains("x_half_width")) points.back()["x_half_width"] = point["x_half_width"];
        visible.add(points.back(), axis.numeric ? std::optional(axis.numbers[i]) : std::nullopt,
                    points.back().at("mean"));
      }
    }
    visible.require(chosen_.about.front().path);
    Json data = {{"over", axis.pointer}, {"parameters", sweep_.parameters}, {"points", std::move(points)}};
    if (!along_.empty()) data["along"] = along_;
    return data;
  }

  // Scales the values of the parameter at every point.
  void scale_parameter(Swept& axis) {
    if (!axis.numeric) {
      throw InputError("", "--scale-x", choice_.scale_x,
                       fmt::format("needs an axis of numbers, and {} has words", axis.name));
    }
    for (Json& parameter : sweep_.parameters) {
      if (parameter.at("pointer") != axis.pointer) continue;
      const AxisScale of_x = scale("--scale-x", choice_.scale_x, parameter.at("unit"));
      for (std::size_t i = 0; i < axis.numbers.size(); ++i) {
        axis.numbers[i] *= of_x.factors[i];
        Json& point = sweep_.page.points[i];
        point["settings"][axis.pointer] = axis.numbers[i];
        if (point.contains("x_half_width"))
          point["x_half_width"] = scaled(point["x_half_width"], of_x.factors[i]);
      }
      parameter.update({{"scale", of_x.text}, {"unit", of_x.unit}});
    }
  }

  Json over_axis(const AxisScale& of_y) {
    const QuantityAxis& axis = chosen_.curves.front().axis;
    for (const auto& [is_given, option, value] :
         {std::tuple{!choice_.over.empty(), "--over", choice_.over},
          std::tuple{choice_.tolerance, "--band", chosen_.about.front().path}}) {
      if (!is_given) continue;
      throw InputError("", option, value,
                       fmt::format("must not be given: {} has an axis of its own, {}",
                                   chosen_.about.front().path, axis.name));
    }
    const AxisScale of_x = scale("--scale-x", choice_.scale_x, axis.unit);
    Visible visible(choice_.log);
    Json points = Json::array();
    for (std::size_t i = 0; i < sweep_.page.points.size(); ++i) {
      for (Json& curve : curves_of_point(i, of_x.factors[i], of_y.factors[i])) {
        if (curve.at("x").empty()) visible.add(curve, std::nullopt, nullptr);
        for (std::size_t k = 0; k < curve.at("x").size(); ++k) {
          visible.add(curve, curve.at("x")[k].get<double>(), curve.at("mean")[k]);
        }
        points.push_back(std::move(curve));
      }
    }
    visible.require(chosen_.about.front().path);
    return {{"axis", {{"name", axis.name}, {"scale", of_x.text}, {"unit", of_x.unit}}},
            {"parameters", sweep_.parameters},
            {"points", std::move(points)}};
  }

  // Returns the curves of a point: of the seeds of its last stop test, or before the first of all that have
  // ended.
  std::vector<Json> curves_of_point(std::size_t place, double factor_x, double factor_y) {
    const PointSummary& summary = sweep_.status.points[place];
    const int end = summary.stop_tests.empty() ? most_realisations : summary.stop_tests.back().seeds;
    std::vector<std::string> names;
    for (const Drawable& one : chosen_.about) names.push_back(one.name);
    QuantityEstimates sums(names);
    database_.for_each_result(summary.point.id, end, [&](int, const Json& result) { sums.add(result); });
    const std::vector<QuantityEstimate> estimates = sums.estimates();
    std::vector<Json> curves;
    for (const QuantityCurve& curve : chosen_.curves) {
      const auto found = std::find_if(estimates.begin(), estimates.end(), [&](const QuantityEstimate& one) {
        return one.quantity.name == curve.about.name;
      });
      const bool is_there = found != estimates.end();
      const std::optional<QuantityCurve> own =
          is_there ? find_curve({found->quantity}, curve.about.path) : std::nullopt;
      if (own) require_axis(*own, curve, summary.point.label);
      curves.push_back(curve_json(sweep_.page.points[place], own ? &*found : nullptr, own.value_or(curve),
                                  target_.level(), factor_x, factor_y));
    }
    return curves;
  }

  static void require_axis(const QuantityCurve& own, const QuantityCurve& other, const std::string& label) {
    if (own.axis.name == other.axis.name && own.axis.unit == other.axis.unit &&
        own.about.unit == other.about.unit)
      return;
    throw InputError(
        "", "--quantity", own.about.path,
        fmt::format("is in {} over {} at {}, in {} over {} elsewhere; --where chooses the points",
                    own.about.unit, own.axis.name, label, other.about.unit, other.axis.name));
  }

  Database& database_;
  FigureChoice choice_;
  MeasuredSweep sweep_;
  const TargetRecord& target_;
  Vocabulary words_;
  Chosen chosen_;
  std::size_t absent_ = 0;  // points without a result that were left out
  std::optional<DerivedNumbers> derived_;
  std::string along_;  // parameter that curves over a measured number follow; "" over other ones
};

}  // namespace

Json figure_data(Database& database, const FigureChoice& choice) { return Figure(database, choice).data(); }

namespace {

// Throws InputError unless both documents have the same value of a member.
void require_same(const Json& first, const Json& other, const char* member, const std::string& what,
                  const std::string& name) {
  if (first.value(member, Json()) == other.value(member, Json())) return;
  throw InputError("", "--with", name,
                   fmt::format("must have {} as in the first campaign, {}; it has {}", what,
                               first.value(member, Json()).dump(), other.value(member, Json()).dump()));
}

// True if the list has a parameter of the same pointer.
bool has_parameter(const Json& list, const Json& parameter) {
  return std::any_of(list.begin(), list.end(),
                     [&](const Json& one) { return one.at("pointer") == parameter.at("pointer"); });
}

// Calls make(), and names the campaign in its InputError.
template <class Make>
auto of_campaign(const NamedCampaign& source, const Make& make) {
  try {
    return make();
  } catch (const InputError& fault) {
    throw fault.within("campaign " + source.name, "");
  }
}

// Throws InputError if a point has no value of the parameter on the axis.
void require_axis_values(const Json& points, const std::string& over, const std::string& name) {
  for (const Json& point : points) {
    if (!point.at("settings").at(over).is_null()) continue;
    throw InputError("", "--with", name,
                     fmt::format("must have a value of {}, the axis of the figure, in the scene of {}", over,
                                 point.at("label").get<std::string>()));
  }
}

}  // namespace

Json figure_data_of_several(const std::vector<NamedCampaign>& sources, FigureChoice choice) {
  std::vector<std::unique_ptr<Figure>> figures;
  Json all = Json::array();  // parameters that are swept in any of the campaigns
  for (const NamedCampaign& source : sources) {
    figures.push_back(of_campaign(source, [&] { return std::make_unique<Figure>(source.database, choice); }));
    for (const Json& parameter : figures.back()->parameters()) {
      if (!has_parameter(all, parameter)) all.push_back(parameter);
    }
    if (figures.size() == 1 && !choice.over.empty()) choice.over = figures.front()->pointer_of_axis();
  }
  for (std::size_t k = 0; k < sources.size(); ++k) {
    for (const Json& parameter : all) {
      if (!has_parameter(figures[k]->parameters(), parameter)) figures[k]->add_parameter(parameter);
    }
    figures[k]->add_name(sources[k].name);
  }
  Json joined = of_campaign(sources.front(), [&] { return figures.front()->data(); });
  const std::string over = joined.value("over", "");
  if (!over.empty()) require_axis_values(joined.at("points"), over, sources.front().name);
  for (std::size_t k = 1; k < sources.size(); ++k) {
    Json data = of_campaign(sources[k], [&] { return figures[k]->data(over); });
    require_same(joined, data, "quantities", "the quantities", sources[k].name);
    require_same(joined, data, "confidence", "the confidence", sources[k].name);
    require_same(joined, data, "axis", "the axis", sources[k].name);
    if (!over.empty()) require_axis_values(data.at("points"), over, sources[k].name);
    for (Json& point : data["points"]) joined["points"].push_back(std::move(point));
    joined["absent"] = joined["absent"].get<std::size_t>() + data["absent"].get<std::size_t>();
  }
  return joined;
}

}  // namespace peclet::runner
