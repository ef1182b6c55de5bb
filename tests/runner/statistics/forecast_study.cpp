// forecast_study [CAMPAIGNS]: how often the forecast of the time to go holds the true one, as a CSV table.
//
// The scheduler runs campaigns of twelve points to 3 % on a machine whose speed wanders between 1 and 1/2.
// Their coefficients of variation are log-uniform between 0.05 and 0.3, and their costs differ by a factor of
// up to 100. Forecasts are evaluated at given shares of the total time of each campaign.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "runner/statistics/forecast.h"
#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

constexpr int points = 12, minimum = 8, maximum = 4000;
const Target three_percent{"relative_viscosity", 0.03, 0.95};

// A machine whose speed wanders. The logarithm of the speed oscillates between 0 and -log 2, as the sum of
// three waves with random phases. Their periods lie between a tenth of a campaign's time and twice that time.
class Machine {
 public:
  Machine(bool wanders, double time, std::mt19937_64& random) : wanders_(wanders) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (Wave& wave : waves_) {
      wave = {0.1 * time * std::pow(20, uniform(random)), 2 * std::numbers::pi * uniform(random)};
    }
  }
  double slowness(double now) const {
    if (!wanders_) return 1;
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(2 * std::numbers::pi * now / wave.period + wave.phase);
    return std::pow(2, std::clamp(0.5 + sum / 3, 0.0, 1.0));
  }

 private:
  struct Wave {
    double period = 1, phase = 0;
  };
  bool wanders_;
  Wave waves_[3];
};

struct Case {
  int workers = 2;
  bool wanders = true;
};

struct Told {
  double at = 0;
  std::optional<TimeToGo> to_go;
};

struct Running {
  double end = 0, took = 0;
  SeedId id;
  double value = 0;
  friend bool operator>(const Running& a, const Running& b) { return a.end > b.end; }
};

// The forecasts of a campaign, about two hundred, and the time at which it ended.
struct History {
  std::vector<Told> told;
  double end = 0;
};

History run(const Case& about, double expected_time, unsigned start) {
  std::mt19937_64 random(start);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const Machine machine(about.wanders, expected_time, random);
  std::vector<double> spread(points), seconds(points);
  for (double& of : spread) of = 0.05 * std::pow(6, uniform(random));
  for (double& of : seconds) of = std::pow(100, uniform(random));

  Scheduler scheduler(std::vector<std::vector<std::optional<Outcome>>>(points), three_percent, minimum,
                      maximum);
  std::vector<Cost> costs(points);
  std::vector<Running> clock;  // a heap, with the first seed to end on top
  History history;
  double now = 0, ask_at = 0;
  while (!scheduler.finished()) {
    while (static_cast<int>(clock.size()) < about.workers) {
      const std::optional<SeedId> next = scheduler.next();
      if (!next) break;
      scheduler.begin(*next);
      const auto point = static_cast<std::size_t>(next->point);
      // Run times scatter by 20 %.
      const double took = seconds[point] * std::exp(0.2 * normal(random)) * machine.slowness(now);
      clock.push_back({now + took, took, *next, 1 + spread[point] * normal(random)});
      std::push_heap(clock.begin(), clock.end(), std::greater<>());
    }
    std::pop_heap(clock.begin(), clock.end(), std::greater<>());
    const Running ended = clock.back();
    clock.pop_back();
    now = ended.end;
    scheduler.end(ended.id, {{ended.value}});
    const auto place = static_cast<std::size_t>(ended.id.point);
    costs[place].add(ended.took);
    scheduler.set_cost(ended.id.point, costs[place].mean());
    if (now < ask_at) continue;
    ask_at = now + expected_time / 200;
    std::vector<PointForecast> forecasts;
    for (int point = 0; point < points; ++point) {
      const int all_ended = scheduler.all_ended(point);
      forecasts.push_back({costs[static_cast<std::size_t>(point)], scheduler.all_seeds(point), all_ended,
                           scheduler.begun(point) - all_ended, scheduler.decided(point)});
    }
    for (const Running& one : clock) {
      const double taken = now - (one.end - one.took);
      const bool has_rate = taken > 0.1 * one.took;
      forecasts[static_cast<std::size_t>(one.id.point)].unfinished.push_back(
          {taken, has_rate ? std::optional(one.took) : std::nullopt});
    }
    history.told.push_back({now, time_to_go(forecasts, three_percent, minimum, maximum, about.workers)});
  }
  history.end = now;
  return history;
}

struct Tally {
  int count = 0, held = 0, below = 0, above = 0;
  std::vector<double> ratios, widths;

  void add(const TimeToGo& told, double actual) {
    ++count;
    held += told.lower <= actual && actual <= told.upper ? 1 : 0;
    below += actual < told.lower ? 1 : 0;
    above += actual > told.upper ? 1 : 0;
    ratios.push_back(told.likely / actual);
    widths.push_back(told.upper / std::max(told.lower, 1e-9));
  }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

constexpr double shares[] = {0.1, 0.3, 0.5, 0.7, 0.9, 0.97};

void print_rows(const Case& about, int campaigns, unsigned start) {
  std::vector<Tally> tallies(std::size(shares));
  double expected_time = 4000.0 / about.workers;  // for the first campaign
  for (int campaign = 0; campaign < campaigns; ++campaign) {
    const History history = run(about, expected_time, start + static_cast<unsigned>(campaign));
    expected_time = history.end;
    for (std::size_t i = 0; i < std::size(shares); ++i) {
      const double asked = shares[i] * history.end;
      const auto after = std::find_if(history.told.begin(), history.told.end(),
                                      [&](const Told& told) { return told.at >= asked; });
      if (after != history.told.end() && after->to_go && after->at < history.end)
        tallies[i].add(*after->to_go, history.end - after->at);
    }
  }
  for (std::size_t i = 0; i < std::size(shares); ++i) {
    const Tally& tally = tallies[i];
    const auto percent = [&](int part) { return 100.0 * part / tally.count; };
    fmt::print("{},{},{:g},{},{:.1f},{:.1f},{:.1f},{:.2f},{:.1f}\n", about.workers, about.wanders ? 1 : 0,
               shares[i], tally.count, percent(tally.held), percent(tally.below), percent(tally.above),
               median(tally.ratios), median(tally.widths));
  }
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 400;
  if (campaigns < 1) {
    fmt::print(stderr, "forecast_study [CAMPAIGNS]: an integer from 1 on\n");
    return 2;
  }
  fmt::print(
      "workers,speed_wanders,asked_at,campaigns,held_percent,below_percent,above_percent,median_ratio,"
      "median_width\n");
  for (const int workers : {1, 2, 16}) {
    for (const bool wanders : {true, false}) print_rows({workers, wanders}, campaigns, 1000);
  }
  return 0;
}
