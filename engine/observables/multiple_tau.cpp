#include "engine/observables/multiple_tau.h"

#include <algorithm>

namespace peclet::engine {
namespace {

// Returns the first lag of a level in units of its spacing: `least` for the first level; a later level begins
// where the level before it ends.
std::size_t first_lag(std::size_t level, std::size_t least) { return level == 0 ? least : LagSums::kept / 2; }

template <class Level>
std::vector<LagMean> means_of(const std::vector<Level>& levels, LagSums Level::*sums, std::size_t least) {
  std::vector<LagMean> means;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const LagSums& own = levels[l].*sums;
    for (std::size_t k = first_lag(l, least); k < LagSums::kept; ++k) {
      if (own.count[k] > 0) {
        means.push_back({std::uint64_t{k} << l, own.sum[k] / static_cast<double>(own.count[k])});
      }
    }
  }
  return means;
}

// Returns the lags that this number of samples has.
std::vector<std::uint64_t> lags_of(std::size_t levels, std::uint64_t samples, std::size_t least) {
  std::vector<std::uint64_t> lags;
  for (std::size_t l = 0; l < levels; ++l) {
    const std::uint64_t end = std::min<std::uint64_t>(LagSums::kept, (samples >> l) + least);
    for (std::size_t k = first_lag(l, least); k < end; ++k) lags.push_back(std::uint64_t{k} << l);
  }
  return lags;
}

}  // namespace

void MultipleTau::add(double value, double partner) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    level.last[level.pushed % kept] = partner;
    ++level.pushed;
    for (std::size_t k = first_lag(l, 0); k < kept && k < level.pushed; ++k) {
      level.products.add(k, value * level.last[(level.pushed - 1 - k) % kept]);
    }
    level.sum += value;
    level.partner_sum += partner;
    if (level.pushed % block != 0) return;
    value = level.sum / block;
    partner = level.partner_sum / block;
    level.sum = level.partner_sum = 0;
  }
}

std::vector<LagMean> MultipleTau::values() const { return means_of(levels_, &Level::products, 0); }

std::vector<std::uint64_t> MultipleTau::lags(std::size_t levels, std::uint64_t samples) {
  return lags_of(levels, samples, 0);
}

std::vector<LagMean> weighted_sum(const std::vector<MultipleTau>& correlators,
                                  std::span<const double> weights) {
  std::vector<LagMean> sum = correlators[0].values();
  for (LagMean& value : sum) value.mean *= weights[0];
  for (std::size_t c = 1; c < correlators.size(); ++c) {
    const std::vector<LagMean> own = correlators[c].values();
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k].mean += weights[c] * own[k].mean;
  }
  return sum;
}

void SquaredSums::add(double value) {
  sum_ += value;
  ++entries_;
  for (std::size_t l = 0; l < levels_.size() && entries_ % (std::uint64_t{1} << l) == 0; ++l) {
    Level& level = levels_[l];
    const std::uint64_t now = entries_ >> l;
    for (std::size_t m = first_lag(l, 1); m < kept && m <= now; ++m) {
      const double over_window = sum_ - level.last[(now - m) % kept];
      level.squares.add(m, over_window * over_window);
    }
    level.last[now % kept] = sum_;
  }
}

std::vector<LagMean> SquaredSums::values() const { return means_of(levels_, &Level::squares, 1); }

std::vector<std::uint64_t> SquaredSums::lengths(std::size_t levels, std::uint64_t entries) {
  return lags_of(levels, entries, 1);
}

}  // namespace peclet::engine
