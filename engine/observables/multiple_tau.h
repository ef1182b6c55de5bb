// Averages over lags from one sample to many, at a cost per sample that does not grow.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/state/archive.h"

namespace peclet::engine {

// The mean of a correlation at one lag.
struct LagMean {
  std::uint64_t lag;  // in samples
  double mean;
};

// Sums at the lags of one level.
struct LagSums {
  static constexpr std::size_t kept = 16;
  std::array<double, kept> sum{};
  std::array<std::uint64_t, kept> count{};

  void add(std::size_t k, double value) {
    sum[k] += value;
    ++count[k];
  }
};

// Correlates a series with itself or with another one.
//
// Level l holds the last 16 means of 2^l consecutive samples. It correlates them over lags of 0 ... 15 of its
// own spacings (8 ... 15 beyond the first level): the multiple-tau scheme with m = 2 and p = 16 of Ramirez,
// Sukumaran, Vorselaars & Likhtman, J. Chem. Phys. 133, 154103 (2010).
class MultipleTau {
 public:
  explicit MultipleTau(std::size_t levels) : levels_(levels) {}

  void add(double value) { add(value, value); }
  // Adds a sample of the series and one of its partner, which is correlated with this and later samples.
  void add(double value, double partner);

  // Returns <p(s) v(s + lag)> in order of the lags, means not subtracted. Lags without samples are left out.
  std::vector<LagMean> values() const;
  // Returns the lags that this number of samples has in these levels, in the same order.
  static std::vector<std::uint64_t> lags(std::size_t levels, std::uint64_t samples);

  void save(ArchiveWriter& archive) const { archive.put_all(levels_); }
  void load(ArchiveReader& archive) { archive.get_all(levels_); }

 private:
  static constexpr std::size_t kept = LagSums::kept, block = 2;
  struct Level {
    std::uint64_t pushed = 0;
    std::array<double, kept> last{};  // ring of values of the partner
    LagSums products;
    double sum = 0, partner_sum = 0;  // for the next level
  };

  std::vector<Level> levels_;
};

// Returns the sum of the correlations, each times its weight.
std::vector<LagMean> weighted_sum(const std::vector<MultipleTau>& correlators,
                                  std::span<const double> weights);

// Averages the squared sums of a series over windows of a length, for lengths from one entry to many.
//
// Level l keeps the last 16 sums up to every 2^l-th entry. It takes windows of 1 ... 15 of its spacings (8
// ... 15 beyond the first level), which begin one spacing apart and overlap.
class SquaredSums {
 public:
  explicit SquaredSums(std::size_t levels) : levels_(levels) {}

  void add(double value);

  // Returns < (sum over the window)^2 > in order of the lengths (lags). Lengths without windows are left out.
  std::vector<LagMean> values() const;
  // Returns the lengths that this number of entries has in these levels, in the same order.
  static std::vector<std::uint64_t> lengths(std::size_t levels, std::uint64_t entries);

  void save(ArchiveWriter& archive) const { archive.put_all(sum_, entries_, levels_); }
  void load(ArchiveReader& archive) { archive.get_all(sum_, entries_, levels_); }

 private:
  static constexpr std::size_t kept = LagSums::kept;
  struct Level {
    std::array<double, kept> last{};  // ring of sums up to an entry; the first is 0
    LagSums squares;
  };

  double sum_ = 0;
  std::uint64_t entries_ = 0;
  std::vector<Level> levels_;
};

}  // namespace peclet::engine
