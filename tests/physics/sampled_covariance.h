// Second moments of a vector that is sampled many times, and how far they are from what they should be.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace peclet::engine {

// Of vectors whose mean is known to be zero.
class SampledCovariance {
 public:
  explicit SampledCovariance(std::size_t size) : size_(size), sum_(size), products_(size * size) {}

  void add(const std::vector<double>& x) {
    for (std::size_t a = 0; a < size_; ++a) {
      sum_[a] += x[a];
      for (std::size_t b = a; b < size_; ++b) {
        products_[a * size_ + b] += x[a] * x[b];
      }
    }
    ++samples_;
  }

  // The largest |sampled - expected(a, b)| over all a <= b in units of its standard deviation, which for
  // normal vectors is sqrt((C_aa C_bb + C_ab^2) / samples). Every C_aa must be positive.
  template <class Expected>
  double largest_deviation(Expected&& expected) const {
    const auto n = static_cast<double>(samples_);
    double largest = 0;
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = a; b < size_; ++b) {
        const double c = expected(a, b);
        const double deviation = std::sqrt((expected(a, a) * expected(b, b) + c * c) / n);
        largest = std::max(largest, std::abs(products_[a * size_ + b] / n - c) / deviation);
      }
    }
    return largest;
  }

  // The largest |mean| in units of its standard deviation sqrt(C_aa / samples).
  template <class Expected>
  double largest_mean(Expected&& expected) const {
    double largest = 0;
    for (std::size_t a = 0; a < size_; ++a) {
      largest =
          std::max(largest, std::abs(sum_[a]) / std::sqrt(expected(a, a) * static_cast<double>(samples_)));
    }
    return largest;
  }

 private:
  std::size_t size_;
  std::size_t samples_ = 0;
  std::vector<double> sum_, products_;
};

}  // namespace peclet::engine
