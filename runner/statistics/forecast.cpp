#include "runner/statistics/forecast.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <utility>

#include "runner/campaign/number_text.h"
#include "runner/statistics/curve_forecast.h"

namespace peclet::runner {
namespace {

// The scatter of fewer costs is assumed.
constexpr int fewest_costs = 3;
constexpr double unknown_scatter = 0.5;  // standard deviation over mean

int least_count(const std::vector<Estimate>& estimates) {
  const auto has_fewer = [](const Estimate& one, const Estimate& other) { return one.count < other.count; };
  const auto fewest = std::min_element(estimates.begin(), estimates.end(), has_fewer);
  return fewest == estimates.end() ? 0 : fewest->count;
}

// Returns the true share at a quantile, counted from 0 or 1 towards 1/2.
double share_at(const Estimate& known, double quantile) {
  return share_quantile(known.count, known.mean, known.mean < 0.5 ? quantile : 1 - quantile);
}

// Returns the estimates that are expected from `seeds` seeds: with larger counts and smaller standard errors.
std::vector<Estimate> expected_at(const std::vector<Estimate>& all_seeds, int ended, int seeds,
                                  const Truth& truth) {
  std::vector<Estimate> expected = all_seeds;
  for (Estimate& one : expected) {
    const double growth = static_cast<double>(seeds) / ended;
    const auto values = static_cast<int>(std::lround(one.count * growth));
    const double share = static_cast<double>(values) / one.count;
    if (one.values == Estimate::Values::share && truth.quantile) {
      one.mean += (1 - 1 / share) * (share_at(one, *truth.quantile) - one.mean);
    }
    one.standard_error *= std::sqrt(truth.variance / share);
    one.count = values;
  }
  return expected;
}

Obstacle obstacle_of(const Prediction& made, const Target& target) {
  if (made.pilot < 2) return Obstacle::too_few;
  if (made.fewest_values() < 2) return Obstacle::lost;
  const std::vector<std::string> observables = target.observables();
  const auto known = [&](const std::string& name) {
    const auto place = std::find(observables.begin(), observables.end(), name) - observables.begin();
    return made.estimates[static_cast<std::size_t>(place)];
  };
  Obstacle found = Obstacle::none;
  for (const auto& [observable, tolerance] : target.criteria()) {
    if (known(observable).values == Estimate::Values::equal) return Obstacle::no_spread;
    const Estimate measure = known(tolerance.relative_to.empty() ? observable : tolerance.relative_to);
    if (tolerance.needs_a_mean() && 2 * measure.standard_error >= std::abs(measure.mean))
      found = Obstacle::near_zero;
  }
  return found;
}

struct Spread {
  double mean = 0, deviation = 0, error = 0;
};

// Returns the spread of costs with this mean and mean square. `shares` is the sum of the squared shares that
// the costs have in the mean, 1 / n for n equal ones.
Spread spread_of(double mean, double mean_square, double shares) {
  const double known = 1 / shares;  // effective number of costs
  const double variance = std::max(0.0, mean_square - mean * mean) / (1 - shares);
  const double deviation = std::lround(known) < fewest_costs ? unknown_scatter * mean : std::sqrt(variance);
  return {mean, deviation, deviation / std::sqrt(known)};
}

Spread spread(const Cost& ended, std::vector<Unfinished> running) {
  std::sort(running.begin(), running.end(),
            [](const Unfinished& one, const Unfinished& other) { return one.taken < other.taken; });
  double longest = 0;
  for (const Unfinished& one : running) longest = std::max(longest, one.whole.value_or(0));
  const auto count = static_cast<double>(ended.count()) + static_cast<double>(running.size());
  double sum = 0, squares = 0, squared_shares = 0;
  double share = 1;  // of a seed, over 1 / count: its own and those passed on by shorter running seeds
  const auto count_in = [&](double seconds) {
    sum += share * seconds;
    squares += share * seconds * seconds;
    squared_shares += share * share;
  };
  auto later = count;  // number of seeds that have taken longer
  auto next = running.begin();
  for (const double seconds : ended.ascending()) {
    for (; next != running.end() && next->taken < seconds; ++next) {
      later -= 1;
      share += share / later;
    }
    later -= 1;
    count_in(seconds);
  }
  for (; next != running.end(); ++next) count_in(std::max(next->taken, next->whole.value_or(longest)));
  return spread_of(sum / count, squares / count, squared_shares / (count * count));
}

Spread spread(const std::vector<PointForecast>& points) {
  double count = 0, sum = 0, squares = 0;
  for (const PointForecast& point : points) {
    count += point.cost.count();
    sum += point.cost.sum();
    squares += point.cost.squares();
  }
  return spread_of(sum / count, squares / count, 1 / count);
}

// Returns the cost of a seed of the point. If no seed has ended and no running one has a rate, the cost is
// that of all points, and at least the longest time that a running seed has taken.
Spread spread(const PointForecast& point, const Spread& of_all) {
  const auto is_known = [](const Unfinished& one) { return one.whole.has_value(); };
  if (point.cost.count() > 0 || std::any_of(point.unfinished.begin(), point.unfinished.end(), is_known))
    return spread(point.cost, point.unfinished);
  Spread guessed = of_all;
  for (const Unfinished& one : point.unfinished) guessed.mean = std::max(guessed.mean, one.taken);
  return guessed;
}

// The quantiles of a point's true variance at the ends of its expected seeds.
constexpr double outside = 0.1;

// Returns the seeds at which the point is expected to stop: with the variance of the sample, and with the
// true variance at the outer quantiles.
Expected<int> seeds_of(const PointForecast& point, StopRule& rule) {
  const int minimum = rule.schedule().front(), maximum = rule.schedule().back();
  const int values = least_count(point.all_seeds);
  if (values < 2 || !rule.has_measure(point.all_seeds)) return {minimum, minimum, maximum};
  const auto at = [&](const Truth& truth) { return stop_after(point.all_seeds, point.ended, rule, truth); };
  return {at({}), at(truth_at(values - 1, outside)), at(truth_at(values - 1, 1 - outside))};
}

}  // namespace

Truth truth_at(double degrees, double quantile) {
  return {std::isnan(degrees) ? 1 : variance_excess(degrees, 1 - quantile), quantile};
}

int stop_after(const std::vector<Estimate>& all_seeds, int ended, StopRule& rule, const Truth& truth) {
  const std::vector<int>& schedule = rule.schedule();
  if (!rule.has_tolerance()) return schedule.back();
  const auto stops = [&](int seeds) { return rule.is_met(expected_at(all_seeds, ended, seeds, truth)); };
  const auto later = std::upper_bound(schedule.begin(), schedule.end(), ended);
  const auto enough = std::find_if(later, schedule.end(), stops);
  return enough == schedule.end() ? schedule.back() : *enough;
}

double rounds_until(int ended, int seeds, const std::vector<int>& schedule, int workers) {
  double rounds = 0;
  for (const int stop_test : schedule) {
    if (stop_test <= ended || stop_test > seeds) continue;
    rounds += std::ceil(static_cast<double>(stop_test - ended) / workers);
    ended = stop_test;
  }
  return rounds;
}

Prediction predict(const std::vector<std::optional<Outcome>>& outcomes, const Target& target, int minimum,
                   int maximum) {
  StopRule rule(target, minimum, maximum);
  const auto end = outcomes.begin() + std::min<std::ptrdiff_t>(std::ssize(outcomes), maximum);
  const std::span pilot(outcomes.begin(), std::find(outcomes.begin(), end, std::nullopt));
  Prediction made;
  made.pilot = static_cast<int>(pilot.size());
  made.estimates = estimates_so_far(pilot, target.observables().size());
  made.lost = made.pilot - least_count(made.estimates);
  if (!target.has_tolerance()) {
    made.seeds = {maximum, maximum, maximum};
    return made;
  }
  made.obstacle = obstacle_of(made, target);
  if (made.obstacle != Obstacle::none) return made;
  const auto at = [&](double quantile) { return truth_at(made.fewest_values() - 1, quantile); };
  made.seeds =
      expected([&](double quantile) { return stop_after(made.estimates, made.pilot, rule, at(quantile)); });
  constexpr int futures = 100;
  for (int future = 0; future < futures; ++future) {
    const Truth truth = at((future + 0.5) / futures);
    const int seeds = stop_after(made.estimates, made.pilot, rule, truth);
    if (!rule.is_met(expected_at(made.estimates, made.pilot, seeds, truth))) made.capped += 1.0 / futures;
  }
  return made;
}

std::string obstacle_text(const Prediction& prediction) {
  switch (prediction.obstacle) {
    case Obstacle::none:
      break;
    case Obstacle::too_few:
      return "fewer than two seeds have ended";
    case Obstacle::lost:
      return fmt::format("{} of {} seeds are lost", prediction.lost, prediction.pilot);
    case Obstacle::no_spread:
      return fmt::format("the values of {} seeds are equal", prediction.fewest_values());
    case Obstacle::near_zero:
      return fmt::format("the mean of {} seeds may be zero", prediction.fewest_values());
  }
  return "";
}

int expected_seeds(const std::vector<StopTest>& stop_tests, const Target& target, int minimum, int maximum) {
  if (stop_tests.empty()) return minimum;
  StopRule rule(target, minimum, maximum);
  const std::vector<Estimate> known = estimates_of(stop_tests.back(), target);
  if (least_count(known) < 2 || !rule.has_measure(known)) return maximum;
  return stop_after(known, stop_tests.back().seeds, rule);
}

Cost::Cost(std::vector<double> seconds) : seconds_(std::move(seconds)) {
  std::sort(seconds_.begin(), seconds_.end());
  for (const double one : seconds_) {
    sum_ += one;
    squares_ += one * one;
  }
}

void Cost::add(double seconds) {
  seconds_.insert(std::upper_bound(seconds_.begin(), seconds_.end(), seconds), seconds);
  sum_ += seconds;
  squares_ += seconds * seconds;
}

double mean_cost(const Cost& ended, const std::vector<Unfinished>& running) {
  return spread(ended, running).mean;
}

std::string to_string(const TimeToGo& to_go) {
  if (!(to_go.likely >= 0.5)) return "";
  return fmt::format("{} to go ({} to {})", duration_text(to_go.likely), duration_text(to_go.lower),
                     duration_text(to_go.upper));
}

Json to_json(const std::optional<TimeToGo>& to_go) {
  if (!to_go) return nullptr;
  return {{"likely", to_go->likely}, {"low", to_go->lower}, {"high", to_go->upper}};
}

std::vector<Expected<int>> expected_stops(const std::vector<PointForecast>& points, const Target& target,
                                          int minimum, int maximum, const std::vector<Curve>& curves) {
  std::vector<Expected<int>> stops(points.size());
  if (curves.empty()) {
    StopRule rule(target, minimum, maximum);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].decided) stops[i] = seeds_of(points[i], rule);
    }
    return stops;
  }
  std::vector<SeedsSoFar> so_far;
  so_far.reserve(points.size());
  for (const PointForecast& point : points) {
    so_far.push_back(
        {point.all_seeds, point.ended, point.cost.count() > 0 ? point.cost.mean() : 0, point.decided});
  }
  for (const Curve& curve : curves) {
    const CurveForecast forecast(curve, so_far, target, minimum, maximum);
    const std::vector<int> likely = forecast.stops();
    const std::vector<int> fewer = forecast.stops([](int values) { return truth_at(values - 1, outside); });
    const std::vector<int> more =
        forecast.stops([](int values) { return truth_at(values - 1, 1 - outside); });
    for (std::size_t k = 0; k < likely.size(); ++k) {
      const auto [lower, upper] = std::minmax({likely[k], fewer[k], more[k]});
      stops[curve.points[k]] = {likely[k], lower, upper};
    }
  }
  return stops;
}

