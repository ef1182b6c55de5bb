// The potential of mean force of two spheres in long runs. Prints for each bin of the distance the measured
// and the expected share, and U / kT = -ln of their ratio to free space. README.md lists the results.
#include <fmt/format.h>

#include <chrono>
#include <cstring>

#include "tests/physics/estimates.h"
#include "tests/physics/pair_density.h"

namespace {

using namespace peclet::engine;

struct Case {
  const char* name;
  PairDensityRun run;
};

// Explicit steps are half the largest stable step of one scene, (4 / (2.8 lambda)) / 4 with lambda = 504 at a
// gap of 1e-3, or far below it. `table` has the ratios of Table 4.1 of Li's thesis at low Péclet numbers. The
// implicit cases have them too, at the automatic implicit step, at half and at twice that step.
constexpr Case catalogue[] = {
    {"small-step", {0.5, 1e5, 1e-3, 4e-5, 4'000'000, 40}},
    {"automatic-step", {0.05, 1e5, 1e-3, 7.09e-4, 2'000'000, 40}},
    {"table", {2.0e-3, 5.9e5, 1e-3, 7.09e-4, 10'000'000, 40}},
    {"implicit-half", {2.0e-3, 5.9e5, 1e-3, 0.0596, 1'600'000, 40, 1, 4e-3}},
    {"implicit", {2.0e-3, 5.9e5, 1e-3, 0.1192, 1'600'000, 40, 1, 4e-3}},
    {"implicit-double", {2.0e-3, 5.9e5, 1e-3, 0.2385, 800'000, 40, 1, 4e-3}},
};

void print(const PairDensityRun& run) {
  const auto begin = std::chrono::steady_clock::now();
  const auto shares = sampled_shares(run);
  const auto plain = expected_shares(run, StepBias::none), biased = expected_shares(run, StepBias::half_step);
  const std::vector<double> edges = pair_density_edges(run);
  fmt::print("{:>19} {:>10} {:>19} {:>19}\n", "r - 2a", "share", "over exp(-U/kT)", "over that with step");
  for (std::size_t bin = 0; bin < plain.size(); ++bin) {
    std::vector<double> column;
    column.reserve(shares.size());
    for (const auto& row : shares) column.push_back(row[bin]);
    const Estimate e = estimate(column);
    fmt::print("{:>9.5f} {:>9.5f} {:>10.3e} {:>8.4f} +- {:<7.4f} {:>8.4f} +- {:<7.4f}\n", edges[bin] - 2,
               edges[bin + 1] - 2, e.mean, e.mean / plain[bin], e.error / plain[bin], e.mean / biased[bin],
               e.error / biased[bin]);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  fmt::print("probability of the deviation: {:.3g} without, {:.3g} with the bias of the step; {:.0f} s\n",
             probability_of(shares, plain), probability_of(shares, biased), seconds.count());
}

}  // namespace

int main(int count, char** arguments) {
  for (const Case& one : catalogue) {
    if (count == 2 && std::strcmp(arguments[1], one.name) == 0) {
      print(one.run);
      return 0;
    }
  }
  fmt::print(
      stderr,
      "usage: pair_density_study small-step|automatic-step|table|implicit-half|implicit|implicit-double\n");
  return 2;
}
