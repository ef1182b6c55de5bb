// Mean squares of the sums of a series over all windows of a length, for lengths from one entry to many, at a
// cost per entry that does not grow.
//
// Level l keeps the last 16 sums up to every 2^l-th entry. It takes windows of 1 ... 15 of its spacings (8
// ... 15 beyond the first level), which begin that far apart: they overlap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/archive.h"

namespace peclet::engine {

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
