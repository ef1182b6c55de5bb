// Interaction range of each pair of size classes: centre distance beyond which every term is zero.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace peclet::engine {

class RangeTable {
 public:
  RangeTable() = default;
  explicit RangeTable(std::size_t classes) : classes_(classes), range_(classes * classes) {}

  std::size_t classes() const { return classes_; }
  double& at(std::size_t a, std::size_t b) { return range_[a * classes_ + b]; }
  double at(std::size_t a, std::size_t b) const { return range_[a * classes_ + b]; }
  double largest() const { return *std::max_element(range_.begin(), range_.end()); }
  double smallest() const { return *std::min_element(range_.begin(), range_.end()); }

 private:
  std::size_t classes_ = 0;
  std::vector<double> range_;
};

}  // namespace peclet::engine
