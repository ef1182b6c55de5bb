// Gathers rows of particles into numbers of eight links side by side, and adds such numbers to rows.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/kernels/link_kernels.h"
#include "engine/state/vector3.h"

#ifdef __AVX2__
#include <immintrin.h>

#include <cstddef>
#endif

namespace peclet::engine {
namespace {

// The place in a row of each of the six components.
constexpr int place_of[6] = {0, 1, 2, 4, 5, 6};

// One number of each of eight links, as pair formulas take it (state/real.h).
struct EightFloats {
  EightFloats() = default;
  EightFloats(const Floats& floats) : v(floats) {}  // NOLINT(google-explicit-constructor): the same numbers

  friend EightFloats operator+(const EightFloats& a, const EightFloats& b) { return a.v + b.v; }
  friend EightFloats operator-(const EightFloats& a, const EightFloats& b) { return a.v - b.v; }
  friend EightFloats operator*(const EightFloats& a, const EightFloats& b) { return a.v * b.v; }
  friend EightFloats operator-(const EightFloats& a) { return -a.v; }

  Floats v{};
};

struct FloatMotions {
  Vector3Of<EightFloats> velocity, spin;
};

#ifdef __AVX2__
// Gathers the motions of eight particles. Transposes four rows at a time in both halves (velocity, spin),
// then exchanges halves.
PECLET_ALWAYS_INLINE FloatMotions gather_motions(const MotionRow* rows, const std::uint32_t* index) {
  __m256 part[2][3];
  for (int q = 0; q < 2; ++q) {
    const std::uint32_t* const four = index + std::ptrdiff_t{4} * q;
    const __m256 a = rows[four[0]].v, b = rows[four[1]].v, c = rows[four[2]].v, d = rows[four[3]].v;
    const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
    part[q][0] = _mm256_shuffle_ps(ab, cd, 0x44);
    part[q][1] = _mm256_shuffle_ps(ab, cd, 0xee);
    part[q][2] = _mm256_shuffle_ps(_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d), 0x44);
  }
  const auto velocity = [&](int c) { return Floats(_mm256_permute2f128_ps(part[0][c], part[1][c], 0x20)); };
  const auto spin = [&](int c) { return Floats(_mm256_permute2f128_ps(part[0][c], part[1][c], 0x31)); };
  return {{velocity(0), velocity(1), velocity(2)}, {spin(0), spin(1), spin(2)}};
}

// Adds motions to the rows of eight particles, one after the other.
PECLET_ALWAYS_INLINE void add_motions(MotionRow* rows, const std::uint32_t* index, const FloatMotions& add) {
  const __m256 zero = _mm256_setzero_ps();
  for (int q = 0; q < 2; ++q) {
    const auto half = [&](const EightFloats& velocity, const EightFloats& spin) {
      return q == 0 ? _mm256_permute2f128_ps(velocity.v, spin.v, 0x20)
                    : _mm256_permute2f128_ps(velocity.v, spin.v, 0x31);
    };
    const __m256 x = half(add.velocity.x, add.spin.x), y = half(add.velocity.y, add.spin.y),
                 z = half(add.velocity.z, add.spin.z);
    const __m256 xy = _mm256_unpacklo_ps(x, y), z0 = _mm256_unpacklo_ps(z, zero);
    const __m256 xy_high = _mm256_unpackhi_ps(x, y), z0_high = _mm256_unpackhi_ps(z, zero);
    const std::uint32_t* const four = index + std::ptrdiff_t{4} * q;
    rows[four[0]].v += _mm256_shuffle_ps(xy, z0, 0x44);
    rows[four[1]].v += _mm256_shuffle_ps(xy, z0, 0xee);
    rows[four[2]].v += _mm256_shuffle_ps(xy_high, z0_high, 0x44);
    rows[four[3]].v += _mm256_shuffle_ps(xy_high, z0_high, 0xee);
  }
}
#else
FloatMotions gather_motions(const MotionRow* rows, const std::uint32_t* index) {
  FloatMotions result;
  EightFloats* const parts[6] = {&result.velocity.x, &result.velocity.y, &result.velocity.z,
                                 &result.spin.x,     &result.spin.y,     &result.spin.z};
  for (int k = 0; k < links_per_group; ++k) {
    for (int c = 0; c < 6; ++c) {
      parts[c]->v[k] = rows[index[k]].v[c + c / 3];
    }
  }
  return result;
}

void add_motions(MotionRow* rows, const std::uint32_t* index, const FloatMotions& add) {
  const EightFloats* const parts[6] = {&add.velocity.x, &add.velocity.y, &add.velocity.z,
                                       &add.spin.x,     &add.spin.y,     &add.spin.z};
  for (int k = 0; k < links_per_group; ++k) {
    for (int c = 0; c < 6; ++c) {
      rows[index[k]].v[c + c / 3] += parts[c]->v[k];
    }
  }
}
#endif

}  // namespace
}  // namespace peclet::engine
