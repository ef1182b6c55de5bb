// fill_block() is the body of fill_normals(), compiled once for each instruction set.
//
// The compiler turns its loops over eight identities into vectors. Everything is static, because code that is
// compiled for one processor must not be linked into a program for another.
#pragma once

#include <Random123/threefry.h>

#include <cstdint>

#include "engine/terms/normal_block.h"

namespace peclet::engine {
namespace {

template <int width>
inline void draw_words(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                       std::uint64_t (&low)[width], std::uint64_t (&high)[width]) {
  for (int k = 0; k < width; ++k) {
    const threefry2x64_ctr_t counter = {{key.step, identity[k]}};
    const threefry2x64_key_t threefry_key = {{key.seed, key.purpose << 60 ^ image[k]}};
    const threefry2x64_ctr_t words = threefry2x64_R(20, counter, threefry_key);
    low[k] = words.v[0];
    high[k] = words.v[1];
  }
}

// Returns ln(u) for u = (bits + 1/2) / 2^21, by ln u = e ln 2 + ln(1 + t) with |t| < 0.42 and ln(1 + t) = t -
// t^2/2 + t^3 P(t). P is the polynomial of degree 6 with the smallest maximum error on that interval (3e-8 of
// the logarithm), fitted by weighted least squares.
inline float logarithm_of_uniform(std::uint32_t bits) {
  const float u = (static_cast<float>(static_cast<std::int32_t>(bits)) + 0.5F) * 0x1p-21F;
  const std::int32_t image = __builtin_bit_cast(std::int32_t, u);
  // Splits off a power of two; the rest lies in [sqrt(1/2), sqrt(2)).
  const std::int32_t power = (image - 0x3f3504f3) >> 23;
  const float t = __builtin_bit_cast(float, image - power * 0x800000) - 1.0F;
  float p = 0.08700361F;
  p = p * t - 0.14267476F;
  p = p * t + 0.14914787F;
  p = p * t - 0.16577587F;
  p = p * t + 0.19963062F;
  p = p * t - 0.25001338F;
  p = p * t + 0.3333391F;
  const float square = t * t;
  return static_cast<float>(power) * 0.6931472F + (t - 0.5F * square + square * t * p);
}

// Computes cosine and sine of 2 pi bits / 2^21. The angle is a whole number of quarter turns plus r turns,
// |r| <= 1/8. The polynomials in r^2 are fitted like P (errors 3e-9 and 3e-8).
inline void circle(std::uint32_t bits, float& cosine, float& sine) {
  const std::uint32_t angle = bits << 11;  // 2^32 is a turn
  const std::uint32_t quarters = (angle + 0x20000000U) >> 30;
  const float r = static_cast<float>(static_cast<std::int32_t>(angle - (quarters << 30))) * 0x1p-32F;
  const float z = r * r;
  float s = -75.40207F;
  s = s * z + 81.59255F;
  s = s * z - 41.341663F;
  s = (s * z + 6.2831855F) * r;
  float c = -83.59261F;
  c = c * z + 64.92125F;
  c = c * z - 19.739153F;
  c = c * z + 1.0F;
  const bool swap = (quarters & 1U) != 0;
  const float x = swap ? s : c, y = swap ? c : s;
  // Gives each half of the circle its sign.
  cosine = ((quarters + 1U) & 2U) != 0 ? -x : x;
  sine = (quarters & 2U) != 0 ? -y : y;
}

template <int width>
inline void box_muller(const std::uint32_t (&radius_bits)[width], const std::uint32_t (&angle_bits)[width],
                       float* first, float* second) {
  for (int k = 0; k < width; ++k) {
    const float radius = __builtin_sqrtf(-2.0F * logarithm_of_uniform(radius_bits[k]));
    float cosine = 0, sine = 0;
    circle(angle_bits[k], cosine, sine);
    first[k] = radius * cosine;
    second[k] = radius * sine;
  }
}

// Splits words into uniforms, bits 0-20, 21-41 and 42-62. Only loops over one width of number become vectors.
template <int width>
inline void split_words(const std::uint64_t (&words)[width], std::uint32_t (&uniform)[3][width]) {
  for (int j = 0; j < 3; ++j) {
    std::uint64_t shifted[width];
    for (int k = 0; k < width; ++k) shifted[k] = words[k] >> (21 * j);
    for (int k = 0; k < width; ++k) uniform[j][k] = static_cast<std::uint32_t>(shifted[k]) & 0x1fffffU;
  }
}

template <int width>
inline void fill_whole(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                       NormalBlockOf<width>& block) {
  static constexpr std::uint64_t no_image[width] = {};
  std::uint64_t low[width], high[width];
  draw_words(key, identity, image != nullptr ? image : no_image, low, high);
  std::uint32_t radius_bits[3][width], angle_bits[3][width];
  split_words(low, radius_bits);
  split_words(high, angle_bits);
  for (std::size_t j = 0; j < 3; ++j) {
    box_muller(radius_bits[j], angle_bits[j], block.value[2 * j], block.value[2 * j + 1]);
  }
}

// Turns the normals of a whole step into those of a part.
template <int width>
[[gnu::noinline]] inline void refine(const NoiseKey& key, const std::uint64_t* identity,
                                     const std::uint64_t* image, NormalBlockOf<width>& block) {
  int divisions = 0;
  while (key.part >> (divisions + 1) != 0) ++divisions;
  while (divisions > 0) {
    const std::uint64_t whole = key.part >> divisions;
    --divisions;
    const float sign = (key.part >> divisions & 1U) == 0 ? 1.0F : -1.0F;
    // The part fits above the step, because no run has 2^48 steps.
    const NoiseKey of_whole = {key.seed, key.purpose, key.step ^ whole << 48};
    NormalBlockOf<width> other;
    fill_whole(of_whole, identity, image, other);
    for (int c = 0; c < 6; ++c) {
      for (int k = 0; k < width; ++k) {
        block.value[c][k] = 0.70710678F * (block.value[c][k] + sign * other.value[c][k]);
      }
    }
  }
}

template <int width>
inline void fill_block(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                       NormalBlockOf<width>& block) {
  fill_whole(key, identity, image, block);
  if (key.part != 1) [[unlikely]] {
    refine(key, identity, image, block);
  }
}

}  // namespace
}  // namespace peclet::engine
