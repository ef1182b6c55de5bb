// The variance of velocities about their mean, by y.
#include "engine/observables/velocity_variance.h"

#include <gtest/gtest.h>

#include "tests/engine/draws.h"

namespace peclet::engine {
namespace {

// Slabs are a fifth wide: shear shifts their means and hardly changes the variance.
TEST(VelocityVariance, IsThatOfEachBinWithoutTheMeanFlow) {
  constexpr std::size_t bins = 3;
  VelocityVariance variance(12, 1, bins);  // bins 4 wide
  Draws draws(1);
  const double wanted[] = {1.0, 4.0, 0.25};
  for (int k = 0; k < 60000; ++k) {
    const double y = draws.uniform(0, 12), spread = std::sqrt(12 * wanted[static_cast<std::size_t>(y / 4)]);
    const auto scatter = [&] { return spread * draws.uniform(-0.5, 0.5); };
    variance.add({0, y - 12, 0}, {10 * std::sin(y) + scatter(), 3 + scatter(), 0});
  }
  const Json found = variance.value();
  for (std::size_t bin = 0; bin < bins; ++bin) {
    // Within a slab the flow 10 sin y varies by at most 2, a variance of at most 1/3.
    EXPECT_NEAR(found[1][bin].get<double>(), wanted[bin], 0.05 * wanted[bin]) << bin;
    EXPECT_GE(found[0][bin].get<double>(), 0.95 * wanted[bin]) << bin;
    EXPECT_LE(found[0][bin].get<double>(), 1.05 * wanted[bin] + 1.0 / 3) << bin;
    EXPECT_EQ(found[2][bin], 0) << bin;
  }
}

// Two samples of each slab, 1 and 3: the variance is 2, not the mean squared deviation from their mean, 1.
TEST(VelocityVariance, HasNoBiasOfFewSamples) {
  VelocityVariance variance(2, 1, 1);
  for (int slab = 0; slab < 10; ++slab) {
    for (const double u : {1.0, 3.0}) variance.add({0, 0.2 * slab + 0.1, 0}, {u + 100 * slab, 0, 0});
  }
  EXPECT_NEAR(variance.value()[0][0].get<double>(), 2, 1e-9);
}

TEST(VelocityVariance, OfABinThatNoSlabKnowsIsNull) {
  VelocityVariance variance(4, 1, 2);
  variance.add({0, 0.1, 0}, {1, 0, 0});
  variance.add({0, 0.1, 0}, {1, 0, 0});
  variance.add({0, 2.1, 0}, {1, 0, 0});
  EXPECT_EQ(variance.value()[0], (Json{0.0, nullptr}));
}

}  // namespace
}  // namespace peclet::engine
