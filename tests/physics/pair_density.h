// How often two spheres in a small periodic cube are at each distance, and how often they should be.
//
// Spheres of radius 1 in a cube of edge 4 touch two images of each other at once, but never overlap both: two
// images along an axis are 4 apart, so their distances to one point add up to 4 at least. So the distance d
// of the nearest image alone fixes the contact energy, and
//   p(d) ~ A(d) exp(-U(d) / kT),  U = k_n delta^2 / 2 for delta = 2 - d > 0,
// exactly, A(d) the area of the sphere of radius d within the cube [-2, 2]^3: 4 pi d^2 up to the faces at d =
// 2, 2 pi d (3 L - 4 d) from there to the edges at 2 sqrt(2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace peclet::engine {

// In natural units (laboratory.h).
struct PairDensityRun {
  double thermal_energy;
  double stiffness_over_thermal_energy;
  double inner_gap;
  double timestep;
  std::uint64_t steps;         // of each realisation
  std::uint64_t realisations;  // independent: the errors come from their scatter
  std::uint64_t first_seed = 1;
  std::optional<double> solver_tolerance = {};  // of implicit steps; none: explicit ones
};

constexpr double pair_density_outer_gap = 0.05;

// Edges of the bins of the distance d: overlaps in units of the thermal one, gaps across the inner and outer
// gap. The last bin, beyond the last edge, is not counted: its share is what the others leave.
std::vector<double> pair_density_edges(const PairDensityRun& run);

// Share of the steps that each bin holds, one row per realisation. Each starts at a random separation without
// overlap and forgets it before the count begins.
std::vector<std::vector<double>> sampled_shares(const PairDensityRun& run);

// Share by the contact energy alone, and as the step changes it.
//
// Velocity Verlet moves the spheres with half-step velocities, whose variance along n is (kT / m)(1 - lambda
// dt / 2)^-1, lambda = 2 X_A / m + zeta / m the rate at which they decay at that gap (physics of section 9).
// Where the rate depends on the place the flux rho <V^2> is uniform rather than rho, so that
//   p(d) ~ A(d) (1 - lambda(d) dt / 2) exp(-U(d) / kT).
enum class StepBias { none, half_step };
std::vector<double> expected_shares(const PairDensityRun& run, StepBias bias);

// Probability that the shares of independent realisations scatter this far from `expected` by chance:
// Hotelling's T^2, which takes account of the covariance of the bins. Needs more realisations than bins.
double probability_of(const std::vector<std::vector<double>>& shares, const std::vector<double>& expected);

}  // namespace peclet::engine
