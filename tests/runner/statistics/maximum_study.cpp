// maximum_study [REPLICATIONS]: how reliable each verdict is, as a CSV table.
//
// Each row simulates REPLICATIONS points by the stop rule of `peclet run`. It has the frequency of each
// verdict, and how often its interval holds the mean. "Early" points have converged without the mark
// near-maximum.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "runner/statistics/cohorts.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

struct Population {
  std::string name;
  double mean = 1;
  std::function<Outcome(std::mt19937_64&)> draw;
};

struct Case {
  Population population;
  int minimum = 8, maximum = 20;
  Tolerance tolerance;
};

Outcome outcome_of(double value, double control = 0) { return {{value, control}}; }

// Returns normal values of mean 1 that need `needed` seeds.
Population normal(double needed, double tolerance) {
  const double spread = spread_that_needs(needed, tolerance);
  return {"normal", 1, [spread](std::mt19937_64& random) {
            return outcome_of(std::normal_distribution(1.0, spread)(random));
          }};
}

// Returns normal values whose control variate removes half of the variance.
Population controlled(double needed, double tolerance) {
  const double spread = spread_that_needs(needed, tolerance);
  return {"normal with control variate", 1, [spread](std::mt19937_64& random) {
            std::normal_distribution<double> normal(0, spread);
            const double control = normal(random);
            return outcome_of(1 + normal(random) - control, control);
          }};
}

Population gamma(double needed, double tolerance) {
  const double spread = spread_that_needs(needed, tolerance);
  return {"gamma", 1, [spread](std::mt19937_64& random) { return outcome_of(gamma_of(spread)(random)); }};
}

// Returns values of coefficient of variation 1 and skewness 2.
Population exponential() {
  return {"exponential", 1, [](std::mt19937_64& random) {
            return outcome_of(std::exponential_distribution<double>(1)(random));
          }};
}

// Returns values of coefficient of variation 1 and skewness 4.
Population lognormal() {
  return {"lognormal", 1, [](std::mt19937_64& random) {
            return outcome_of(lognormal_of(std::normal_distribution<double>(0, 1)(random), 1));
          }};
}

Population share(double p) {
  return {fmt::format("share {:g}", p), p, [p](std::mt19937_64& random) {
            Outcome outcome = outcome_of(std::bernoulli_distribution(p)(random) ? 1 : 0);
            outcome.is_share = true;
            return outcome;
          }};
}

// Returns rates of spread 10 % that are 0 in jammed packings.
Population jamming(double jams) {
  return {fmt::format("jams {:g}", jams), 1 - jams, [jams](std::mt19937_64& random) {
            const bool jammed = std::bernoulli_distribution(jams)(random);
            return outcome_of(jammed ? 0 : std::normal_distribution(1.0, 0.1)(random));
          }};
}

struct Tally {
  int count = 0, covered = 0;
  void add(const StopTest& stop_test, double mean) {
    ++count;
    covered += std::abs(stop_test.controlled.mean - mean) <= stop_test.controlled_half_width ? 1 : 0;
  }
  std::string text(int of) const {
    return fmt::format("{:.2f},{}", 100.0 * count / of,
                       count == 0 ? "" : fmt::format("{:.1f}", 100.0 * covered / count));
  }
};

void print_row(const Case& about, int replications, unsigned start) {
  const Target target{"x", about.tolerance, 0.95};
  const double mean = about.population.mean;
  std::mt19937_64 random(start);
  Tally all, early, near_maximum, capped;
  double seeds = 0;
  for (int replication = 0; replication < replications; ++replication) {
    std::vector<std::optional<Outcome>> outcomes(static_cast<std::size_t>(about.maximum));
    for (std::optional<Outcome>& outcome : outcomes) outcome = about.population.draw(random);
    const StopTest stop_test = replay_stop_tests(outcomes, target, about.minimum, about.maximum).back();
    all.add(stop_test, mean);
    (stop_test.verdict == Verdict::capped ? capped
     : stop_test.near_maximum             ? near_maximum
                                          : early)
        .add(stop_test, mean);
    seeds += stop_test.seeds;
  }
  fmt::print("{},{},{},{},{},{},{},{},{},{:.1f}\n", about.population.name, about.minimum, about.maximum,
             to_string(about.tolerance), replications, early.text(replications),
             near_maximum.text(replications), capped.text(replications), 100.0 * all.covered / replications,
             seeds / replications);
}

std::vector<Case> cases() {
  constexpr double tolerance = 0.05;
  std::vector<Case> all;
  for (const auto& [minimum, maximum] : {std::pair(8, 8), {8, 20}, {20, 20}, {8, 50}, {8, 100}, {8, 800}}) {
    for (const double ratio : {0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 3.0}) {
      Population population = normal(ratio * maximum, tolerance);
      population.name += fmt::format(" needing {:g}", ratio * maximum);
      all.push_back({population, minimum, maximum, tolerance});
    }
  }
  for (const auto& make : {controlled, gamma}) {
    for (const double ratio : {0.2, 0.5, 1.0}) {
      Population population = make(ratio * 100, tolerance);
      population.name += fmt::format(" needing {:g}", ratio * 100);
      all.push_back({population, 8, 100, tolerance});
    }
  }
  for (const Population& population : {exponential(), lognormal()}) {
    for (const double wide : {0.1, 0.2, 0.3}) {
      for (const int maximum : {100, 1000}) all.push_back({population, 8, maximum, wide});
    }
  }
  for (const double p : {0.5, 0.9, 0.95, 0.99}) {
    for (const auto& [minimum, maximum] : {std::pair(8, 60), {8, 400}, {20, 20}})
      all.push_back({share(p), minimum, maximum, Tolerance::absolute(0.1)});
  }
  for (const double jams : {0.05, 0.12}) {
    for (const auto& [minimum, maximum] : {std::pair(10, 100), {20, 100}, {60, 100}})
      all.push_back({jamming(jams), minimum, maximum, 0.1});
  }
  return all;
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int replications = argc > 1 ? std::atoi(argv[1]) : 10'000;
  if (replications < 1) {
    fmt::print(stderr, "maximum_study [REPLICATIONS]: an integer from 1 on\n");
    return 2;
  }
  fmt::print(
      "population,minimum,maximum,tolerance,replications,early_percent,early_covered_percent,"
      "near_maximum_percent,near_maximum_covered_percent,capped_percent,capped_covered_percent,"
      "covered_percent,seeds\n");
  unsigned row = 0;
  for (const Case& about : cases()) print_row(about, replications, ++row);
  return 0;
}
