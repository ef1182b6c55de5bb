// Logarithm and exponential of lanes.
#pragma once

#include "engine/kernels/lanes/lanes.h"

// Names of the vector ABI. NOLINTBEGIN(bugprone-reserved-identifier)
#ifdef __AVX512F__
extern "C" __m512d _ZGVeN8v_exp(__m512d);
#else
extern "C" __m256d _ZGVdN4v_exp(__m256d);
#endif
// NOLINTEND(bugprone-reserved-identifier)

namespace peclet::engine {

// Natural logarithm of positive normal numbers, to 2 units in the last place. x = 2^e m with m in [sqrt(1/2),
// sqrt(2)), ln m = 2 artanh(s) with s = (m - 1)/(m + 1), |s| < 0.172. The polynomial in s^2 interpolates at
// Chebyshev's points (relative error 2e-18).
// (glibc's vector logarithm is a call in the middle of the loop, with everything else on the stack.)
template <class Set>
PECLET_ALWAYS_INLINE Lanes<Set> logarithm(const Lanes<Set>& x) {
  using Integers = typename Lanes<Set>::Integers;
  using Vector = typename Lanes<Set>::Vector;
  typedef std::uint64_t Unsigned __attribute__((vector_size(sizeof(Vector))));
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd, mantissa = 0x000fffffffffffff;
  constexpr std::int64_t two_to_52 = 0x4330000000000000;
  // Moves the interval's lower end to a power of two: the exponent field is then e + 1023.
  const Integers image = reinterpret_cast<Integers>(x.v) + (0x3ff0000000000000 - root_half);
  // As a number behind the point of 2^52: the way from integers to doubles that every processor has.
  const auto field = reinterpret_cast<Integers>(reinterpret_cast<Unsigned>(image) >> 52) | two_to_52;
  const Lanes<Set> exponent(reinterpret_cast<Vector>(field) - (0x1p52 + 1023));
  const Lanes<Set> m(reinterpret_cast<Vector>((image & mantissa) + root_half));
  const Lanes<Set> s = (m - 1.0) / (m + 1.0), z = s * s;
  Lanes<Set> p = 0.14808478677658146;
  p = p * z + 0.1531264853646304;
  p = p * z + 0.18183626900937036;
  p = p * z + 0.22222197158358406;
  p = p * z + 0.2857142875935839;
  p = p * z + 0.3999999999931189;
  p = p * z + 0.6666666666666761;
  p = p * z + 2.0;
  return exponent * 0.693147180559945309417 + s * p;
}

// By glibc's libmvec (part of libm), at most 4 units in the last place.
template <class Set>
PECLET_ALWAYS_INLINE Lanes<Set> exponential(const Lanes<Set>& x) {
#ifdef __AVX512F__
  return Lanes<Set>(_ZGVeN8v_exp(x.v));
#else
  return Lanes<Set>(_ZGVdN4v_exp(x.v));
#endif
}

}  // namespace peclet::engine
