// next_study [REPETITIONS]: what `peclet next` takes until the band of a curve is within a tolerance
// everywhere, beside even grids and grids of publications, as a CSV table.
//
// Each repetition draws its own seeds. A grid is run to the tolerance as a campaign with a curve. If the band
// is wider between its points, next adds points, and grids ask for a smaller tolerance, up to forty times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "runner/statistics/curve_proposal.h"
#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

constexpr int minimum = 8, maximum = 2000, most_rounds = 40;
using Function = std::function<double(double)>;

struct Truth {
  std::string name;
  double tolerance = 0.05;
  bool is_logarithmic = true;
  double first = 0, last = 1;
  std::vector<double> published;
  Function mean, spread, steps;
};

std::vector<Truth> truths() {
  std::vector<Truth> all;
  // Like that of results/flow-curve at 0.50: 16 at rest, least at Pe = 5, 13.7 in strong flow.
  all.push_back({"thinning and thickening over Pe",
                 0.05,
                 true,
                 0.046,
                 1e4,
                 {0.046, 0.22, 1, 4.6, 22, 100, 460, 2200, 1e4},
                 [](double x) { return 7.7 + 8.3 / (1 + x / 0.25) + 6 * x / (x + 60); },
                 [](double x) { return std::hypot(0.04, 0.0065 / x); },
                 [](double x) { return 50 + 450 / (1 + x / 0.05); }});
  // Wyart & Cates (Phys. Rev. Lett. 112, 098302, 2014) at 0.50, jamming at 0.58 and 0.65.
  all.push_back({"friction over stress",
                 0.05,
                 true,
                 0.01,
                 100,
                 {0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100},
                 [](double x) {
                   const double share = std::exp(-1 / x);
                   return std::pow(1 - 0.5 / (0.58 * share + 0.65 * (1 - share)), -2);
                 },
                 [](double) { return 0.08; },
                 [](double) { return 1; }});
  // Packings of two sizes, densest at a share of 0.3 of small spheres.
  all.push_back({"jamming over the share of small spheres",
                 0.004,
                 false,
                 0,
                 1,
                 {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1},
                 [](double x) {
                   const double rising = 0.64 + 0.35 * x, falling = 0.80 - 0.16 * x;
                   return -0.02 * std::log(std::exp(-rising / 0.02) + std::exp(-falling / 0.02)) + 0.002;
                 },
                 [](double) { return 0.01; },
                 [](double) { return 1; }});
  return all;
}

std::vector<double> even_grid(const Truth& truth, int points) {
  std::vector<double> grid;
  for (int i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / (points - 1);
    grid.push_back(truth.is_logarithmic ? truth.first * std::pow(truth.last / truth.first, share)
                                        : truth.first + share * (truth.last - truth.first));
  }
  return grid;
}

// The seeds of one repetition: the same for the same place of the axis.
class Source {
 public:
  Source(const Truth& truth, unsigned start) : truth_(truth), start_(start) {}
  const std::vector<std::optional<Outcome>>& outcomes(double axis, int count) {
    auto known = outcomes_.find(axis);
    if (known == outcomes_.end()) {
      std::seed_seq seed{start_, static_cast<unsigned>(std::hash<double>()(axis))};
      known = outcomes_.emplace(axis, std::vector<std::optional<Outcome>>()).first;
      random_.emplace(axis, std::mt19937_64(seed));
    }
    while (static_cast<int>(known->second.size()) < count) {
      const double z = std::normal_distribution<double>()(random_.at(axis));
      Outcome outcome{{truth_.mean(axis) * (1 + truth_.spread(axis) * z)}};
      outcome.steps = truth_.steps(axis);
      known->second.emplace_back(outcome);
    }
    return known->second;
  }

 private:
  const Truth& truth_;
  unsigned start_;
  std::map<double, std::vector<std::optional<Outcome>>> outcomes_;
  std::map<double, std::mt19937_64> random_;
};

struct Result {
  double steps = 0;
  int seeds = 0, points = 0, rounds = 0;
  bool is_within = false;    // the band, everywhere
  double largest_error = 0;  // of the curve, over the truth
};

