#include "engine/observables/multiple_tau.h"

#include <algorithm>

namespace peclet::engine {

void MultipleTau::add(double value, double partner) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    level.last[level.pushed % kept] = partner;
    ++level.pushed;
    for (std::size_t k = first_lag(l); k < kept && k < level.pushed; ++k) {
      level.products[k] += value * level.last[(level.pushed - 1 - k) % kept];
      ++level.count[k];
    }
    level.sum += value;
    level.partner_sum += partner;
    if (level.pushed % block != 0) return;
    value = level.sum / block;
    partner = level.partner_sum / block;
    level.sum = level.partner_sum = 0;
  }
}

std::vector<MultipleTau::Value> MultipleTau::values() const {
  std::vector<Value> values;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    for (std::size_t k = first_lag(l); k < kept; ++k) {
      const Level& level = levels_[l];
      if (level.count[k] == 0) continue;
      values.push_back({std::uint64_t{k} << l, level.products[k] / static_cast<double>(level.count[k])});
    }
  }
  return values;
}

std::vector<std::uint64_t> MultipleTau::lags(std::size_t levels, std::uint64_t samples) {
  std::vector<std::uint64_t> lags;
  for (std::size_t l = 0; l < levels; ++l) {
    const std::uint64_t pushed = samples >> l;  // block is 2
    for (std::size_t k = first_lag(l); k < std::min<std::uint64_t>(kept, pushed); ++k) {
      lags.push_back(std::uint64_t{k} << l);
    }
  }
  return lags;
}

void SquaredSums::add(double value) {
  sum_ += value;
  ++entries_;
  for (std::size_t l = 0; l < levels_.size() && entries_ % (std::uint64_t{1} << l) == 0; ++l) {
    Level& level = levels_[l];
    const std::uint64_t now = entries_ >> l;
    for (std::size_t m = first_length(l); m < kept && m <= now; ++m) {
      const double over_window = sum_ - level.last[(now - m) % kept];
      level.squares[m] += over_window * over_window;
      ++level.count[m];
    }
    level.last[now % kept] = sum_;
  }
}

std::vector<SquaredSums::Value> SquaredSums::values() const {
  std::vector<Value> values;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    for (std::size_t m = first_length(l); m < kept; ++m) {
      const Level& level = levels_[l];
      if (level.count[m] == 0) continue;
      values.push_back({std::uint64_t{m} << l, level.squares[m] / static_cast<double>(level.count[m])});
    }
  }
  return values;
}

std::vector<std::uint64_t> SquaredSums::lengths(std::size_t levels, std::uint64_t entries) {
  std::vector<std::uint64_t> lengths;
  for (std::size_t l = 0; l < levels; ++l) {
    for (std::size_t m = first_length(l); m <= std::min<std::uint64_t>(kept - 1, entries >> l); ++m) {
      lengths.push_back(std::uint64_t{m} << l);
    }
  }
  return lengths;
}

}  // namespace peclet::engine
