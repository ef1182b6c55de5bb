#include "runner/reports/plan.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/campaign/number_text.h"
#include "runner/campaign/text_table.h"
#include "runner/reports/status.h"
#include "runner/statistics/curve_forecast.h"
#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

// Returns the degrees of freedom of the summed cost of the open points; NaN if none is open.
double common_degrees(const Plan& plan) {
  double sum = 0, squares = 0;
  for (const PointPlan& point : plan.points) {
    const Prediction& made = point.prediction;
    if (!point.is_predicted() || made.seeds.lower == made.seeds.upper) continue;
    const double cost = made.seeds.likely * point.cost.cpu_seconds;
    sum += cost;
    squares += cost * cost / (made.fewest_values() - 1);
  }
  return sum * sum / squares;
}

// Where the points are expected to be decided; those of curves together.
class ExpectedStops {
 public:
  ExpectedStops(const Plan& plan, const Campaign& campaign)
      : plan_(plan), campaign_(campaign), rule_(campaign.target, plan.minimum, plan.maximum) {
    if (campaign.curves.empty()) return;
    std::vector<SeedsSoFar> so_far;
    so_far.reserve(plan.points.size());
    for (const PointPlan& point : plan.points) so_far.push_back(seeds_so_far(point));
    for (const Curve& curve : campaign.curves)
      curves_.emplace_back(curve, so_far, campaign.target, plan.minimum, plan.maximum);
  }

  // Returns the seeds of each point, if the truth deviates from its values by this.
  std::vector<int> at(const TruthOf& truth_of) {
    std::vector<int> stops;
    for (const PointPlan& point : plan_.points) {
      const Prediction& made = point.prediction;
      stops.push_back(point.ended);
      if (point.is_predicted() && curves_.empty()) {
        stops.back() = std::max(
            stops.back(), stop_after(made.estimates, made.pilot, rule_, truth_of(made.fewest_values())));
      }
    }
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const std::vector<int> joint = curves_[i].stops(truth_of);
      for (std::size_t k = 0; k < joint.size(); ++k) {
        int& stop = stops[campaign_.curves[i].points[k]];
        stop = std::max(stop, joint[k]);
      }
    }
    return stops;
  }

 private:
  SeedsSoFar seeds_so_far(const PointPlan& point) const {
    const double cost = std::isfinite(point.cost.cpu_seconds) ? point.cost.cpu_seconds : 0;
    SeedsSoFar known{point.prediction.estimates, point.prediction.pilot, cost, false};
    if (point.decided) {
      known.ended = point.ended;
      known.is_done = true;
      for (const ObservableStopTest& one : point.decided->each) known.estimates.push_back(one.estimate);
    }
    known.estimates.resize(campaign_.target.observables().size());  // of no values before two seeds
    return known;
  }

  const Plan& plan_;
  const Campaign& campaign_;
  StopRule rule_;
  std::vector<CurveForecast> curves_;
};

// Sets the prediction of a point that is not decided from the known outcomes, by itself.
void predict_point(PointPlan& point, const Campaign& campaign,
                   const std::vector<std::optional<Outcome>>& outcomes) {
  point.ended = static_cast<int>(std::count_if(outcomes.begin(), outcomes.end(),
                                               [](const auto& outcome) { return outcome.has_value(); }));
  point.prediction =
      predict(outcomes, campaign.target, campaign.minimum_realisations, campaign.maximum_realisations);
}

// Predicts the points of curves together.
void predict_curves(Plan& plan, const Campaign& campaign) {
  if (campaign.curves.empty()) return;
  ExpectedStops stops_of(plan, campaign);
  const auto at = [&](double quantile) {
    return stops_of.at([&](int values) { return truth_at(values - 1, quantile); });
  };
  constexpr int futures = 20;
  std::vector<int> capped(plan.points.size());
  for (int future = 0; future < futures; ++future) {
    const std::vector<int> stops = at((future + 0.5) / futures);
    for (std::size_t i = 0; i < stops.size(); ++i) capped[i] += stops[i] == plan.maximum ? 1 : 0;
  }
  const Expected<std::vector<int>> all = expected(at);
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (!plan.points[i].is_predicted()) continue;
    Prediction& made = plan.points[i].prediction;
    const auto [lower, upper] = std::minmax({all.lower[i], all.likely[i], all.upper[i]});
    made.seeds = {all.likely[i], lower, upper};
    made.capped = static_cast<double>(capped[i]) / futures;
  }
}

