#include "engine/observables/multiple_tau.h"

namespace peclet::engine {

void MultipleTau::add(double value) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    level.last[level.pushed % kept] = value;
    ++level.pushed;
    for (std::size_t k = first_lag(l); k < kept && k < level.pushed; ++k) {
      level.products[k] += value * level.last[(level.pushed - 1 - k) % kept];
      ++level.count[k];
    }
    level.sum += value;
    if (level.pushed % block != 0) return;
    value = level.sum / block;
    level.sum = 0;
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

}  // namespace peclet::engine