std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers, const std::vector<Curve>& curves) {
  return time_to_go(points, expected_stops(points, target, minimum, maximum, curves), minimum, maximum,
                    workers, !curves.empty());
}

std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points,
                                   const std::vector<Expected<int>>& stops, int minimum, int maximum,
                                   int workers, bool are_joint) {
  const auto has_cost = [](const PointForecast& point) { return point.cost.count() > 0; };
  if (std::none_of(points.begin(), points.end(), has_cost)) return std::nullopt;

  const Spread of_all = spread(points);
  const std::vector<int> schedule = stop_test_schedule(minimum, maximum);
  TimeToGo chains, work;
  double above = 0, below = 0;                   // squared deviations of the work, upwards and downwards
  double more_together = 0, fewer_together = 0;  // of points of curves, which deviate together
  bool any = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointForecast& point = points[i];
    if (point.decided) continue;
    any = true;
    const Spread cost = spread(point, of_all);
    const Expected<int>& seeds = stops[i];
    // Running seeds are half done on average. A point of a curve may need none, and wait for others.
    const double least = are_joint && point.running == 0 ? 0 : 0.5;
    const auto to_come = [&](int stop) { return std::max(least, stop - point.ended - 0.5 * point.running); };
    const double left = to_come(seeds.likely);
    work.likely += left * cost.mean;
    const double scatter = 4 * (left * cost.deviation * cost.deviation + std::pow(left * cost.error, 2));
    const double more = (to_come(seeds.upper) - left) * cost.mean;
    const double fewer = (left - to_come(seeds.lower)) * cost.mean;
    above += scatter;
    below += scatter;
    if (are_joint) {
      more_together += more;
      fewer_together += fewer;
    } else {
      above += more * more;
      below += fewer * fewer;
    }
    // If seeds run, the share `done` of the first round is over.
    const auto chain = [&](int stop, double done) {
      return rounds_until(point.ended, stop, schedule, workers) - (point.running > 0 ? done : 0);
    };
    chains.likely = std::max(chains.likely, chain(seeds.likely, 0.5) * cost.mean);
    chains.lower =
        std::max(chains.lower, chain(seeds.lower, 0.9) * std::max(0.0, cost.mean - 2 * cost.error));
    chains.upper =
        std::max(chains.upper, chain(seeds.upper, 0) * (cost.mean + 2 * cost.error) + 2 * cost.deviation);
  }
  if (!any) return TimeToGo{};
  above += more_together * more_together;
  below += fewer_together * fewer_together;
  work.lower = std::max(0.0, work.likely - std::sqrt(below));
  work.upper = work.likely + std::sqrt(above);
  return TimeToGo{std::max(work.likely / workers, chains.likely),
                  std::max(work.lower / workers, std::min(chains.lower, chains.likely)) / machine_allowance,
                  std::max(work.upper / workers, chains.upper) * machine_allowance};
}

}  // namespace peclet::runner
