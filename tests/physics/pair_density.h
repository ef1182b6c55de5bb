// The distribution of the distance of two spheres in a small periodic cube, sampled and exact.
//
// Spheres of radius 1 in a cube of edge 4 may touch two images of each other at once, but never overlap both:
// images along an axis are 4 apart, so their distances to one point add up to at least 4. The distance d of
// the nearest image alone fixes the contact energy, and exactly
//   p(d) ~ A(d) exp(-U(d) / kT),  U = k_n delta^2 / 2 for delta = 2 - d > 0,
//   A(d): area of the sphere of radius d within the cube [-2, 2]^3,
//         4 pi d^2 up to the faces at d = 2,
//         2 pi d (3 L - 4 d) from there to the edges at 2 sqrt(2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace peclet::engine {

// The parameters of a run in natural units (laboratory.h).
struct PairDensityRun {
  double thermal_energy;
  double stiffness_over_thermal_energy;
  double inner_gap;
  double timestep;
  std::uint64_t steps;         // per realisation
  std::uint64_t realisations;  // independent; errors come from their scatter
  std::uint64_t first_seed = 1;
  std::optional<double> solver_tolerance = {};  // of implicit steps; explicit steps if empty
};

constexpr double pair_density_outer_gap = 0.05;

// Returns the edges of the bins of the distance d. Bins of overlaps are in units of the thermal overlap; bins
// of gaps cover the inner and outer gap. The last bin, beyond these edges, is not counted.
std::vector<double> pair_density_edges(const PairDensityRun& run);

// Returns the share of steps in each bin, one row per realisation. Each realisation starts at a random
// separation without overlap and equilibrates before the count begins.
std::vector<std::vector<double>> sampled_shares(const PairDensityRun& run);

// Returns the exact share of each bin, from the contact energy alone or with the bias of the step.
//
// Velocity Verlet moves the spheres with half-step velocities. Their variance along n is (kT / m)(1 - lambda
// dt / 2)^-1, with the decay rate lambda = 2 X_A / m + zeta / m at that gap. Where the rate depends on the
// position, the flux rho <V^2> is uniform and not rho, so that
//   p(d) ~ A(d) (1 - lambda(d) dt / 2) exp(-U(d) / kT).
enum class StepBias { none, half_step };
std::vector<double> expected_shares(const PairDensityRun& run, StepBias bias);

// Returns the probability that the shares of independent realisations scatter this far from `expected` by
// chance. Uses Hotelling's T^2, which includes the covariance of the bins; needs more realisations than bins.
double probability_of(const std::vector<std::vector<double>>& shares, const std::vector<double>& expected);

}  // namespace peclet::engine
