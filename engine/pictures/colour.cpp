#include "engine/pictures/colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace peclet::engine {
namespace {

// Every fifth of its 256 colours.
constexpr std::array<std::uint32_t, 52> viridis_table = {
    0x440154, 0x46085c, 0x471063, 0x481769, 0x481d6f, 0x482475, 0x472a7a, 0x46307e, 0x453781,
    0x433d84, 0x414287, 0x3f4889, 0x3d4e8a, 0x3a538b, 0x38598c, 0x355e8d, 0x33638d, 0x31688e,
    0x2e6d8e, 0x2c718e, 0x2a768e, 0x297b8e, 0x27808e, 0x25848e, 0x23898e, 0x218e8d, 0x20928c,
    0x1f978b, 0x1e9c89, 0x1fa188, 0x21a585, 0x24aa83, 0x28ae80, 0x2eb37c, 0x35b779, 0x3dbc74,
    0x46c06f, 0x50c46a, 0x5ac864, 0x65cb5e, 0x70cf57, 0x7cd250, 0x89d548, 0x95d840, 0xa2da37,
    0xb0dd2f, 0xbddf26, 0xcae11f, 0xd8e219, 0xe5e419, 0xf1e51d, 0xfde725,
};

// The scheme "light".
constexpr std::array<std::uint32_t, count_of_species_colours> species_table = {
    0x77aadd, 0xee8866, 0xeedd88, 0x44bb99, 0xffaabb, 0x99ddff, 0xbbcc33, 0xaaaa00};

}  // namespace

float linear_of(double encoded) {
  return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

Colour colour_of(std::uint32_t rgb) {
  const auto part = [rgb](int shift) { return linear_of(((rgb >> shift) & 0xff) / 255.0); };
  return {part(16), part(8), part(0)};
}

std::uint8_t encoded(float linear) {
  // So fine that the darkest steps, a 3295th of white, are told apart.
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> all(65536);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double x = static_cast<double>(k) / 65535;
      all[k] = static_cast<std::uint8_t>(
          std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
    }
    return all;
  }();
  return table[static_cast<std::size_t>(std::lround(65535 * std::clamp(linear, 0.0F, 1.0F)))];
}

Colour viridis(double place) {
  const double at = std::clamp(place, 0.0, 1.0) * (viridis_table.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), viridis_table.size() - 2);
  const double share = at - static_cast<double>(below);
  const auto part = [&](int shift) {
    const double low = (viridis_table[below] >> shift) & 0xff,
                 high = (viridis_table[below + 1] >> shift) & 0xff;
    return linear_of((low + share * (high - low)) / 255);
  };
  return {part(16), part(8), part(0)};
}

Colour colour_of_species(std::size_t species) { return colour_of(species_table.at(species)); }

}  // namespace peclet::engine
