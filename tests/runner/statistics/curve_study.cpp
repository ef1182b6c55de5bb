// curve_study [CAMPAIGNS]: what a curve saves, and how often its band holds the truth, as a CSV table.
//
// Each row simulates CAMPAIGNS curves of ten points, or eleven with one at rest, with the scheduler of
// `peclet run`. The same random numbers then decide each point alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runner/statistics/forecast.h"
#include "runner/statistics/scheduler.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

constexpr double tolerance = 0.05;
constexpr int minimum = 8, maximum = 800;

// A curve of which everything is known: the mean, the spread of a realisation over it, and its steps.
struct Truth {
  std::string name, noise;
  std::vector<double> axis, mean, spread, steps;
  bool is_skewed = false;  // lognormal values
};

const std::vector<double> ten_decades{0.01, 0.046, 0.22, 1, 4.6, 22, 100, 460, 2200, 1e4};

// Returns a curve whose points all have the same spread.
Truth even(const std::string& name, double spread, const std::function<double(std::size_t)>& mean) {
  Truth truth{name, fmt::format("{:g} %", 100 * spread), ten_decades, {}, {}, {}};
  for (std::size_t i = 0; i < ten_decades.size(); ++i) truth.mean.push_back(mean(i));
  truth.spread.assign(ten_decades.size(), spread);
  truth.steps.assign(ten_decades.size(), 1);
  return truth;
}

std::vector<Truth> truths() {
  std::vector<Truth> all;
  // Means, spreads and steps of results/flow-curve, N = 250.
  const std::vector<double> steps{500, 300, 160, 60, 50, 50, 50, 50, 50, 50};
  all.push_back({"flow curve, 0.45",
                 "measured",
                 ten_decades,
                 {7.3, 7.2, 6.51, 5.43, 5.0, 6.19, 7.35, 8.08, 8.44, 8.54},
                 {0.58, 0.19, 0.10, 0.035, 0.041, 0.055, 0.038, 0.041, 0.034, 0.031},
                 steps});
  all.push_back({"flow curve, 0.50",
                 "measured",
                 ten_decades,
                 {16, 15.1, 12.1, 8.76, 8.15, 9.9, 11.9, 12.9, 13.5, 13.7},
                 {0.49, 0.148, 0.083, 0.037, 0.048, 0.061, 0.04, 0.035, 0.042, 0.044},
                 steps});
  all.push_back({"flow curve, 0.55",
                 "measured",
                 ten_decades,
                 {73, 48, 26.5, 17.8, 17.1, 19.2, 22.3, 23.9, 24.3, 24.4},
                 {0.28, 0.115, 0.062, 0.042, 0.064, 0.061, 0.063, 0.07, 0.06, 0.056},
                 steps});
  // Curves with a point at rest, as results/at-rest has it. At 0.55 the viscosity falls below the lowest
  // rate.
  const std::vector<double> at_rest{7.3, 16, 113}, spread_at_rest{0.13, 0.39, 0.5};
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    Truth truth = all[i];
    truth.name += ", from rest";
    truth.axis.insert(truth.axis.begin(), 0);
    truth.mean.insert(truth.mean.begin(), at_rest[i]);
    truth.spread.insert(truth.spread.begin(), spread_at_rest[i]);
    truth.steps.insert(truth.steps.begin(), 400);
    all.push_back(truth);
  }
  for (const double spread : {0.05, 0.15, 0.3}) {
    all.push_back(even("constant", spread, [](std::size_t) { return 5; }));
    all.push_back(even("power law", spread, [](std::size_t i) { return 5 * std::sqrt(ten_decades[i]); }));
    all.push_back(even("kink", spread, [](std::size_t i) {
      return 5 * std::exp(0.1 * std::max(0.0, std::log(ten_decades[i] / 4.6)));
    }));
    all.push_back(even("jump by 1.6", spread, [](std::size_t i) { return i < 5 ? 5 : 8; }));
    all.push_back(even("jump by 10", spread, [](std::size_t i) { return i < 5 ? 5 : 50; }));
    all.push_back(even("one point 20 % low", spread, [](std::size_t i) { return i == 5 ? 4 : 5; }));
    all.push_back(even("one point 6 % low", spread, [](std::size_t i) { return i == 5 ? 4.7 : 5; }));
    Truth skewed =
        even("power law", spread, [](std::size_t i) { return 5 * std::pow(ten_decades[i], -0.2); });
    skewed.is_skewed = true;
    skewed.noise += ", lognormal";
    all.push_back(skewed);
  }
  return all;
}

