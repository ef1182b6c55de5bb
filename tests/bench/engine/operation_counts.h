// Counts of floating-point operations.
#pragma once

#include <cstdint>

namespace peclet::engine {

struct Operations {
  std::uint64_t sums = 0, products = 0, quotients = 0, roots = 0, logarithms = 0, exponentials = 0;

  friend Operations operator-(const Operations& a, const Operations& b) {
    return {a.sums - b.sums,   a.products - b.products,     a.quotients - b.quotients,
            a.roots - b.roots, a.logarithms - b.logarithms, a.exponentials - b.exponentials};
  }
  friend bool operator==(const Operations&, const Operations&) = default;
};

}  // namespace peclet::engine
