// maximum_study [REPLICATIONS]: what each verdict is worth where the maximum is near, as a CSV table.
//
// Every row simulates that many points of true mean 1 by the stop rule of `peclet run`: how often each
// verdict is given, and how often the interval that it comes with holds the mean. Beside it stands the first
// rule, by which every look within the tolerance had converged.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "runner/statistics/cohorts.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

constexpr double tolerance = 0.05;

enum class Population { normal, controlled, skewed };

struct Case {
  Population population = Population::normal;
  int minimum = 8, maximum = 20;
  double ratio = 1;  // of the seeds that are needed over those that are allowed
  double needed() const { return ratio * maximum; }
};

const char* name(Population population) {
  switch (population) {
    case Population::normal:
      return "normal";
    case Population::controlled:
      return "normal with control variate";
    case Population::skewed:
      return "gamma";
  }
  return "";
}

class Source {
 public:
  Source(const Case& about, unsigned start)
      : random_(start),
        population_(about.population),
        spread_(spread_that_needs(about.needed(), tolerance)),
        gamma_(gamma_of(spread_)) {}

  Outcome draw() {
    if (population_ == Population::skewed) return {Outcome::Kind::value, gamma_(random_), 0};
    // A control variate that takes half of the variance away.
    const double control = population_ == Population::controlled ? spread_ * normal_(random_) : 0;
    return {Outcome::Kind::value, 1 + spread_ * normal_(random_) - control, control};
  }

 private:
  std::mt19937_64 random_;
  Population population_;
  double spread_;
  std::normal_distribution<double> normal_;
  std::gamma_distribution<double> gamma_;
};

struct Tally {
  int count = 0, covered = 0;
  void add(const Look& look) {
    ++count;
    covered += std::abs(look.controlled.mean - 1) <= look.controlled_half_width ? 1 : 0;
  }
  std::string text(int of) const {
    return fmt::format("{:.2f},{}", 100.0 * count / of,
                       count == 0 ? "" : fmt::format("{:.1f}", 100.0 * covered / count));
  }
};

struct Tallies {
  Tally all, converged, near_maximum, capped;
  double seeds = 0;
  void add(const Look& look) {
    all.add(look);
    (look.verdict == Verdict::converged                ? converged
     : look.verdict == Verdict::converged_near_maximum ? near_maximum
                                                       : capped)
        .add(look);
    seeds += look.seeds;
  }
};

void print_row(const Case& about, int replications, unsigned start) {
  Target target{"relative_viscosity", tolerance, 0.95}, first = target;
  first.rule = Target::first_rule;
  Source source(about, start);
  Tallies now, before;
  for (int replication = 0; replication < replications; ++replication) {
    std::vector<std::optional<Outcome>> outcomes(static_cast<std::size_t>(about.maximum));
    for (std::optional<Outcome>& outcome : outcomes) outcome = source.draw();
    now.add(replay_looks(outcomes, target, about.minimum, about.maximum).back());
    before.add(replay_looks(outcomes, first, about.minimum, about.maximum).back());
  }
  fmt::print("{},{},{},{:g},{},{},{},{},{:.2f},{:.1f},{:.1f},{},{},{:.1f}\n", name(about.population),
             about.minimum, about.maximum, about.ratio, replications, now.converged.text(replications),
             now.near_maximum.text(replications), now.capped.text(replications),
             100.0 * (now.converged.count - now.converged.covered) / replications,
             100.0 * now.all.covered / replications, now.seeds / replications,
             before.converged.text(replications), before.capped.text(replications),
             before.seeds / replications);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [minimum, maximum] : {std::pair(8, 8),
                                         {8, 10},
                                         {10, 10},
                                         {8, 20},
                                         {10, 20},
                                         {20, 20},
                                         {8, 50},
                                         {10, 50},
                                         {8, 100},
                                         {8, 800}}) {
    for (const double ratio : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0, 1.25, 1.5, 2.0, 3.0}) {
      all.push_back({Population::normal, minimum, maximum, ratio});
    }
  }
  for (const Population population : {Population::controlled, Population::skewed}) {
    for (const int maximum : {20, 100}) {
      for (const double ratio : {0.2, 0.5, 0.75, 1.0, 1.5}) all.push_back({population, 8, maximum, ratio});
    }
  }
  return all;
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int replications = argc > 1 ? std::atoi(argv[1]) : 20'000;
  if (replications < 1) {
    fmt::print(stderr, "maximum_study [REPLICATIONS]: an integer from 1 on\n");
    return 2;
  }
  fmt::print(
      "population,minimum,maximum,needed_over_maximum,replications,converged_percent,converged_covered_"
      "percent,"
      "near_percent,near_covered_percent,capped_percent,capped_covered_percent,wrongly_converged_percent,"
      "covered_percent,seeds,first_rule_converged_percent,first_rule_converged_covered_percent,"
      "first_rule_capped_percent,first_rule_capped_covered_percent,first_rule_seeds\n");
  unsigned row = 0;
  for (const Case& about : cases()) print_row(about, replications, ++row);
  return 0;
}
