#include "runner/reports/plan.h"

#include <algorithm>
#include <cmath>

#include "runner/statistics/forecast.h"

namespace peclet::runner {
namespace {

// Of one point that is decided or has a prediction, for every place in the schedule at which it may stop.
class LooksAhead {
 public:
  LooksAhead(const PointPlan& point, const std::vector<int>& schedule, int workers) : point_(point) {
    int seeds = point.ended;
    double rounds = 0;
    for (const int look : schedule) {
      rounds += std::ceil(std::max(0.0, static_cast<double>(look - seeds)) / workers);
      seeds = std::max(seeds, look);
      seeds_.push_back(seeds);
      rounds_.push_back(rounds);
    }
  }

  int seeds(std::size_t future) const { return point_.decided ? point_.ended : seeds_[place(future)]; }
  int to_come(std::size_t future) const { return seeds(future) - point_.ended; }
  double chain_seconds(std::size_t future) const {
    return point_.decided ? 0 : rounds_[place(future)] * point_.cost.wall_seconds;
  }
  const MeasuredCost& cost() const { return point_.cost; }

 private:
  std::size_t place(std::size_t future) const {
    return std::min(seeds_.size() - 1, static_cast<std::size_t>(point_.places[future]));
  }

  const PointPlan& point_;
  std::vector<int> seeds_;      // that will have ended
  std::vector<double> rounds_;  // of all workers until then
};

Totals totals_of(const Plan& plan) {
  Totals totals;
  const std::vector<int> schedule = look_schedule(plan.minimum, plan.maximum);
  std::vector<LooksAhead> points;
  for (const PointPlan& point : plan.points) {
    const bool counts = point.is_predicted() || (point.decided && std::isfinite(point.cost.cpu_seconds));
    if (!counts) continue;
    points.emplace_back(point, schedule, plan.workers);
    totals.predicted += point.is_predicted() ? 1 : 0;
    totals.likely_capped += point.is_predicted() && point.prediction.capped > 0.5 ? 1 : 0;
  }
  totals.points = static_cast<int>(points.size());
  std::vector<double> seeds(futures), cpu(futures), cpu_to_come(futures), wall(futures);
  for (std::size_t future = 0; future < futures; ++future) {
    double work = 0, longest = 0;
    for (const LooksAhead& point : points) {
      seeds[future] += point.seeds(future);
      cpu[future] += point.seeds(future) * point.cost().cpu_seconds;
      cpu_to_come[future] += point.to_come(future) * point.cost().cpu_seconds;
      work += point.to_come(future) * point.cost().wall_seconds;
      longest = std::max(longest, point.chain_seconds(future));
    }
    wall[future] = std::max(work / plan.workers, longest);
  }
  totals.seeds = middle(std::move(seeds));
  totals.cpu_seconds = middle(std::move(cpu));
  totals.cpu_seconds_to_come = middle(std::move(cpu_to_come));
  totals.wall_seconds_to_come = middle(std::move(wall));
  // The machine may be faster or slower than it was for the seeds that the costs come from.
  totals.wall_seconds_to_come.lower /= machine_allowance;
  totals.wall_seconds_to_come.upper *= machine_allowance;
  return totals;
}

// Looks at what is known as a run for the campaign's target would.
void predict_point(PointPlan& point, const Campaign& campaign,
                   const std::vector<std::optional<Outcome>>& outcomes, std::uint64_t stream) {
  const std::vector<Look> looks =
      replay_looks(outcomes, campaign.target, campaign.minimum_realisations, campaign.maximum_realisations);
  if (!looks.empty() && looks.back().verdict != Verdict::more) {
    point.decided = looks.back();
    point.ended = looks.back().seeds;
    return;
  }
  point.ended = static_cast<int>(std::count_if(outcomes.begin(), outcomes.end(),
                                               [](const auto& outcome) { return outcome.has_value(); }));
  point.prediction = predict(outcomes, campaign.target, campaign.minimum_realisations,
                             campaign.maximum_realisations, stream);
}

// Futures in which the points are predicted together.
void draw_futures(Plan& plan, const Campaign& campaign, const std::map<std::string, PointHistory>& known) {
  std::vector<CostShare> shares;
  for (const PointPlan& point : plan.points) {
    const Prediction& made = point.prediction;
    if (!point.is_predicted() || made.seeds.lower == made.seeds.upper) continue;
    shares.push_back({made.seeds.likely * point.cost.cpu_seconds, made.pilot - made.lost});
  }
  const std::vector<double> factors = common_factors(shares);
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    PointPlan& point = plan.points[i];
    if (!point.is_predicted()) continue;
    point.places = places_of_looks(known.at(campaign.points[i].hash).outcomes, campaign.target,
                                   campaign.minimum_realisations, campaign.maximum_realisations, i, factors);
  }
}

}  // namespace

bool PointPlan::is_predicted() const { return !decided && obstacle().empty(); }

std::string PointPlan::obstacle() const {
  if (decided) return "";
  if (prediction.obstacle != Obstacle::none) return obstacle_text(prediction);
  return cost.count > 0 ? "" : "its seeds do not say what they cost";
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
    predict_point(point, campaign, history.outcomes, i);
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
  draw_futures(plan, campaign, known);
  plan.totals = totals_of(plan);
  return plan;
}

}  // namespace peclet::runner
