// coverage_study [REPLICATIONS [FIRST_ROW]]: how often the intervals at which campaigns stop hold the true
// mean, as a CSV table.
//
// Each row simulates REPLICATIONS points with the scheduler and the stop rule of `peclet run`, three points
// at a time; the run times follow the population. Beside it stands the naive rule of most scripts: test all
// ended seeds whenever one ends, and stop as soon as Student's interval is narrow enough.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "runner/statistics/scheduler.h"
#include "runner/statistics/statistics.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

constexpr double confidence = 0.95;
constexpr int points_at_a_time = 3;

enum class Shape { normal, lognormal, gamma };

// A population of values of mean 1, and of run times.
struct Population {
  std::string name;
  Shape shape = Shape::normal;
  bool slow_when_large = false;  // logarithm of the run time correlates with the value by 0.8
};

struct Case {
  Population population;
  int minimum = 8;
  double tolerance = 0.05;
  double needed = 20;  // seeds at which the true spread would just meet the tolerance
  int workers = 1;
  bool plain = false;  // every interval at the level of the confidence, without adjustment
};

struct Realisation {
  double value = 0, run_time = 0;
};

class Source {
 public:
  Source(const Case& about, unsigned start)
      : random_(start),
        population_(about.population),
        spread_(spread_that_needs(about.needed, about.tolerance)),
        gamma_(gamma_of(spread_)) {}

  Realisation draw() {
    const double z = normal_(random_);
    const double value = population_.shape == Shape::lognormal ? lognormal_of(z, spread_)
                         : population_.shape == Shape::gamma   ? gamma_(random_)
                                                               : 1 + spread_ * z;
    const double own = normal_(random_);
    // The logarithm of the run time has the standard deviation 0.5.
    return {value, std::exp(0.5 * (population_.slow_when_large ? 0.8 * z + 0.6 * own : own))};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Population population_;
  double spread_;
  std::gamma_distribution<double> gamma_;
};

struct Tally {
  int count = 0, covered = 0, converged = 0, skewed = 0;
  double bias = 0, seeds = 0, stop_tests = 0;

