// prediction_study [CAMPAIGNS]: how good the predictions of `peclet plan --pilot` are, as a CSV table.
//
// Each row predicts CAMPAIGNS points of true mean 1 from their first seeds, and runs them by the stop rule
// with the same seeds and later ones. *Needed* is the number of seeds at which the true spread would just
// meet the tolerance. The last rows have the summed seeds of twelve points, whose coefficients of variation
// are log-uniform between 0.05 and 0.5.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "runner/reports/plan.h"
#include "tests/runner/population.h"

namespace peclet::runner {
namespace {

constexpr int minimum = 8;
constexpr double confidence = 0.95;

struct Case {
  bool lognormal = false;
  int pilot = 4;
  double tolerance = 0.05;
  double needed = 20;
};

// Draws values of mean 1.
class Source {
 public:
  Source(const Case& about, unsigned start)
      : random_(start),
        lognormal_(about.lognormal),
        spread_(spread_that_needs(about.needed, about.tolerance)) {}

  Outcome draw() {
    const double z = normal_(random_);
    return {{lognormal_ ? lognormal_of(z, spread_) : 1 + spread_ * z}};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  bool lognormal_;
  double spread_;
};

struct Tally {
  int count = 0, held = 0, below = 0, above = 0;
  int none = 0, decided = 0;           // points without prediction; points decided by the pilot
  std::vector<double> ratios, widths;  // expected over actual seeds; upper over lower end
};

// Returns the verdict of a point with `seeds` seeds.
Verdict verdict_at(int seeds, std::vector<std::optional<Outcome>>& outcomes, const Target& target,
                   int maximum, Source& source) {
  while (std::ssize(outcomes) < seeds) outcomes.emplace_back(source.draw());
  const std::vector<StopTest> stop_tests = replay_stop_tests(outcomes, target, minimum, maximum);
  return stop_tests.empty() ? Verdict::more : stop_tests.back().verdict;
}

int decided_after(std::vector<std::optional<Outcome>>& outcomes, const Target& target, int maximum,
                  Source& source) {
  for (const int seeds : stop_test_schedule(minimum, maximum)) {
    if (verdict_at(seeds, outcomes, target, maximum, source) != Verdict::more) return seeds;
  }
  return maximum;
}

void judge(const Expected<double>& made, int actual, Tally& tally) {
  ++tally.count;
  tally.below += actual < made.lower ? 1 : 0;
  tally.above += actual > made.upper ? 1 : 0;
  tally.held += made.lower <= actual && actual <= made.upper ? 1 : 0;
  tally.ratios.push_back(made.likely / actual);
  tally.widths.push_back(made.upper / made.lower);
}

void simulate(const Case& about, Source& source, Tally& tally) {
  const Target target{"relative_viscosity", about.tolerance, confidence};
  const int maximum = std::max(2 * minimum, static_cast<int>(50 * about.needed));
  std::vector<std::optional<Outcome>> outcomes;
  if (verdict_at(about.pilot, outcomes, target, maximum, source) != Verdict::more) {
    ++tally.decided;
    return;
  }
  const Prediction made = predict(outcomes, target, minimum, maximum);
  if (made.obstacle != Obstacle::none) {
    ++tally.none;
    return;
  }
  judge(Expected<double>{static_cast<double>(made.seeds.likely), static_cast<double>(made.seeds.lower),
                         static_cast<double>(made.seeds.upper)},
        decided_after(outcomes, target, maximum, source), tally);
}

constexpr int points_together = 12;

// Compares the planned seeds of all points together with the actual ones.
void simulate_together(int pilot, double tolerance, unsigned start, Tally& tally) {
  constexpr int maximum = 4000;
  std::mt19937_64 random(start);
  std::uniform_real_distribution<double> uniform(0, 1);
  Campaign campaign{"", {}, {}, {}, {"relative_viscosity", tolerance, confidence}, minimum, maximum, {}};
  std::map<std::string, PointHistory> known;
  int actual = 0;
  for (int point = 0; point < points_together; ++point) {
    const double spread = 0.05 * std::pow(10, uniform(random));
    Source source({false, pilot, tolerance, std::pow(1.959964 * spread / tolerance, 2)},
                  static_cast<unsigned>(random()));
    const std::string hash = fmt::format("{}", point);
    campaign.points.push_back({hash, {}, {}, hash});
    std::vector<std::optional<Outcome>> outcomes;
    verdict_at(pilot, outcomes, campaign.target, maximum, source);
    known[hash] = {{pilot, 1, 1}, outcomes};
    actual += decided_after(outcomes, campaign.target, maximum, source);
  }
  const Plan plan = make_plan(campaign, std::vector<double>(points_together, 1), known, 1);
  if (plan.totals.points < points_together) {
    ++tally.none;
  } else {
    judge(plan.totals.seeds, actual, tally);
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int pilot : {2, 4, 8}) {
    for (const double needed : {4.0, 16.0, 64.0, 256.0}) all.push_back({false, pilot, 0.05, needed});
  }
  // Coefficients of variation 0.26 and 0.51.
  for (const double tolerance : {0.05, 0.1}) {
    for (const int pilot : {4, 8}) all.push_back({true, pilot, tolerance, 100});
  }
  return all;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ssize(values) / 2, values.end());
  return values[values.size() / 2];
}

void print_row(const std::string& population, const Case& about, const Tally& tally) {
  const auto percent = [&](int part) { return 100.0 * part / tally.count; };
  fmt::print("{},{},{:g},{:g},{},{},{},{:.1f},{:.1f},{:.1f},{:.3f},{:.1f}\n", population, about.pilot,
             about.tolerance, about.needed, tally.count, tally.none, tally.decided, percent(tally.held),
             percent(tally.below), percent(tally.above), median(tally.ratios), median(tally.widths));
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 2000;
  if (campaigns < 1) {
    fmt::print(stderr, "prediction_study [CAMPAIGNS]: an integer from 1 on\n");
    return 2;
  }
  fmt::print(
      "population,pilot,tolerance,needed_seeds,predicted,not_predicted,decided,held_percent,below_percent,"
      "above_"
      "percent,"
      "median_ratio,median_width\n");
  unsigned row = 0;
  for (const Case& about : cases()) {
    Source source(about, ++row);
    Tally tally;
    for (int campaign = 0; campaign < campaigns; ++campaign) simulate(about, source, tally);
    if (tally.count > 0) print_row(about.lognormal ? "lognormal" : "normal", about, tally);
  }
  for (const double tolerance : {0.03, 0.06}) {
    for (const int pilot : {2, 4, 8}) {
      Tally tally;
      for (int campaign = 0; campaign < campaigns; ++campaign) {
        simulate_together(pilot, tolerance, static_cast<unsigned>(campaign), tally);
      }
      if (tally.count > 0) print_row("twelve points", {false, pilot, tolerance, std::nan("")}, tally);
    }
  }
  return 0;
}
