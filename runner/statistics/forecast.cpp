#include "runner/statistics/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "runner/text/duration_text.h"

namespace peclet::runner {
namespace {

// With fewer costs the scatter is assumed.
constexpr int fewest_costs = 3;
constexpr double unknown_scatter = 0.5;  // over the mean

struct Spread {
  double mean = 0, deviation = 0, error = 0;
};

// A cost that a seed may have, and its share; the shares of all add up to their number.
struct SharedCost {
  double seconds = 0;
  bool runs = false;
  std::optional<double> whole{};
  double share = 1;
};

std::vector<SharedCost> shared_costs(const Cost& ended, const std::vector<Unfinished>& running) {
  std::vector<SharedCost> costs;
  double longest = 0;
  for (const double seconds : ended.seconds) costs.push_back({seconds});
  for (const Unfinished& one : running) {
    costs.push_back({one.taken, true, one.whole});
    longest = std::max(longest, one.whole.value_or(0));
  }
  std::sort(costs.begin(), costs.end(), [](const SharedCost& one, const SharedCost& other) {
    return std::pair(one.seconds, one.runs) < std::pair(other.seconds, other.runs);
  });
  const auto last_ended =
      std::find_if(costs.rbegin(), costs.rend(), [](const auto& one) { return !one.runs; });
  double handed_on = 0;  // to each of those that follow
  auto later = static_cast<double>(costs.size());
  for (auto one = costs.begin(); one != costs.end(); ++one) {
    later -= 1;
    one->share += handed_on;
    if (!one->runs) continue;
    if (one < last_ended.base()) {
      handed_on += one->share / later;
      one->share = 0;
    } else {
      one->seconds = std::max(one->seconds, one->whole.value_or(longest));
    }
  }
  return costs;
}

Spread spread(const Cost& ended, const std::vector<Unfinished>& running) {
  const std::vector<SharedCost> costs = shared_costs(ended, running);
  const auto count = static_cast<double>(costs.size());
  double sum = 0, squares_of_shares = 0, squares = 0;
  for (const SharedCost& one : costs) {
    sum += one.share * one.seconds;
    squares_of_shares += one.share * one.share / (count * count);
  }
  const double mean = sum / count;
  for (const SharedCost& one : costs) squares += one.share * std::pow(one.seconds - mean, 2) / count;
  const double known = 1 / squares_of_shares;  // costs of equal shares that would say as much
  const double deviation = std::lround(known) < fewest_costs ? unknown_scatter * mean
                                                             : std::sqrt(squares / (1 - squares_of_shares));
  return {mean, deviation, deviation / std::sqrt(known)};
}

// A point of which nothing has ended is taken to cost what its running seeds are expected to, or else what
// the others do: `of_all`, unless seeds that run have lasted longer.
Spread spread(const PointForecast& point, const Cost& all, const Spread& of_all) {
  const auto is_known = [](const Unfinished& one) { return one.whole.has_value(); };
  const bool has_own =
      point.cost.count() > 0 || std::any_of(point.unfinished.begin(), point.unfinished.end(), is_known);
  if (!has_own && point.unfinished.empty()) return of_all;
  return spread(has_own ? point.cost : all, point.unfinished);
}

struct SeedRange {
  int likely = 0, low = 0, high = 0;
};

// What may be expected of so many seeds: Student's factor and the standard error both fall with them.
std::vector<Estimate> expected_at(const PointForecast& point, int seeds, double factor) {
  std::vector<Estimate> expected;
  expected.reserve(point.so_far.size());
  for (const Estimate& known : point.so_far) {
    const double growth = static_cast<double>(seeds) / point.ended;
    const auto values = static_cast<int>(std::lround(known.count * growth));
    const double share = static_cast<double>(values) / known.count;
    expected.push_back({values, known.mean, known.standard_error * std::sqrt(factor / share), known.values});
  }
  return expected;
}

// The first look that decides, of those that take more seeds than have ended, if the variance is `factor`
// times the sample's.
int stop_of(const PointForecast& point, StopRule& rule, double factor) {
  const std::vector<int>& schedule = rule.schedule();
  const auto stops = [&](int seeds) { return rule.stops(seeds, expected_at(point, seeds, factor)); };
  const auto later = std::upper_bound(schedule.begin(), schedule.end(), point.ended);
  const auto enough = std::find_if(later, schedule.end(), stops);
  return enough == schedule.end() ? schedule.back() : *enough;
}

SeedRange seeds_of(const PointForecast& point, StopRule& rule) {
  const int minimum = rule.schedule().front(), maximum = rule.schedule().back();
  if (point.fewest_values() < 2 || !rule.has_measure(point.so_far)) return {minimum, minimum, maximum};
  constexpr double outside = 0.1;
  const int degrees = point.fewest_values() - 1;
  return {stop_of(point, rule, 1), stop_of(point, rule, variance_excess(degrees, 1 - outside)),
          stop_of(point, rule, variance_excess(degrees, outside))};
}

// Rounds of all workers until the point has so many seeds: a look waits for all its seeds. Of the first one
// `done` is over where seeds run.
double rounds_of(const PointForecast& point, const std::vector<int>& schedule, int seeds, int workers,
                 double done) {
  double rounds = 0;
  int known = point.ended;
  for (const int look : schedule) {
    if (look <= known || look > seeds) continue;
    rounds += std::ceil(static_cast<double>(look - known) / workers);
    known = look;
  }
  return rounds - (point.running > 0 ? done : 0);
}

}  // namespace

void Cost::add(double of_one) {
  seconds.push_back(of_one);
  sum += of_one;
}

void Cost::keep_first(int count) {
  seconds.resize(static_cast<std::size_t>(count));
  sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

double mean_cost(const Cost& ended, const std::vector<Unfinished>& running) {
  return spread(ended, running).mean;
}

std::string to_string(const TimeToGo& to_go) {
  if (!(to_go.likely >= 0.5)) return "";
  return fmt::format("{} to go ({} to {})", duration_text(to_go.likely), duration_text(to_go.low),
                     duration_text(to_go.high));
}

Json to_json(const std::optional<TimeToGo>& to_go) {
  if (!to_go) return nullptr;
  return {{"likely", to_go->likely}, {"low", to_go->low}, {"high", to_go->high}};
}

int PointForecast::fewest_values() const {
  const auto has_fewer = [](const Estimate& one, const Estimate& other) { return one.count < other.count; };
  const auto fewest = std::min_element(so_far.begin(), so_far.end(), has_fewer);
  return fewest == so_far.end() ? 0 : fewest->count;
}

int expected_seeds(const std::vector<Look>& looks, const Target& target, int minimum, int maximum,
                   double factor) {
  StopRule rule(target, minimum, maximum);
  if (looks.empty()) return rule.schedule().front();
  PointForecast point;
  point.ended = looks.back().seeds;
  point.so_far = estimates_of(looks.back(), target);
  if (point.fewest_values() < 2 || !rule.has_measure(point.so_far)) return maximum;
  return stop_of(point, rule, factor);
}

std::optional<TimeToGo> time_to_go(const std::vector<PointForecast>& points, const Target& target,
                                   int minimum, int maximum, int workers) {
  Cost all;
  for (const PointForecast& point : points) {
    all.seconds.insert(all.seconds.end(), point.cost.seconds.begin(), point.cost.seconds.end());
    all.sum += point.cost.sum;
  }
  if (all.count() == 0) return std::nullopt;

  const Spread of_all = spread(all, {});
  StopRule rule(target, minimum, maximum);
  TimeToGo chains, work;
  double above = 0, below = 0;  // squares of what the work may differ by
  bool any = false;
  for (const PointForecast& point : points) {
    if (point.decided) continue;
    any = true;
    const Spread cost = spread(point, all, of_all);
    const SeedRange seeds = seeds_of(point, rule);
    // Half of what runs is done, in the mean.
    const auto to_come = [&](int stop) { return std::max(0.5, stop - point.ended - 0.5 * point.running); };
    const double left = to_come(seeds.likely);
    work.likely += left * cost.mean;
    const double scatter = 4 * (left * cost.deviation * cost.deviation + std::pow(left * cost.error, 2));
    above += scatter + std::pow((to_come(seeds.high) - left) * cost.mean, 2);
    below += scatter + std::pow((left - to_come(seeds.low)) * cost.mean, 2);
    const auto rounds = [&](int stop, double done) {
      return rounds_of(point, rule.schedule(), stop, workers, done);
    };
    chains.likely = std::max(chains.likely, rounds(seeds.likely, 0.5) * cost.mean);
    chains.low = std::max(chains.low, rounds(seeds.low, 0.9) * std::max(0.0, cost.mean - 2 * cost.error));
    chains.high =
        std::max(chains.high, rounds(seeds.high, 0) * (cost.mean + 2 * cost.error) + 2 * cost.deviation);
  }
  if (!any) return TimeToGo{};
  work.low = std::max(0.0, work.likely - std::sqrt(below));
  work.high = work.likely + std::sqrt(above);
  return TimeToGo{std::max(work.likely / workers, chains.likely),
                  std::max(work.low / workers, std::min(chains.low, chains.likely)) / machine_allowance,
                  std::max(work.high / workers, chains.high) * machine_allowance};
}

}  // namespace peclet::runner
