#include "engine/observables/production.h"

#include <algorithm>
#include <numeric>

namespace peclet::engine {

Production::Production(std::uint64_t steps) : steps_(steps) {
  // The first step of a block.
  const auto begin = [&](std::size_t block) {
    return (block * steps + count_of_blocks - 1) / count_of_blocks;
  };
  for (std::size_t k = 0; k < count_of_blocks; ++k) blocks_[k].planned = begin(k + 1) - begin(k);
}

void Production::add_step(std::uint64_t index, const PairSums& sums, const SymmetricTensor& motion,
                          double shear_rate) {
  BlockSums& block = block_of(index);
  ++block.steps;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    block.stress[t] += sums.stress[t];
  }
  block.motion += motion;
  block.shear_rate += shear_rate;
  block.contacts += sums.contacts;
  block.overlaps += sums.overlaps;
}

void Production::add_sample(std::uint64_t index, const SymmetricTensor& structural_brownian,
                            const SymmetricTensor& varying_stresslet,
                            const KineticTemperatures& temperature) {
  BlockSums& block = block_of(index);
  ++block.samples;
  block.structural_brownian += structural_brownian;
  block.varying_stresslet += varying_stresslet;
  block.temperature.translational += temperature.translational;
  block.temperature.rotational += temperature.rotational;
}

BlockSums sum_of(std::span<const BlockSums> blocks) {
  BlockSums all;
  for (const BlockSums& block : blocks) {
    all.planned += block.planned;
    all.steps += block.steps;
    all.samples += block.samples;
    all.shear_rate += block.shear_rate;
    all.contacts += block.contacts;
    all.overlaps += block.overlaps;
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      all.stress[t] += block.stress[t];
    }
    all.motion += block.motion;
    all.structural_brownian += block.structural_brownian;
    all.varying_stresslet += block.varying_stresslet;
    all.temperature.translational += block.temperature.translational;
    all.temperature.rotational += block.temperature.rotational;
  }
  return all;
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
  // Values that differ by rounding alone say nothing.
  if (!(variance > 1e-24 * mean * mean)) {
    return 1;
  }
  double inefficiency = 1;
  for (std::size_t lag = 1; lag < series.size(); ++lag) {
    const double correlation = covariance(lag) / variance;
    if (correlation <= 0) {
      break;
    }
    inefficiency += 2 * correlation;
  }
  return inefficiency;
}

}  // namespace peclet::engine