class Source {
 public:
  Source(const Truth& truth, unsigned start) : truth_(truth) {
    for (std::size_t i = 0; i < truth.axis.size(); ++i) random_.emplace_back(start * 1000 + i);
    values_.resize(truth.axis.size());
  }
  // Returns the same value for the same seed.
  Outcome outcome(SeedId id) {
    const auto point = static_cast<std::size_t>(id.point);
    std::vector<double>& values = values_[point];
    const double spread = truth_.spread[point];
    while (values.size() <= static_cast<std::size_t>(id.seed)) {
      const double z = std::normal_distribution<double>()(random_[point]);
      values.push_back(truth_.mean[point] * (truth_.is_skewed ? lognormal_of(z, spread) : 1 + spread * z));
    }
    Outcome outcome{{values[static_cast<std::size_t>(id.seed)]}};
    outcome.steps = truth_.steps[point];
    return outcome;
  }

 private:
  const Truth& truth_;
  std::vector<std::mt19937_64> random_;
  std::vector<std::vector<double>> values_;
};

// A campaign that has ended, and how many steps it was expected to take after its first stop tests.
struct Ended {
  Scheduler scheduler;
  std::optional<TimeToGo> to_go{};
  double steps_to_go = 0;  // taken
};

// Returns the steps to go as `status` forecasts the time, for one worker that makes a step in a second.
std::optional<TimeToGo> steps_to_go(const Scheduler& scheduler, const Truth& truth, const Target& target,
                                    const std::vector<Curve>& curves) {
  std::vector<PointForecast> points;
  for (int i = 0; i < scheduler.points(); ++i) {
    const int ended = scheduler.all_ended(i);
    const double steps = truth.steps[static_cast<std::size_t>(i)];
    points.push_back({Cost(std::vector<double>(static_cast<std::size_t>(ended), steps)),
                      scheduler.all_seeds(i), ended, 0, scheduler.decided(i)});
  }
  return time_to_go(points, target, minimum, maximum, 1, curves);
}

Ended campaign(const Truth& truth, unsigned start, bool is_curve) {
  Target target{"relative_viscosity", tolerance, 0.95};
  Curve curve;
  for (std::size_t i = 0; i < truth.axis.size(); ++i) curve.points.push_back(i);
  curve.axis = truth.axis;
  if (is_curve) target.tolerance.over = "/peclet";
  target.tolerance.is_even = is_curve && truth.axis.front() == 0;
  const std::vector<Curve> curves = is_curve ? std::vector{curve} : std::vector<Curve>{};
  Ended ended{{std::vector<std::vector<std::optional<Outcome>>>(truth.axis.size()), target, minimum, maximum,
               curves}};
  Scheduler& scheduler = ended.scheduler;
  Source source(truth, start);
  std::size_t first = minimum * truth.axis.size();  // seeds of the first stop tests
  while (const std::optional<SeedId> next = scheduler.next()) {
    if (first-- == 0) ended.to_go = steps_to_go(scheduler, truth, target, curves);
    if (ended.to_go) ended.steps_to_go += truth.steps[static_cast<std::size_t>(next->point)];
    scheduler.begin(*next);
    scheduler.end(*next, source.outcome(*next));
  }
  return ended;
}