// Sets the deciding stop test of each point, or else its prediction.
void predict_points(Plan& plan, const Campaign& campaign,
                    const std::vector<std::vector<std::optional<Outcome>>>& outcomes) {
  const Scheduler scheduler(outcomes, campaign.target, plan.minimum, plan.maximum, campaign.curves);
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    PointPlan& point = plan.points[i];
    const auto number = static_cast<int>(i);
    if (scheduler.decided(number)) {
      point.decided = scheduler.stop_tests(number).back();
      point.ended = point.decided->seeds;
    } else {
      predict_point(point, campaign, outcomes[i]);
    }
  }
  predict_curves(plan, campaign);
}

Totals totals_of(const Plan& plan, const Campaign& campaign) {
  Totals totals;
  const std::vector<int> schedule = stop_test_schedule(plan.minimum, plan.maximum);
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const PointPlan& point = plan.points[i];
    const bool counts = point.is_predicted() || (point.decided && std::isfinite(point.cost.cpu_seconds));
    if (!counts) continue;
    points.push_back(i);
    totals.predicted += point.is_predicted() ? 1 : 0;
    totals.likely_capped += point.is_predicted() && point.prediction.capped > 0.5 ? 1 : 0;
  }
  totals.points = static_cast<int>(points.size());
  const double degrees = common_degrees(plan);
  ExpectedStops stops_of(plan, campaign);
  std::map<double, std::vector<int>> stops;  // by quantile
  const auto stops_at = [&](double quantile) -> const std::vector<int>& {
    std::vector<int>& known = stops[quantile];
    if (known.empty()) known = stops_of.at([&](int) { return truth_at(degrees, quantile); });
    return known;
  };
  const auto sum_of = [&](const auto& of_point) {
    return expected([&](double quantile) {
      const std::vector<int>& at = stops_at(quantile);
      double sum = 0;
      for (const std::size_t i : points) sum += of_point(plan.points[i], at[i]);
      return sum;
    });
  };
  totals.seeds = sum_of([](const PointPlan&, int stop) { return stop; });
  totals.cpu_seconds = sum_of([](const PointPlan& point, int stop) { return stop * point.cost.cpu_seconds; });
  totals.cpu_seconds_to_come =
      sum_of([](const PointPlan& point, int stop) { return (stop - point.ended) * point.cost.cpu_seconds; });
  const int places = plan.workers * plan.capacity;
  totals.wall_seconds_to_come = expected([&](double quantile) {
    const std::vector<int>& at = stops_at(quantile);
    double work = 0, longest = 0;
    for (const std::size_t i : points) {
      const PointPlan& point = plan.points[i];
      const double rounds = rounds_until(point.ended, at[i], schedule, places);
      work += (at[i] - point.ended) * point.cost.wall_seconds;
      longest = std::max(longest, rounds * point.cost.wall_seconds);
    }
    return std::max(work / places, longest);
  });
  // The machine may become faster or slower than it was for the measured seeds.
  totals.wall_seconds_to_come.lower /= machine_allowance;
  totals.wall_seconds_to_come.upper *= machine_allowance;
  return totals;
}

}  // namespace

bool PointPlan::is_predicted() const { return !decided && obstacle().empty(); }

std::string PointPlan::obstacle() const {
  if (decided) return "";
  if (prediction.obstacle != Obstacle::none) return obstacle_text(prediction);
  return std::isfinite(cost.cpu_seconds) ? "" : "the cost of its seeds is unknown";
}

Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, PointHistory>& known, int workers,
               const std::optional<CostGuess>& guess, int capacity) {
  Plan plan{campaign.name, campaign.minimum_realisations, campaign.maximum_realisations, workers, capacity};
  if (campaign.most_values > 0) {
    const auto values = static_cast<int>(campaign.curves.front().axis.size());
    plan.values_to_choose = std::max(0, campaign.most_values - values);
    plan.over = campaign.target.over();
  }
  MeasuredCost all;  // summed over all ended realisations
  double known_steps = 0;
  std::vector<std::vector<std::optional<Outcome>>> outcomes;  // of each point
  for (std::size_t i = 0; i < campaign.points.size(); ++i) {
    PointPlan point{campaign.points[i].label, particle_steps[i], {}};
    const auto found = known.find(campaign.points[i].hash);
    const PointHistory history = found == known.end() ? PointHistory{} : found->second;
    point.cost = history.cost;
    all.cpu_seconds += point.cost.cpu_seconds * point.cost.count;
    all.wall_seconds += point.cost.wall_seconds * point.cost.count;
    known_steps += point.particle_steps * point.cost.count;
    outcomes.push_back(history.outcomes);
    plan.points.push_back(std::move(point));
  }
  if (known_steps == 0 && guess && plan.points.at(guess->point).particle_steps > 0) {
    known_steps = plan.points[guess->point].particle_steps;
    all = {0, guess->seconds / capacity, guess->seconds};
    plan.guessed_from = plan.points[guess->point].label;
  }
  for (PointPlan& point : plan.points) {
    if (point.cost.count > 0) continue;
    const double share = known_steps > 0 ? point.particle_steps / known_steps : std::nan("");
    point.cost = {0, all.cpu_seconds * share, all.wall_seconds * share};
  }
  predict_points(plan, campaign, outcomes);
  plan.totals = totals_of(plan, campaign);
  return plan;
}

