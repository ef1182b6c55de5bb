// How a plan looks to a person, and to a program.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/reports/plan.h"
#include "runner/reports/status.h"
#include "runner/text/duration_text.h"
#include "runner/text/number_text.h"
#include "runner/text/point_columns.h"
#include "runner/text/text_table.h"

namespace peclet::runner {
namespace {

double hours(const PointPlan& point, int seeds) { return point.cost.cpu_seconds * seeds / seconds_per_hour; }

double total_hours(const Plan& plan, int seeds) {
  double total = 0;
  for (const PointPlan& point : plan.points) total += hours(point, seeds);
  return total;
}

// Some point is, or could have been, predicted.
bool has_values(const Plan& plan) {
  return std::any_of(plan.points.begin(), plan.points.end(), [](const PointPlan& point) {
    return point.decided || point.prediction.pilot >= 2 || point.is_predicted();
  });
}

std::string cost_text(const MeasuredCost& cost) {
  if (std::isnan(cost.cpu_seconds)) return "-";
  return cost.count > 0 ? fmt::format("{} ({})", rough(cost.cpu_seconds), cost.count)
                        : "~" + rough(cost.cpu_seconds);
}

template <typename Number>
std::string with_range(const Expected<Number>& value, double unit) {
  if (value.lower == value.upper) return rough(value.likely / unit);
  return fmt::format("{} ({} .. {})", rough(value.likely / unit), rough(value.lower / unit),
                     rough(value.upper / unit));
}

// Seeds, hours and what else is to be said of a point.
std::vector<std::string> predicted_cells(const PointPlan& point) {
  if (point.decided) {
    return {fmt::format("{}", point.decided->seeds), rough(hours(point, point.decided->seeds)),
            to_string(point.decided->verdict)};
  }
  const Prediction& prediction = point.prediction;
  if (!point.is_predicted()) return {"-", "-", point.obstacle()};
  std::string remark;
  if (prediction.lost > 0) remark = fmt::format("{} of {} seeds are lost", prediction.lost, prediction.pilot);
  if (prediction.capped >= 0.05) {
    remark += fmt::format("{}not converged by the maximum: {:.0f} %", remark.empty() ? "" : "; ",
                          100 * prediction.capped);
  }
  return {with_range(prediction.seeds, 1),
          with_range(prediction.seeds, seconds_per_hour / point.cost.cpu_seconds), remark};
}

std::vector<std::string> bare_cells(const Plan& plan, const PointPlan& point) {
  return {rough(hours(point, plan.minimum)), rough(hours(point, plan.maximum))};
}

std::string table_text(const Plan& plan, bool predicted) {
  std::vector<std::string> labels;
  double steps = 0;
  for (const PointPlan& point : plan.points) {
    labels.push_back(point.label);
    steps += point.particle_steps;
  }
  const PointColumns columns(labels);
  TextTable table;
  columns.add_to(table);
  table.add_column("particle-steps/seed");
  table.add_column("CPU s/seed");
  table.add_column(predicted ? "seeds" : fmt::format("CPU h, {} seeds", plan.minimum));
  table.add_column(predicted ? "CPU h" : fmt::format("CPU h, {} seeds", plan.maximum));
  if (predicted) table.add_column("", TextTable::Align::left);
  const auto add_row = [&](std::vector<std::string> row, const std::vector<std::string>& rest) {
    row.insert(row.end(), rest.begin(), rest.end());
    table.add_row(std::move(row));
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const PointPlan& point = plan.points[i];
    std::vector<std::string> row = columns.cells(i);
    row.insert(row.end(), {rough(point.particle_steps), cost_text(point.cost)});
    add_row(std::move(row), predicted ? predicted_cells(point) : bare_cells(plan, point));
  }
  std::vector<std::string> all(columns.count());
  all.front() = "all";
  all.insert(all.end(), {rough(steps), ""});
  if (predicted) {
    const Totals& totals = plan.totals;
    const bool known = totals.points > 0;
    add_row(std::move(all), {known ? with_range(totals.seeds, 1) : "-",
                             known ? with_range(totals.cpu_seconds, seconds_per_hour) : "-", ""});
  } else {
    add_row(std::move(all), {rough(total_hours(plan, plan.minimum)), rough(total_hours(plan, plan.maximum))});
  }
  return table.text();
}

std::string legend(const Plan& plan, bool predicted) {
  const bool unknown = std::isnan(total_hours(plan, 1));
  std::string text =
      unknown
          ? "-: not known before a seed has ended\n"
          : "CPU seconds per seed: mean (of so many seeds); ~: scaled from other points by particle-steps\n";
  if (!plan.guessed_from.empty()) {
    text = fmt::format(
        "~: a guess, from the first two seconds of one realisation of {} and the particle-steps of the "
        "others; "
        "--pilot measures\n",
        plan.guessed_from);
  }
  for (const std::string& trial : plan.broke_off) text += fmt::format("the trial of {}\n", trial);
  if (predicted && plan.minimum < plan.maximum) {
    text +=
        "seeds: of the look that will decide, expected (range that holds it 95 % of the time)\n"
        "CPU h: of these seeds; all: expected and range of the sum, which are not the sums of those above\n";
  }
  return text;
}

std::string time_text(const Expected<double>& seconds) {
  return fmt::format("{} ({} to {})", duration_text(seconds.likely), duration_text(seconds.lower),
                     duration_text(seconds.upper));
}

std::string ending_text(const Plan& plan) {
  const Totals& totals = plan.totals;
  if (totals.predicted == 0) {
    const bool all_decided = std::all_of(plan.points.begin(), plan.points.end(),
                                         [](const PointPlan& point) { return point.decided.has_value(); });
    return all_decided ? "every point is decided\n"
                       : "nothing can be predicted of the points that are open\n";
  }
  const auto others = static_cast<int>(plan.points.size()) - totals.points;
  std::string text;
  if (others > 0) text += fmt::format("points without a prediction, {}, are not in these sums\n", others);
  if (totals.likely_capped > 0) {
    text += fmt::format("{} of {} points {} not expected to converge within {} seeds\n", totals.likely_capped,
                        plan.points.size(), totals.likely_capped == 1 ? "is" : "are", plan.maximum);
  }
  return text +
         fmt::format("still to come: {} of processor time; with {} worker{} {}, until {:%Y-%m-%d %H:%M}\n",
                     time_text(totals.cpu_seconds_to_come), plan.workers, plan.workers == 1 ? "" : "s",
                     time_text(totals.wall_seconds_to_come),
                     fmt::localtime(plan.made_at + std::llround(totals.wall_seconds_to_come.likely)));
}

// A way that people may not know of; which one is taken is theirs to say.
std::string rest_text(const Plan& plan) {
  std::string text;
  for (const PointPlan& point : plan.points) {
    if (point.flow_over_rest) text += fmt::format("  {}: {}\n", point.label, rough(*point.flow_over_rest));
  }
  if (text.empty()) return text;
  return "\nNearly at rest. Processor time over that of the same error at rest, by linear_response (a "
         "guess):\n" +
         text;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Number>
Json range_json(const Expected<Number>& value, double unit) {
  return {{"expected", number(value.likely / unit)},
          {"lower", number(value.lower / unit)},
          {"upper", number(value.upper / unit)}};
}

Json prediction_json(const PointPlan& point) {
  if (!point.is_predicted()) return nullptr;
  const Prediction& prediction = point.prediction;
  return {{"pilot", prediction.pilot},
          {"seeds",
           {{"expected", prediction.seeds.likely},
            {"lower", prediction.seeds.lower},
            {"upper", prediction.seeds.upper}}},
          {"cpu_hours", range_json(prediction.seeds, seconds_per_hour / point.cost.cpu_seconds)},
          {"capped_probability", prediction.capped}};
}

Json totals_json(const Plan& plan) {
  const Totals& totals = plan.totals;
  if (totals.predicted == 0) return nullptr;
  const double wall = totals.wall_seconds_to_come.likely;
  return {
      {"points", totals.points},
      {"seeds", range_json(totals.seeds, 1)},
      {"cpu_hours", range_json(totals.cpu_seconds, seconds_per_hour)},
      {"cpu_hours_to_come", range_json(totals.cpu_seconds_to_come, seconds_per_hour)},
      {"wall_hours_to_come", range_json(totals.wall_seconds_to_come, seconds_per_hour)},
      {"workers", plan.workers},
      {"finished_at", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(plan.made_at + std::llround(wall)))},
      {"likely_capped", totals.likely_capped}};
}

}  // namespace

std::string plan_text(const Plan& plan) {
  const bool predicted = has_values(plan);
  return fmt::format("{}: {}, {} seeds each\n\n{}\n{}{}{}", plan.campaign,
                     counted(plan.points.size(), "point"), range_text(plan.minimum, plan.maximum),
                     table_text(plan, predicted), legend(plan, predicted),
                     predicted ? '\n' + ending_text(plan) : "", rest_text(plan));
}

Json plan_json(const Plan& plan) {
  Json points = Json::array();
  for (const PointPlan& point : plan.points) {
    const std::string obstacle = point.obstacle();
    points.push_back({{"label", point.label},
                      {"particle_steps", point.particle_steps},
                      {"measured_seeds", point.cost.count},
                      {"cpu_seconds_per_seed", number(point.cost.cpu_seconds)},
                      {"cpu_hours_minimum", number(hours(point, plan.minimum))},
                      {"cpu_hours_maximum", number(hours(point, plan.maximum))},
                      {"verdict", point.decided ? Json(to_string(point.decided->verdict)) : Json(nullptr)},
                      {"seeds_ended", point.ended},
                      {"prediction", prediction_json(point)},
                      {"flow_over_rest", number(point.flow_over_rest.value_or(std::nan("")))},
                      {"obstacle", obstacle.empty() ? Json(nullptr) : Json(obstacle)}});
  }
  return {{"schema_version", 1},
          {"campaign", plan.campaign},
          {"realisations", {{"minimum", plan.minimum}, {"maximum", plan.maximum}}},
          {"points", points},
          {"cpu_hours_minimum", number(total_hours(plan, plan.minimum))},
          {"cpu_hours_maximum", number(total_hours(plan, plan.maximum))},
          {"trials_broken_off", plan.broke_off},
          {"guessed_from", plan.guessed_from.empty() ? Json(nullptr) : Json(plan.guessed_from)},
          {"prediction", totals_json(plan)}};
}

}  // namespace peclet::runner