// Points with a band, and how many of these bands hold the truth.
struct Bands {
  int count = 0, hold = 0;
  void add(bool holds) {
    ++count;
    hold += holds ? 1 : 0;
  }
  std::string percent() const { return count == 0 ? "" : fmt::format("{:.1f}", 100.0 * hold / count); }
};

struct Tally {
  double steps_alone = 0, steps = 0;
  int points = 0, refused = 0;
  Bands own, all, deciding;
  Bands forecasts{};               // of the steps to go
  std::vector<double> forecast{};  // over the steps that were taken
  std::vector<Bands> at{};         // each point
};

// Returns the steps of the seeds that count. A point at rest is not part of a campaign without a curve.
double steps_of(const Scheduler& scheduler, const Truth& truth, bool with_rest) {
  double steps = 0;
  for (std::size_t i = 0; i < truth.axis.size(); ++i) {
    if (with_rest || truth.axis[i] > 0) steps += scheduler.wanted(static_cast<int>(i)) * truth.steps[i];
  }
  return steps;
}

void add(const Truth& truth, unsigned start, Tally& tally) {
  tally.steps_alone += steps_of(campaign(truth, start, false).scheduler, truth, false);
  const auto [joint, to_go, steps_to_go] = campaign(truth, start, true);
  if (to_go) {
    tally.forecasts.add(to_go->lower <= steps_to_go && steps_to_go <= to_go->upper);
    tally.forecast.push_back(to_go->likely / steps_to_go);
  }
  tally.steps += steps_of(joint, truth, true);
  for (std::size_t i = 0; i < truth.axis.size(); ++i) {
    const ObservableStopTest& one = joint.stop_tests(static_cast<int>(i)).back().each.front();
    ++tally.points;
    tally.own.add(std::abs(one.estimate.mean - truth.mean[i]) <= one.half_width);
    tally.refused += one.curve->refused ? 1 : 0;
    if (!one.curve->is_known() || one.curve->refused) continue;
    const bool holds = one.curve->low <= truth.mean[i] && truth.mean[i] <= one.curve->high;
    tally.all.add(holds);
    tally.at[i].add(holds);
    if (one.is_decided_by_curve()) tally.deciding.add(holds);
  }
}

// Returns the median and how often the ranges hold, or nothing of few forecasts: most campaigns had none.
std::string forecast_text(Tally& tally) {
  constexpr std::size_t fewest = 20;
  if (tally.forecast.size() < fewest) return ",";
  const auto middle = tally.forecast.begin() + std::ssize(tally.forecast) / 2;
  std::ranges::nth_element(tally.forecast, middle);
  return fmt::format("{:.2f},{}", *middle, tally.forecasts.percent());
}

void study(int campaigns) {
  fmt::print(
      "curve,spread,campaigns,times fewer steps,decided by the curve %,bands hold %,where the curve decides "
      "%,at the worst point %,own intervals hold %,refused %,steps to go: forecast over taken,range holds "
      "%\n");
  for (const Truth& truth : truths()) {
    Tally tally;
    tally.at.resize(truth.axis.size());
    for (int start = 0; start < campaigns; ++start) add(truth, static_cast<unsigned>(start), tally);
    std::erase_if(tally.at, [](const Bands& point) { return point.count == 0; });
    const Bands& worst = *std::ranges::min_element(tally.at, [](const Bands& one, const Bands& other) {
      return one.hold * other.count < other.hold * one.count;
    });
    fmt::print("\"{}\",\"{}\",{},{:.2f},{:.1f},{},{},{},{},{:.1f},{}\n", truth.name, truth.noise, campaigns,
               tally.steps_alone / tally.steps, 100.0 * tally.deciding.count / tally.points,
               tally.all.percent(), tally.deciding.percent(), worst.percent(), tally.own.percent(),
               100.0 * tally.refused / tally.points, forecast_text(tally));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace peclet::runner

int main(int count, char** words) {
  const int campaigns = count > 1 ? std::atoi(words[1]) : 1000;
  peclet::runner::study(campaigns);
}
