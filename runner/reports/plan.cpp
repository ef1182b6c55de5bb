#include "runner/reports/plan.h"

#include <algorithm>
#include <cmath>

namespace peclet::runner {
namespace {

// The degrees of freedom of what the open points cost together; NaN if nothing is open.
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

Totals totals_of(const Plan& plan, const Target& target) {
  Totals totals;
  StopRule rule(target, plan.minimum, plan.maximum);
  std::vector<const PointPlan*> points;
  for (const PointPlan& point : plan.points) {
    const bool counts = point.is_predicted() || (point.decided && std::isfinite(point.cost.cpu_seconds));
    if (!counts) continue;
    points.push_back(&point);
    totals.predicted += point.is_predicted() ? 1 : 0;
    totals.likely_capped += point.is_predicted() && point.prediction.capped > 0.5 ? 1 : 0;
  }
  totals.points = static_cast<int>(points.size());
  const double degrees = common_degrees(plan);
  const auto stop_of = [&](const PointPlan& point, double quantile) {
    const Prediction& made = point.prediction;
    if (point.decided) return point.ended;
    return std::max(point.ended, stop_after(made.estimates, made.pilot, rule, truth_at(degrees, quantile)));
  };
  const auto sum_of = [&](const auto& of_point) {
    return expected([&](double quantile) {
      double sum = 0;
      for (const PointPlan* const point : points) sum += of_point(*point, stop_of(*point, quantile));
      return sum;
    });
  };
  totals.seeds = sum_of([](const PointPlan&, int stop) { return stop; });
  totals.cpu_seconds = sum_of([](const PointPlan& point, int stop) { return stop * point.cost.cpu_seconds; });
  totals.cpu_seconds_to_come =
      sum_of([](const PointPlan& point, int stop) { return (stop - point.ended) * point.cost.cpu_seconds; });
  totals.wall_seconds_to_come = expected([&](double quantile) {
    double work = 0, longest = 0;
    for (const PointPlan* const point : points) {
      const int stop = stop_of(*point, quantile);
      const double rounds = rounds_until(point->ended, stop, rule.schedule(), plan.workers);
      work += (stop - point->ended) * point->cost.wall_seconds;
      longest = std::max(longest, rounds * point->cost.wall_seconds);
    }
    return std::max(work / plan.workers, longest);
  });
  // The machine may be faster or slower than it was for the seeds that the costs come from.
  totals.wall_seconds_to_come.lower /= machine_allowance;
  totals.wall_seconds_to_come.upper *= machine_allowance;
  return totals;
}

// Looks at what is known as a run for the campaign's target would.
void predict_point(PointPlan& point, const Campaign& campaign,
                   const std::vector<std::optional<Outcome>>& outcomes) {
  const std::vector<Look> looks =
      replay_looks(outcomes, campaign.target, campaign.minimum_realisations, campaign.maximum_realisations);
  if (!looks.empty() && looks.back().verdict != Verdict::more) {
    point.decided = looks.back();
    point.ended = looks.back().seeds;
    return;
  }
  point.ended = static_cast<int>(std::count_if(outcomes.begin(), outcomes.end(),
                                               [](const auto& outcome) { return outcome.has_value(); }));
  point.prediction =
      predict(outcomes, campaign.target, campaign.minimum_realisations, campaign.maximum_realisations);
}

}  // namespace

bool PointPlan::is_predicted() const { return !decided && obstacle().empty(); }

std::string PointPlan::obstacle() const {
  if (decided) return "";
  if (prediction.obstacle != Obstacle::none) return obstacle_text(prediction);
  return std::isfinite(cost.cpu_seconds) ? "" : "its seeds do not say what they cost";
}

Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, PointHistory>& known, int workers,
               const std::optional<CostGuess>& guess) {
  Plan plan{campaign.name, campaign.minimum_realisations, campaign.maximum_realisations, workers};
  MeasuredCost all;  // per particle-step
  double known_steps = 0;
  for (std::size_t i = 0; i < campaign.points.size(); ++i) {
    PointPlan point{campaign.points[i].label, particle_steps[i], {}};
    const auto found = known.find(campaign.points[i].hash);
    const PointHistory history = found == known.end() ? PointHistory{} : found->second;
    point.cost = history.cost;
    all.cpu_seconds += point.cost.cpu_seconds * point.cost.count;
    all.wall_seconds += point.cost.wall_seconds * point.cost.count;
    known_steps += point.particle_steps * point.cost.count;
    predict_point(point, campaign, history.outcomes);
    plan.points.push_back(std::move(point));
  }
  if (known_steps == 0 && guess && plan.points.at(guess->point).particle_steps > 0) {
    known_steps = plan.points[guess->point].particle_steps;
    all = {0, guess->seconds, guess->seconds};
    plan.guessed_from = plan.points[guess->point].label;
  }
  for (PointPlan& point : plan.points) {
    if (point.cost.count > 0) continue;
    const double share = known_steps > 0 ? point.particle_steps / known_steps : std::nan("");
    point.cost = {0, all.cpu_seconds * share, all.wall_seconds * share};
  }
  plan.totals = totals_of(plan, campaign.target);
  return plan;
}

}  // namespace peclet::runner