  void add(const Estimate& mean, double half_width) {
    ++count;
    if (std::abs(mean.mean - 1) <= half_width) ++covered;
    bias += (mean.mean - 1) / mean.standard_error;
    seeds += mean.count;
  }
};

// A realisation on a simulated clock, so that realisations end in the order of their run times.
struct Running {
  double end = 0;
  SeedId id;
  double value = 0;
  friend bool operator>(const Running& a, const Running& b) { return a.end > b.end; }
};
using Clock = std::priority_queue<Running, std::vector<Running>, std::greater<>>;

// Returns a maximum that is far away; maximum_study is about near ones.
int most_seeds(const Case& about) {
  return static_cast<int>(20 * std::max(about.needed, 1.0 * about.minimum));
}

void simulate_campaign(const Case& about, Source& source, Tally& tally) {
  // adjusted_confidence() then returns the confidence itself.
  const double asked = about.plain ? 1 - (1 - confidence) / (1 - 1.4 / about.minimum) : confidence;
  const Target target{"relative_viscosity", about.tolerance, asked};
  Scheduler scheduler(std::vector<std::vector<std::optional<Outcome>>>(points_at_a_time), target,
                      about.minimum, most_seeds(about));
  Clock clock;
  double now = 0;
  while (!scheduler.finished()) {
    while (static_cast<int>(clock.size()) < about.workers) {
      const std::optional<SeedId> next = scheduler.next();
      if (!next) break;
      scheduler.begin(*next);
      const Realisation drawn = source.draw();
      clock.push({now + drawn.run_time, *next, drawn.value});
    }
    const Running ended = clock.top();
    clock.pop();
    now = ended.end;
    scheduler.end(ended.id, {{ended.value}});
  }
  for (int point = 0; point < points_at_a_time; ++point) {
    const StopTest& last = scheduler.stop_tests(point).back();
    tally.add(last.controlled, last.controlled_half_width);
    tally.stop_tests += static_cast<double>(scheduler.stop_tests(point).size());
    if (last.verdict == Verdict::converged) ++tally.converged;
    if (is_skewed(last, confidence)) ++tally.skewed;
  }
}

// Tests all ended seeds whenever one ends, with Student's interval at the confidence.
void simulate_naive(const Case& about, Source& source, Tally& tally) {
  Clock clock;
  std::vector<double> values;
  double now = 0;
  for (;;) {
    while (static_cast<int>(clock.size()) < about.workers) {
      const Realisation drawn = source.draw();
      clock.push({now + drawn.run_time, {}, drawn.value});
    }
    now = clock.top().end;
    values.push_back(clock.top().value);
    clock.pop();
    if (static_cast<int>(values.size()) < about.minimum) continue;
    const Estimate mean = estimate(values);
    const double half_width = student_half_width(mean, confidence);
    if (half_width <= about.tolerance * std::abs(mean.mean) ||
        static_cast<int>(values.size()) == most_seeds(about)) {
      tally.add(mean, half_width);
      return;
    }
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Population normal{"normal"}, slow{"slow-when-large", Shape::normal, true},
      lognormal{"lognormal", Shape::lognormal},
      slow_lognormal{"slow-when-large lognormal", Shape::lognormal, true};
  for (const int minimum : {8, 10, 20, 40}) {
    for (const double ratio : {0.1, 0.5, 1.0, 1.5, 2.0, 4.0, 10.0, 20.0}) {
      all.push_back({normal, minimum, 0.05, ratio * minimum, 1});
    }
  }
  for (const int workers : {1, 4, 16, 64}) {
    for (const double needed : {10.0, 40.0, 160.0}) all.push_back({slow, 10, 0.05, needed, workers});
  }
  // Coefficient of variation 1.
  for (const double tolerance : {0.1, 0.15, 0.2, 0.3}) {
    for (const int minimum : {8, 20}) {
      all.push_back({lognormal, minimum, tolerance, values_that_need(1, tolerance), 1});
    }
  }
  for (const int workers : {4, 64})
    all.push_back({slow_lognormal, 10, 0.1, values_that_need(1, 0.1), workers});
  const Population plain{"normal plain"};
  for (const int minimum : {5, 8, 10}) {
    for (const double ratio : {0.1, 0.5, 1.0, 1.5, 2.0, 4.0, 10.0, 20.0}) {
      all.push_back({plain, minimum, 0.05, ratio * minimum, 1, true});
    }
  }
  // Means of squares, as zero_shear_viscosity: the coefficients of variation of its seeds (results/at-rest).
  const Population squares{"gamma", Shape::gamma};
  for (const double tolerance : {0.05, 0.1}) {
    for (const double variation : {0.06, 0.1, 0.15, 0.2, 0.3, 0.4}) {
      all.push_back({squares, 8, tolerance, values_that_need(variation, tolerance), 1});
    }
  }
  return all;
}

void print_row(const Case& about, const Tally& rule, const Tally& naive) {
  const auto share = [](int part, int whole) { return 100.0 * part / whole; };
  const double covered = share(rule.covered, rule.count);
  fmt::print("{},{},{:g},{:.4g},{},{},{:.2f},{:.2f},{:.3f},{:.1f},{:.1f},{:.1f},{:.1f},{:.2f},{:.3f}\n",
             about.population.name, about.minimum, about.tolerance, about.needed, about.workers, rule.count,
             covered, std::sqrt(covered * (100 - covered) / rule.count), rule.bias / rule.count,
             rule.seeds / rule.count, rule.stop_tests / rule.count, share(rule.converged, rule.count),
             share(rule.skewed, rule.count), share(naive.covered, naive.count), naive.bias / naive.count);
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int replications = argc > 1 ? std::atoi(argv[1]) : 21'000;
  const int first = argc > 2 ? std::atoi(argv[2]) : 0;
  if (replications < 1 || first < 0) {
    fmt::print(stderr, "coverage_study [REPLICATIONS [FIRST_ROW]]: integers, from 1 and from 0\n");
    return 2;
  }
  fmt::print(
      "population,minimum,tolerance,needed_seeds,workers,replications,covered_percent,covered_percent_error,"
      "bias_standard_errors,seeds,stop_tests,converged_percent,skewed_percent,naive_covered_percent,"
      "naive_bias_standard_errors\n");
  const std::vector<Case> all = cases();
  for (std::size_t row = static_cast<std::size_t>(first); row < all.size(); ++row) {
    const Case& about = all[row];
    const auto start = static_cast<unsigned>(1 + 2 * row);
    Source source(about, start), naive_source(about, start + 1);
    Tally rule, naive;
    while (rule.count < replications) simulate_campaign(about, source, rule);
    while (naive.count < replications) simulate_naive(about, naive_source, naive);
    print_row(about, rule, naive);
  }
  return 0;
}
