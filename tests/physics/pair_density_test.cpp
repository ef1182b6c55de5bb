// The potential of mean force of two spheres: flat outside contact, across the inner and outer gap of
// lubrication, and k_n delta^2 / (2 kT) inside.
//
// The equilibrium density depends neither on the inner gap nor on inertia. Short runs suffice with a wide
// inner gap (1e-2) and hot spheres (free path of about a radius). Soft contacts, k_n a^2 / kT = 1000, fill
// the bins of overlaps. pair_density_study repeats this in long runs with the published inner gap.
//
// False failures with fresh seeds: 1e-4 each, by Hotelling's T^2 over 9 bins and 40 realisations.
#include "tests/physics/pair_density.h"

#include <gtest/gtest.h>

#include "tests/physics/estimates.h"

namespace peclet::engine {
namespace {

constexpr double smallest_probability = 1e-4;

// `rate_times_step` is the step in units of the decay time of the approach of two spheres at the inner gap,
// whose rate is 2 X_A / m + zeta / m.
PairDensityRun make_run(double thermal_energy, double inner_gap, double rate_times_step,
                        std::uint64_t steps) {
  const double rate = 2 * (0.25 / inner_gap + 9.0 / 40 * std::log(1 / inner_gap)) + 1;
  return {.thermal_energy = thermal_energy,
          .stiffness_over_thermal_energy = 1000,
          .inner_gap = inner_gap,
          .timestep = rate_times_step / rate,
          .steps = steps,
          .realisations = 40};
}

// Returns the measured over the expected share of the bins `first` to `last`.
Estimate ratio(const std::vector<std::vector<double>>& shares, const std::vector<double>& expected,
               std::size_t first, std::size_t last) {
  std::vector<double> ratios;
  for (const std::vector<double>& row : shares) {
    double sum = 0, wanted = 0;
    for (std::size_t bin = first; bin <= last; ++bin) {
      sum += row[bin];
      wanted += expected[bin];
    }
    ratios.push_back(sum / wanted);
  }
  return estimate(ratios);
}

TEST(PairDensity, FollowsTheContactEnergyAndIsFlatOutsideAtSmallSteps) {
  const PairDensityRun run = make_run(1, 2e-2, 0.02, 125'000);
  const auto shares = sampled_shares(run);
  const auto expected = expected_shares(run, StepBias::none);
  EXPECT_GT(probability_of(shares, expected), smallest_probability);
  const Estimate overlapping = ratio(shares, expected, 0, 2), lubricated = ratio(shares, expected, 3, 5);
  // The statistical errors that the claim needs.
  EXPECT_LT(overlapping.error, 0.03);
  EXPECT_LT(lubricated.error, 0.03);
}

// At half the largest stable step of a dense packing (lambda dt / 2 = 1 / 5.6 for one pair at the inner gap)
// the density at contact is lower by that fraction; see StepBias. Bins beyond the outer gap are left out: hot
// spheres cross them before their velocities forget the lubrication inside.
TEST(PairDensity, IsLoweredByTheHalfStepBiasAtLargeSteps) {
  constexpr std::size_t bins_with_lubrication = 6;
  const PairDensityRun run = make_run(0.1, 1e-2, 2 / 5.6, 100'000);
  const auto shares = sampled_shares(run);
  const auto probability = [&](StepBias bias) {
    std::vector<double> expected = expected_shares(run, bias);
    expected.resize(bins_with_lubrication);
    return probability_of(shares, expected);
  };
  EXPECT_GT(probability(StepBias::half_step), smallest_probability);
  EXPECT_LT(probability(StepBias::none), smallest_probability);
}

// Implicit steps of the automatic size in the scene of Table 4.1 of Li's thesis at low Péclet numbers. The
// test rejects a half-step bias of 0.82 in contact, and one of 0.93 in the bin beyond the outer gap, where
// the resistance jumps.
TEST(PairDensity, IsKeptByImplicitSteps) {
  PairDensityRun run = {.thermal_energy = 2.0e-3,
                        .stiffness_over_thermal_energy = 5.9e5,
                        .inner_gap = 1e-3,
                        .timestep = 0.1192,
                        .steps = 500'000,
                        .realisations = 40,
                        .solver_tolerance = 4e-3};
  const auto shares = sampled_shares(run);
  const std::vector<double> expected = expected_shares(run, StepBias::none);
  const Estimate touching = ratio(shares, expected, 0, 3), near = ratio(shares, expected, 4, 5);
  const Estimate beyond = ratio(shares, expected, 6, 6);
  EXPECT_LT(std::max({touching.error, near.error, beyond.error}), 0.03);
  EXPECT_NEAR(touching.mean, 1, 0.04 + 3 * touching.error) << touching.mean << " +- " << touching.error;
  EXPECT_NEAR(near.mean, 1, 0.01 + 3 * near.error) << near.mean << " +- " << near.error;
  EXPECT_NEAR(beyond.mean, 1, 0.03 + 3 * beyond.error) << beyond.mean << " +- " << beyond.error;
}

}  // namespace
}  // namespace peclet::engine