// Texts and JSON of a plan.

namespace {

double hours(const PointPlan& point, int seeds) { return point.cost.cpu_seconds * seeds / seconds_per_hour; }

double total_hours(const Plan& plan, int seeds) {
  double total = 0;
  for (const PointPlan& point : plan.points) total += hours(point, seeds);
  return total;
}

// Returns true if some point is decided, predicted, or has two pilot seeds.
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

// Returns the cells of seeds, hours and remark of a point.
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
    remark += fmt::format("{}probability of no convergence by the maximum: {:.0f} %",
                          remark.empty() ? "" : "; ", 100 * prediction.capped);
  }
  return {with_range(prediction.seeds, 1),
          with_range(prediction.seeds, seconds_per_hour / point.cost.cpu_seconds), remark};
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
    add_row(std::move(row),
            predicted ? predicted_cells(point)
                      : std::vector{rough(hours(point, plan.minimum)), rough(hours(point, plan.maximum))});
  }
  std::vector<std::string> all(columns.count());
  all.front() = "all";
  all.insert(all.end(), {rough(steps), ""});
  const Totals& totals = plan.totals;
  if (!predicted) {
    add_row(std::move(all), {rough(total_hours(plan, plan.minimum)), rough(total_hours(plan, plan.maximum))});
  } else if (totals.points == 0) {
    add_row(std::move(all), {"-", "-", ""});
  } else {
    add_row(std::move(all),
            {with_range(totals.seeds, 1), with_range(totals.cpu_seconds, seconds_per_hour), ""});
  }
  return table.text();
}

std::string legend(const Plan& plan, bool predicted) {
  const bool unknown = std::isnan(total_hours(plan, 1));
  std::string text =
      unknown ? "-: not known before a seed has ended\n"
              : "CPU s/seed: mean (number of ended seeds); ~: scaled from other points by particle-steps\n";
  if (!plan.guessed_from.empty()) {
    text = fmt::format(
        "~: a guess, from the first two seconds of one realisation of {} and the particle-steps of the "
        "others; --pilot measures the costs\n",
        plan.guessed_from);
  }
  for (const std::string& trial : plan.broke_off) text += fmt::format("the trial of {}\n", trial);
  if (predicted && plan.minimum < plan.maximum) {
    text +=
        "seeds: expected at the deciding stop test (range that holds their number 95 % of the time)\n"
        "CPU h: of these seeds; all: expected value and range of the sum, not the sums of the ranges above\n";
  }
  return text;
}

std::string time_text(const Expected<double>& seconds) {
  return fmt::format("{} ({} to {})", duration_text(seconds.likely), duration_text(seconds.lower),
                     duration_text(seconds.upper));
}

// Returns what the seeds that open points must have, and have not yet, take; "" if that is not known.
std::string first_seeds_text(const Plan& plan) {
  double seconds = 0;
  for (const PointPlan& point : plan.points) {
    if (!point.decided) seconds += std::max(0, plan.minimum - point.ended) * point.cost.cpu_seconds;
  }
  if (!(seconds > 0)) return "";
  return fmt::format("; the {} seeds that each of them needs at least take another {} of processor time",
                     plan.minimum, duration_text(seconds));
}

std::string ending_text(const Plan& plan) {
  const Totals& totals = plan.totals;
  if (totals.predicted == 0) {
    const bool all_decided = std::all_of(plan.points.begin(), plan.points.end(),
                                         [](const PointPlan& point) { return point.decided.has_value(); });
    return all_decided ? "every point is decided\n"
                       : "no prediction is possible for the open points" + first_seeds_text(plan) + '\n';
  }
  const auto others = static_cast<int>(plan.points.size()) - totals.points;
  std::string text;
  if (others > 0) text += fmt::format("these sums leave out the points without a prediction: {}\n", others);
  if (totals.likely_capped > 0) {
    text += fmt::format("{} of {} points {} not expected to converge within {} seeds\n", totals.likely_capped,
                        plan.points.size(), totals.likely_capped == 1 ? "is" : "are", plan.maximum);
  }
  return text +
         fmt::format("still to come: {} of processor time; with {} worker{}{} {}, until {:%Y-%m-%d %H:%M}\n",
                     time_text(totals.cpu_seconds_to_come), plan.workers, plan.workers == 1 ? "" : "s",
                     plan.capacity == 1 ? "" : fmt::format(" of {} realisations at once", plan.capacity),
                     time_text(totals.wall_seconds_to_come),
                     fmt::localtime(plan.made_at + std::llround(totals.wall_seconds_to_come.likely)));
}

