#include "engine/observables/production.h"

#include <numeric>

namespace peclet::engine {

Production::Production(std::uint64_t steps) : steps_(steps) {
  // Returns the first step of a block.
  const auto begin = [&](std::size_t block) {
    return (block * steps + count_of_blocks - 1) / count_of_blocks;
  };
  for (std::size_t k = 0; k < count_of_blocks; ++k) blocks_[k].planned = begin(k + 1) - begin(k);
}

BlockSums& BlockSums::operator+=(const BlockSums& block) {
  planned += block.planned;
  steps += block.steps;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) stress[t] += block.stress[t];
  motion += block.motion;
  shear_rate += block.shear_rate;
  contacts += block.contacts;
  overlaps += block.overlaps;
  samples += block.samples;
  structural_brownian += block.structural_brownian;
  varying_stresslet += block.varying_stresslet;
  temperature.translational += block.temperature.translational;
  temperature.rotational += block.temperature.rotational;
  return *this;
}

double statistical_inefficiency(const std::vector<double>& series) {
  const auto count = static_cast<double>(series.size());
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / count;
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = 0; k + lag < series.size(); ++k) {
      sum += (series[k] - mean) * (series[k + lag] - mean);
    }
    return sum / count;
  };
  const double variance = covariance(0);
  // The series is constant up to rounding.
  if (!(variance > 1e-24 * mean * mean)) return 1;
  double inefficiency = 1;
  for (std::size_t lag = 1; lag < series.size(); ++lag) {
    const double correlation = covariance(lag) / variance;
    if (correlation <= 0) break;
    inefficiency += 2 * correlation;
  }
  return inefficiency;
}

}  // namespace peclet::engine
