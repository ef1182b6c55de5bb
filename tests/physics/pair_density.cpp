#include "tests/physics/pair_density.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>

#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

constexpr double cell_edge = 4, contact_distance = 2;
// Duration in which the slowest mode of the separation decays by e^10: (edge / 2 pi)^2 / (2 D), D = kT.
constexpr double burn_in_distance_squared = 2;

double area(double d) {
  return d < contact_distance ? 4 * std::numbers::pi * d * d
                              : 2 * std::numbers::pi * d * (3 * cell_edge - 4 * d);
}

double weight(const PairDensityRun& run, StepBias bias, double d) {
  const double overlap = std::max(contact_distance - d, 0.0);
  const double boltzmann = std::exp(-0.5 * run.stiffness_over_thermal_energy * overlap * overlap);
  if (bias == StepBias::none) return boltzmann;
  // X_A of equal spheres, eq. 9 of Li, Royer & Ness (2023) with beta = 1, gap h / a.
  const double gap = std::max(d - contact_distance, run.inner_gap);
  const double squeeze = gap <= pair_density_outer_gap ? 0.25 / gap + 9.0 / 40 * std::log(1 / gap) : 0.0;
  return (1 - 0.5 * run.timestep * (2 * squeeze + 1)) * boltzmann;
}

// Returns the integral of area times weight by the midpoint rule; the integrand is smooth between edges.
double integral(const PairDensityRun& run, StepBias bias, double from, double to) {
  constexpr int intervals = 4000;
  const double width = (to - from) / intervals;
  double sum = 0;
  for (int k = 0; k < intervals; ++k) {
    const double d = from + (k + 0.5) * width;
    sum += width * area(d) * weight(run, bias, d);
  }
  return sum;
}

double nearest(double component) { return component - cell_edge * std::round(component / cell_edge); }

Vector3 nearest_separation(const ParticleState& pair) {
  const Vector3 r = pair.position[1] - pair.position[0];
  return {nearest(r.x), nearest(r.y), nearest(r.z)};
}

Laboratory make_pair(const PairDensityRun& run, std::uint64_t seed) {
  Experiment experiment;
  experiment.physics.viscosity = natural_viscosity;
  experiment.physics.thermal_energy = run.thermal_energy;
  experiment.physics.contact =
      ContactParameters{.normal_stiffness = run.stiffness_over_thermal_energy * run.thermal_energy};
  experiment.physics.lubrication = LubricationParameters{run.inner_gap, pair_density_outer_gap};
  experiment.radius = {1, 1};
  experiment.box = PeriodicCell({cell_edge, cell_edge, cell_edge}, Matrix3{});
  experiment.timestep = run.timestep;
  experiment.seed = seed;
  experiment.skin = 0.5;
  experiment.solver_tolerance = run.solver_tolerance;
  Laboratory laboratory(experiment);
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> anywhere(0, cell_edge);
  do {
    laboratory.particles().position.set(1, {anywhere(generator), anywhere(generator), anywhere(generator)});
  } while (norm(nearest_separation(laboratory.particles())) < contact_distance);
  laboratory.thermalise(generator);
  laboratory.start();
  return laboratory;
}

std::vector<double> shares_of_realisation(const PairDensityRun& run, std::uint64_t seed) {
  Laboratory laboratory = make_pair(run, seed);
  const double steps_per_unit = 1 / (run.thermal_energy * run.timestep);
  for (auto step = static_cast<std::uint64_t>(burn_in_distance_squared * steps_per_unit); step > 0; --step) {
    laboratory.step();
  }
  const std::vector<double> edges = pair_density_edges(run);
  std::vector<double> shares(edges.size() - 1);
  for (std::uint64_t step = 0; step < run.steps; ++step) {
    laboratory.step();
    const double d = norm(nearest_separation(laboratory.particles()));
    const auto above = std::upper_bound(edges.begin(), edges.end(), d);
    if (above != edges.end()) {
      shares[static_cast<std::size_t>(above - edges.begin()) - 1] += 1 / static_cast<double>(run.steps);
    }
  }
  return shares;
}

// Returns x.C^-1.x of a symmetric positive definite C by its Cholesky factor, which replaces C.
double inverse_form(std::vector<std::vector<double>>& C, std::vector<double> x) {
  double sum = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double rest = C[a][b];
      for (std::size_t c = 0; c < b; ++c) rest -= C[a][c] * C[b][c];
      C[a][b] = a == b ? std::sqrt(rest) : rest / C[b][b];
    }
    for (std::size_t c = 0; c < a; ++c) x[a] -= C[a][c] * x[c];
    x[a] /= C[a][a];
    sum += x[a] * x[a];
  }
  return sum;
}

}  // namespace

std::vector<double> pair_density_edges(const PairDensityRun& run) {
  const double thermal = 1 / std::sqrt(run.stiffness_over_thermal_energy), outer = pair_density_outer_gap;
  std::vector<double> edges = {-contact_distance, -1.4 * thermal, -0.7 * thermal, 0,   run.inner_gap,
                               2 * run.inner_gap, outer,          2 * outer,      0.2, 0.4};
  for (double& edge : edges) edge += contact_distance;
  return edges;
}

std::vector<std::vector<double>> sampled_shares(const PairDensityRun& run) {
  std::vector<std::vector<double>> shares;
  for (std::uint64_t k = 0; k < run.realisations; ++k) {
    shares.push_back(shares_of_realisation(run, run.first_seed + k));
  }
  return shares;
}

std::vector<double> expected_shares(const PairDensityRun& run, StepBias bias) {
  // Beyond d > 2 sqrt(2), the edges of the cube, only the volume matters.
  const double edges_at = contact_distance * std::numbers::sqrt2;
  const double inside = integral(run, StepBias::none, contact_distance, edges_at);
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(contact_distance, 3);
  const double corners = (std::pow(cell_edge, 3) - ball - inside) * weight(run, bias, edges_at);
  std::vector<double> edges = pair_density_edges(run);
  std::vector<double> shares;
  double total = corners + integral(run, bias, edges.back(), edges_at);
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    shares.push_back(integral(run, bias, edges[k], edges[k + 1]));
    total += shares.back();
  }
  for (double& share : shares) share /= total;
  return shares;
}

double probability_of(const std::vector<std::vector<double>>& shares, const std::vector<double>& expected) {
  const std::size_t p = expected.size();
  const auto n = static_cast<double>(shares.size());
  std::vector<double> mean(p), difference(p);
  for (std::size_t a = 0; a < p; ++a) {
    for (const std::vector<double>& row : shares) mean[a] += row[a] / n;
    difference[a] = mean[a] - expected[a];
  }
  std::vector<std::vector<double>> covariance(p, std::vector<double>(p));
  for (const std::vector<double>& row : shares) {
    for (std::size_t a = 0; a < p; ++a) {
      for (std::size_t b = 0; b < p; ++b) {
        covariance[a][b] += (row[a] - mean[a]) * (row[b] - mean[b]) / (n - 1);
      }
    }
  }
  const double t_squared = n * inverse_form(covariance, difference);
  const auto bins = static_cast<double>(p);
  const double f = t_squared * (n - bins) / (bins * (n - 1));
  return cdf(complement(boost::math::fisher_f(bins, n - bins), f));
}

}  // namespace peclet::engine