// Returns the points of a campaign with a curve that was run to the tolerance.
std::vector<KnownOnCurve> run(const Truth& truth, const std::vector<double>& grid, double tolerance,
                              Source& source) {
  Target target{"viscosity", tolerance, 0.95};
  target.tolerance.over = "/axis";
  CurveStopTests stop_tests({{}, grid}, target, minimum, maximum);
  for (int most = minimum;; most = std::min(maximum, 2 * most)) {
    std::vector<std::vector<std::optional<Outcome>>> outcomes;
    for (const double axis : grid) outcomes.push_back(source.outcomes(axis, most));
    std::vector<CurveStopTests::Member> members;
    for (const auto& of_point : outcomes) members.push_back({&of_point});
    for (std::vector<std::optional<Outcome>>& of_point : outcomes)
      of_point.resize(static_cast<std::size_t>(most));
    stop_tests.advance(members);
    if (stop_tests.stop_tests(0).back().verdict != Verdict::more || most == maximum) break;
  }
  std::vector<KnownOnCurve> known;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const StopTest& last = stop_tests.stop_tests(i).back();
    known.push_back({{grid[i], last.controlled.mean, last.controlled.standard_error, last.controlled.count},
                     last.seeds,
                     truth.steps(grid[i])});
  }
  return known;
}

// `at_once` is the number of points that may be added in a round.
Result study(const Truth& truth, std::vector<double> grid, int at_once, Source& source) {
  const double level = adjusted_confidence(0.95, minimum, maximum);
  Result outcome;
  double tolerance = truth.tolerance;
  std::vector<KnownOnCurve> known;
  for (outcome.rounds = 1; outcome.rounds <= most_rounds; ++outcome.rounds) {
    known = run(truth, grid, tolerance, source);
    ProposalBounds bounds{truth.tolerance, {}, at_once};
    const CurvePlan plan =
        plan_curve(known, false, stop_test_schedule(minimum, maximum), level, bounds).value();
    outcome.is_within = plan.width <= truth.tolerance;
    if (outcome.is_within || plan.proposals.empty()) break;
    for (const CurveProposal& proposal : plan.proposals) {
      if (proposal.is_new && std::ranges::find(grid, proposal.axis) == grid.end())
        grid.push_back(proposal.axis);
      if (!proposal.is_new) tolerance = std::min(tolerance, 0.99 * plan.width_at_points);
    }
    std::ranges::sort(grid);
  }
  std::vector<CurveFit::Datum> data;
  for (const KnownOnCurve& point : known) {
    data.push_back(point.datum);
    outcome.seeds += point.seeds;
    outcome.steps += point.seeds * point.cost;
  }
  outcome.points = static_cast<int>(grid.size());
  const std::vector<double> dense = even_grid(truth, 200);
  const std::vector<CurveFit::Value> values = CurveFit(data).at(dense);
  for (std::size_t i = 0; i < dense.size(); ++i) {
    const double error = std::abs(std::expm1(values[i].mean - std::log(truth.mean(dense[i]))));
    outcome.largest_error = std::max(outcome.largest_error, error);
  }
  return outcome;
}

void print(const Truth& truth, const std::string& scheme, const std::vector<Result>& all) {
  std::vector<double> steps, seeds, points, errors;
  int within = 0;
  for (const Result& one : all) {
    within += one.is_within ? 1 : 0;
    if (!one.is_within) continue;
    steps.push_back(one.steps);
    seeds.push_back(one.seeds);
    points.push_back(one.points);
    errors.push_back(one.largest_error / truth.tolerance);
  }
  const Estimate of_steps = estimate(steps);
  fmt::print("\"{}\",{},{},{:.0f},{:.4g},{:.2g},{:.1f},{:.1f},{:.2f}\n", truth.name, scheme, all.size(),
             100.0 * within / static_cast<double>(all.size()), of_steps.mean, of_steps.standard_error,
             estimate(seeds).mean, estimate(points).mean, estimate(errors).mean);
  std::fflush(stdout);
}

void study(int repetitions) {
  fmt::print(
      "curve,grid,repetitions,band within the tolerance %,steps,steps_error,seeds,points,largest error over "
      "tolerance\n");
  for (const Truth& truth : truths()) {
    std::map<std::string, std::pair<std::vector<double>, int>> schemes{{"published", {truth.published, 0}}};
    for (const int at_once : {1, 2, 4, 100})
      schemes[fmt::format("next from 5 by {}", at_once)] = {even_grid(truth, 5), at_once};
    for (const int points : {5, 6, 7, 8, 10, 12, 15, 20})
      schemes[fmt::format("even of {:02}", points)] = {even_grid(truth, points), 0};
    for (const auto& [name, scheme] : schemes) {
      std::vector<Result> all;
      for (int start = 0; start < repetitions; ++start) {
        Source source(truth, static_cast<unsigned>(start));
        all.push_back(study(truth, scheme.first, scheme.second, source));
      }
      print(truth, name, all);
    }
  }
}

}  // namespace
}  // namespace peclet::runner

int main(int count, char** words) { peclet::runner::study(count > 1 ? std::atoi(words[1]) : 100); }
