#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "engine/pictures/colouring.h"

namespace peclet::engine {
namespace {

std::array<int, 3> shown(const Colour& colour) {
  return {encoded(colour.red), encoded(colour.green), encoded(colour.blue)};
}

// IEC 61966-2-1: 0x808080 emits 0.2159 of white's light; encoding inverts decoding.
TEST(PictureColour, IsLinearInLight) {
  EXPECT_NEAR(colour_of(0x808080).green, 0.2159, 1e-4);
  EXPECT_FLOAT_EQ(colour_of(0xffffff).blue, 1);
  EXPECT_EQ(colour_of(0).red, 0);
  for (std::uint32_t k = 0; k < 256; ++k) EXPECT_EQ(encoded(colour_of(k << 8).green), k);
  EXPECT_EQ(encoded(2), 255);
  EXPECT_EQ(encoded(-1), 0);
}

// Published with matplotlib, _cm_listed.py: colours 1, 103, 128, 200 and 256 of 256,
// (0.267004, 0.004874, 0.329415) ... (0.993248, 0.906157, 0.143936).
TEST(PictureColour, OfViridisIsThePublishedOne) {
  const std::array<std::pair<int, std::array<double, 3>>, 5> published = {
      {{0, {0.267004, 0.004874, 0.329415}},
       {102, {0.163625, 0.471133, 0.558148}},
       {127, {0.128729, 0.563265, 0.551229}},
       {199, {0.430983, 0.808473, 0.346476}},
       {255, {0.993248, 0.906157, 0.143936}}}};
  for (const auto& [number, rgb] : published) {
    const std::array<int, 3> colour = shown(viridis(number / 255.0));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(colour[k], 255 * rgb[k], 1.5) << number << ' ' << k;
  }
  EXPECT_EQ(shown(viridis(-5)), shown(viridis(0)));
  EXPECT_EQ(shown(viridis(9)), shown(viridis(1)));
}

Snapshot of_sizes(std::size_t sizes) {
  Snapshot made;
  for (std::size_t s = 0; s < sizes; ++s) {
    made.position.push_back({});
    made.radius.push_back(1 + 0.1 * static_cast<double>(s));
    made.species.push_back(static_cast<std::uint32_t>(s));
    made.species_names.push_back(std::string(1, static_cast<char>('A' + s)));
  }
  return made;
}

// Up to eight sizes get separate colours. More sizes lie on a scale of radii from the smallest to the
// largest, all with distinct colours.
TEST(PictureColour, OfSpeciesIsNoOtherOnesColour) {
  for (const std::size_t sizes : {1U, 8U, 9U, 14U}) {
    const Colouring all = colouring_of(of_sizes(sizes), "species", "x.gsd");
    std::set<std::array<int, 3>> colours;
    for (const Colour& colour : all.of_spheres) colours.insert(shown(colour));
    EXPECT_EQ(colours.size(), sizes);
    EXPECT_EQ(all.names.size(), sizes <= 8 ? sizes : 0);
    ASSERT_EQ(all.scale.size(), sizes <= 8 ? 0U : 1U);
    if (sizes <= 8) continue;
    EXPECT_EQ(all.scale[0].title, "radius");
    EXPECT_EQ(all.scale[0].low, 1);
    EXPECT_NEAR(all.scale[0].high, 1 + 0.1 * static_cast<double>(sizes - 1), 1e-12);
    EXPECT_EQ(shown(all.of_spheres.front()), shown(viridis(0)));
    EXPECT_EQ(shown(all.of_spheres.back()), shown(viridis(1)));
  }
}

TEST(PictureColour, OfAScaleLeavesOutliersAside) {
  std::vector<double> values = {-1e9, 1e9};
  for (int k = 0; k <= 198; ++k) values.push_back(k);
  const ColourScale scale = scale_over("x", values);
  EXPECT_NEAR(scale.low, 2, 1.5);
  EXPECT_NEAR(scale.high, 194, 1.5);
  const ColourScale level = scale_over("x", {3, 3, 3});
  EXPECT_LT(level.low, level.high);
  const ColourScale nought = scale_over("x", {0});
  EXPECT_LT(nought.low, nought.high);
}

TEST(PictureColour, OfAScaleHasRoundTicksWithinIt) {
  const auto ticks = [](double low, double high) { return ticks_of({"x", low, high}); };
  EXPECT_EQ(ticks(0, 4), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(ticks(-30, 70), (std::vector<double>{-20, 0, 20, 40, 60}));
  EXPECT_EQ(ticks(0, 1), (std::vector<double>{0, 0.2, 0.4, 3 * 0.2, 0.8, 1}));
  for (const double high : {1e-12, 0.013, 0.7, 5.3, 9.99, 123456.0}) {
    EXPECT_GE(ticks(0, high).size(), 3U) << high;
    EXPECT_LE(ticks(0, high).size(), 8U) << high;
  }
}

}  // namespace
}  // namespace peclet::engine
