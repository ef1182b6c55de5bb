// Box-Muller: two standard normals from two 32-bit uniforms, in single precision.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace peclet::engine {

struct TwoNormals {
  double a, b;
};

// The uniform of the radius lies in (0, 1] so that its logarithm is finite: the radius is at most 6.8.
inline TwoNormals box_muller(std::uint32_t bits_radius, std::uint32_t bits_angle) {
  constexpr float unit = 0x1p-32F;
  const float u = (static_cast<float>(bits_radius) + 0.5F) * unit;
  const float radius = std::sqrt(-2.0F * std::log(u < 1.0F ? u : 1.0F));
  const float angle =
      static_cast<float>(static_cast<std::int32_t>(bits_angle)) * (2.0F * unit * std::numbers::pi_v<float>);
  return {static_cast<double>(radius * std::cos(angle)), static_cast<double>(radius * std::sin(angle))};
}

}  // namespace peclet::engine
