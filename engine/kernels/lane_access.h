// Reads and writes memory for the loop over pairs: the lanes of an instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/kernels/lanes.h"
#include "engine/kernels/one_lane.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// Returns lanes 4 q to 4 q + 3.
template <class Set>
PECLET_ALWAYS_INLINE __m256d four_lanes(const Lanes<Set>& lanes, [[maybe_unused]] int q) {
#ifdef __AVX512F__
  return q % 2 == 0 ? _mm512_castpd512_pd256(lanes.v) : _mm512_extractf64x4_pd(lanes.v, 1);
#else
  return lanes.v;
#endif
}
template <class Set>
PECLET_ALWAYS_INLINE void set_four_lanes(Lanes<Set>& lanes, [[maybe_unused]] int q, __m256d four) {
#ifdef __AVX512F__
  lanes.v = q % 2 == 0 ? _mm512_insertf64x4(lanes.v, four, 0) : _mm512_insertf64x4(lanes.v, four, 1);
#else
  lanes.v = four;
#endif
}

// Gathers four rows at a time and transposes them in registers.
template <class Set>
PECLET_ALWAYS_INLINE Vector3Of<Lanes<Set>> gather_rows(const double* rows, const std::uint32_t* index,
                                                       const Lanes<Set>& /*number*/) {
  Vector3Of<Lanes<Set>> result;
#pragma GCC unroll 4
  for (int q = 0; q < Lanes<Set>::width / 4; ++q) {
    const std::uint32_t* four = index + std::ptrdiff_t{4} * q;
    const __m256d a = _mm256_load_pd(rows + 4 * std::size_t{four[0]});
    const __m256d b = _mm256_load_pd(rows + 4 * std::size_t{four[1]});
    const __m256d c = _mm256_load_pd(rows + 4 * std::size_t{four[2]});
    const __m256d d = _mm256_load_pd(rows + 4 * std::size_t{four[3]});
    const __m256d ab = _mm256_unpacklo_pd(a, b), cd = _mm256_unpacklo_pd(c, d);
    set_four_lanes(result.x, q, _mm256_permute2f128_pd(ab, cd, 0x20));
    set_four_lanes(result.y, q,
                   _mm256_permute2f128_pd(_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d), 0x20));
    set_four_lanes(result.z, q, _mm256_permute2f128_pd(ab, cd, 0x31));
  }
  return result;
}

template <class Set>
PECLET_ALWAYS_INLINE RowsOf<Lanes<Set>> scattered(const Vector3Of<Lanes<Set>>& v) {
  RowsOf<Lanes<Set>> result;
  const __m256d zero = _mm256_setzero_pd();
#pragma GCC unroll 4
  for (int q = 0; q < Lanes<Set>::width / 4; ++q) {
    const __m256d x = four_lanes(v.x, q), y = four_lanes(v.y, q), z = four_lanes(v.z, q);
    const __m256d xy_even = _mm256_unpacklo_pd(x, y), xy_odd = _mm256_unpackhi_pd(x, y);
    const __m256d z_even = _mm256_unpacklo_pd(z, zero), z_odd = _mm256_unpackhi_pd(z, zero);
    result.row[4 * q] = _mm256_permute2f128_pd(xy_even, z_even, 0x20);
    result.row[4 * q + 1] = _mm256_permute2f128_pd(xy_odd, z_odd, 0x20);
    result.row[4 * q + 2] = _mm256_permute2f128_pd(xy_even, z_even, 0x31);
    result.row[4 * q + 3] = _mm256_permute2f128_pd(xy_odd, z_odd, 0x31);
  }
  return result;
}

template <class Set>
PECLET_ALWAYS_INLINE double sum_of_lanes(const Lanes<Set>& x) {
  double sum = 0;
  for (int k = 0; k < Lanes<Set>::width; ++k) sum += x.v[k];
  return sum;
}

template <class Set>
PECLET_ALWAYS_INLINE double largest_lane(const Lanes<Set>& x) {
  double largest = x.v[0];
  for (int k = 1; k < Lanes<Set>::width; ++k) largest = largest < x.v[k] ? x.v[k] : largest;
  return largest;
}

template <class Set>
PECLET_ALWAYS_INLINE Mask<Set> listed_lanes(int count, const Lanes<Set>& /*number*/) {
  return first_lanes<Set>(count);
}

template <class Set>
PECLET_ALWAYS_INLINE double lane(const Lanes<Set>& x, int lane) {
  return x.v[lane];
}

template <class Set>
PECLET_ALWAYS_INLINE void set_lane(Lanes<Set>& x, int lane, double value) {
  x.v[lane] = value;
}

template <class Set>
PECLET_ALWAYS_INLINE Lanes<Set> load_lanes(const double* values, int count, const Lanes<Set>& /*number*/) {
  Lanes<Set> result;
  if (count == Lanes<Set>::width) {
    __builtin_memcpy(&result.v, values, sizeof result.v);
  } else {
    for (int k = 0; k < count; ++k) result.v[k] = values[k];
  }
  return result;
}

// Writes all lanes in single precision.
template <class Set>
PECLET_ALWAYS_INLINE void store_floats(float* values, const Lanes<Set>& x) {
#ifdef __AVX512F__
  _mm256_storeu_ps(values, _mm512_cvtpd_ps(x.v));
#else
  _mm_storeu_ps(values, _mm256_cvtpd_ps(x.v));
#endif
}

template <class Set>
PECLET_ALWAYS_INLINE void store_lanes(double* values, int count, const Lanes<Set>& x) {
  if (count == Lanes<Set>::width) {
    __builtin_memcpy(values, &x.v, sizeof x.v);
  } else {
    for (int k = 0; k < count; ++k) values[k] = x.v[k];
  }
}

}  // namespace peclet::engine
