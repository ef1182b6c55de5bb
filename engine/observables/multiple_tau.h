// Correlation of a series with itself or with another one, over lags from one sample to many, at a cost per
// sample that does not grow.
//
// Level l holds the last 16 means of 2^l consecutive samples. It correlates them over lags of 0 ... 15 of its
// own spacings (8 ... 15 beyond the first level): the multiple-tau scheme with m = 2 and p = 16 of Ramirez,
// Sukumaran, Vorselaars & Likhtman, J. Chem. Phys. 133, 154103 (2010).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/archive.h"

namespace peclet::engine {

class MultipleTau {
 public:
  explicit MultipleTau(std::size_t levels) : levels_(levels) {}

  void add(double value) { add(value, value); }
  // A sample of the series and one of its partner, which is correlated with later ones of the series.
  void add(double value, double partner);

  struct Value {
    std::uint64_t lag;   // samples
    double correlation;  // <p(s) v(s + lag)>; the means are not taken away
  };
  // In order of the lags; those that were never met are left out.
  std::vector<Value> values() const;
  // The lags of so many samples in so many levels, in the same order.
  static std::vector<std::uint64_t> lags(std::size_t levels, std::uint64_t samples);

  void save(ArchiveWriter& archive) const { archive.put(levels_); }
  void load(ArchiveReader& archive) { levels_ = archive.get_vector<Level>(levels_.size()); }

 private:
  static constexpr std::size_t kept = 16, block = 2;
  struct Level {
    std::uint64_t pushed = 0;
    std::array<double, kept> last{};  // of the partner, a ring
    std::array<double, kept> products{};
    std::array<std::uint64_t, kept> count{};
    double sum = 0, partner_sum = 0;  // for the next level
  };
  static std::size_t first_lag(std::size_t level) { return level == 0 ? 0 : kept / block; }

  std::vector<Level> levels_;
};

// Mean squares of the sums of a series over all windows of a length, for lengths from one entry to many, at a
// cost per entry that does not grow.
//
// Level l keeps the last 16 sums up to every 2^l-th entry. It takes windows of 1 ... 15 of its spacings (8
// ... 15 beyond the first level), which begin that far apart: they overlap.
class SquaredSums {
 public:
  explicit SquaredSums(std::size_t levels) : levels_(levels) {}

  void add(double value);

  struct Value {
    std::uint64_t length;  // entries
    double mean_square;    // < (sum over the window)^2 >
  };
  // In order of the lengths; those that were never met are left out.
  std::vector<Value> values() const;
  // The lengths of so many entries in so many levels, in the same order.
  static std::vector<std::uint64_t> lengths(std::size_t levels, std::uint64_t entries);

  void save(ArchiveWriter& archive) const { archive.put_all(sum_, entries_, levels_); }
  void load(ArchiveReader& archive) { archive.get_all(sum_, entries_, levels_); }

 private:
  static constexpr std::size_t kept = 16;
  struct Level {
    std::array<double, kept> last{};  // a ring of sums up to an entry; the first is that of nothing
    std::array<double, kept> squares{};
    std::array<std::uint64_t, kept> count{};
  };
  static std::size_t first_length(std::size_t level) { return level == 0 ? 1 : kept / 2; }

  double sum_ = 0;
  std::uint64_t entries_ = 0;
  std::vector<Level> levels_;
};

}  // namespace peclet::engine