// Returns the points for which linear_response at rest may be cheaper. The choice is the user's.
std::string rest_text(const Plan& plan) {
  std::string text;
  for (const PointPlan& point : plan.points) {
    if (point.flow_over_rest) text += fmt::format("  {}: {}\n", point.label, rough(*point.flow_over_rest));
  }
  if (text.empty()) return text;
  return "\nThese points are nearly at rest. Processor time over that for the same error at rest, with "
         "linear_response (a guess):\n" +
         text;
}

// Returns what a campaign that chooses values adds to the plan, which has none of them.
std::string choice_text(const Plan& plan) {
  if (plan.values_to_choose == 0) return "";
  return fmt::format("\nThe run may add {} of {} (/choose), which {} not in this plan.\n",
                     counted(static_cast<std::size_t>(plan.values_to_choose), "value"), plan.over,
                     plan.values_to_choose == 1 ? "is" : "are");
}

template <typename Number>
Json range_json(const Expected<Number>& value, double unit) {
  return {{"expected", number_json(value.likely / unit)},
          {"lower", number_json(value.lower / unit)},
          {"upper", number_json(value.upper / unit)}};
}

Json prediction_json(const PointPlan& point) {
  if (!point.is_predicted()) return nullptr;
  const Prediction& prediction = point.prediction;
  return {{"pilot", prediction.pilot},
          {"seeds", range_json(prediction.seeds)},
          {"cpu_hours", range_json(prediction.seeds, seconds_per_hour / point.cost.cpu_seconds)},
          {"capped_probability", prediction.capped}};
}

Json totals_json(const Plan& plan) {
  const Totals& totals = plan.totals;
  if (totals.predicted == 0) return nullptr;
  const double wall = totals.wall_seconds_to_come.likely;
  Json json = {
      {"points", totals.points},
      {"seeds", range_json(totals.seeds, 1)},
      {"cpu_hours", range_json(totals.cpu_seconds, seconds_per_hour)},
      {"cpu_hours_to_come", range_json(totals.cpu_seconds_to_come, seconds_per_hour)},
      {"wall_hours_to_come", range_json(totals.wall_seconds_to_come, seconds_per_hour)},
      {"workers", plan.workers},
      {"finished_at", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(plan.made_at + std::llround(wall)))},
      {"likely_capped", totals.likely_capped}};
  if (plan.capacity > 1) json["capacity"] = plan.capacity;
  return json;
}

}  // namespace

std::string plan_text(const Plan& plan) {
  const bool predicted = has_values(plan);
  return fmt::format("{}: {}, {} seeds each\n\n{}\n{}{}{}{}", plan.campaign,
                     counted(plan.points.size(), "point"), range_text(plan.minimum, plan.maximum),
                     table_text(plan, predicted), legend(plan, predicted),
                     predicted ? '\n' + ending_text(plan) : "", rest_text(plan), choice_text(plan));
}

Json plan_json(const Plan& plan) {
  Json points = Json::array();
  for (const PointPlan& point : plan.points) {
    const std::string obstacle = point.obstacle();
    points.push_back({{"label", point.label},
                      {"particle_steps", point.particle_steps},
                      {"measured_seeds", point.cost.count},
                      {"cpu_seconds_per_seed", number_json(point.cost.cpu_seconds)},
                      {"cpu_hours_minimum", number_json(hours(point, plan.minimum))},
                      {"cpu_hours_maximum", number_json(hours(point, plan.maximum))},
                      {"verdict", point.decided ? Json(to_string(point.decided->verdict)) : Json(nullptr)},
                      {"seeds_ended", point.ended},
                      {"prediction", prediction_json(point)},
                      {"flow_over_rest", number_json(point.flow_over_rest.value_or(std::nan("")))},
                      {"obstacle", obstacle.empty() ? Json(nullptr) : Json(obstacle)}});
  }
  return {{"schema_version", 1},
          {"campaign", plan.campaign},
          {"realisations", {{"minimum", plan.minimum}, {"maximum", plan.maximum}}},
          {"points", points},
          {"cpu_hours_minimum", number_json(total_hours(plan, plan.minimum))},
          {"cpu_hours_maximum", number_json(total_hours(plan, plan.maximum))},
          {"trials_broken_off", plan.broke_off},
          {"guessed_from", plan.guessed_from.empty() ? Json(nullptr) : Json(plan.guessed_from)},
          {"values_to_choose", plan.values_to_choose},
          {"prediction", totals_json(plan)}};
}

}  // namespace peclet::runner
