#include "tests/physics/reference_resistance.h"

#include <gtest/gtest.h>

#include "tests/engine/two_spheres.h"

namespace peclet::engine {
namespace {

TEST(ReferenceResistance, IsThatOfTheEngineForEverySizeRatioAndGap) {
  constexpr double viscosity = 0.7, radius = 0.8;
  Draws draws(17);
  for (const double ratio : size_ratios) {
    for (const double gap : gaps) {
      const PairGeometry pair = pair_at(radius, ratio * radius, gap, draws.direction());
      const Matrix12 found = grand_resistance(resistance_of(viscosity, radius, ratio * radius, pair), pair);
      const Matrix12 expected =
          reference_resistance(viscosity, radius, ratio * radius, pair.separation, inner_gap);
      // Forces, couplings and torques differ in size, so each block is compared by itself.
      for (const int row : {0, 6}) {
        for (const int column : {0, 6}) {
          const auto block = expected.block<6, 6>(row, column);
          EXPECT_LT(largest_entry(found.block<6, 6>(row, column) - block), 1e-12 * largest_entry(block))
              << ratio << ' ' << gap << ' ' << row << ' ' << column;
        }
      }
    }
  }
}

}  // namespace
}  // namespace peclet::engine
