// Several doubles side by side, one for each pair: the number that vectorised kernels compute with.
//
// `Set` is an instruction set. It gives the width, and its type keeps code compiled for one set apart from
// code for another. Arithmetic is the compiler's vector extension. Only files with kernels for a newer x86-64
// include this header.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "engine/state/real.h"

namespace peclet::engine {
namespace {
// The set that this file is compiled for. It is local to the file, and so is all code instantiated with it.
struct CompiledSet {
#ifdef __AVX512F__
  static constexpr int width = 8;
#else
  static constexpr int width = 4;
#endif
};
}  // namespace

template <class Set>
class Mask;

template <class Set>
class Lanes {
 public:
  static constexpr int width = Set::width;
  typedef double Vector __attribute__((vector_size(8 * width)));
  typedef std::int64_t Integers __attribute__((vector_size(8 * width)));

  Lanes() = default;
  Lanes(double x) : v(x - Vector{}) {}  // NOLINT(google-explicit-constructor): constants of a formula
  explicit Lanes(const Vector& vector) : v(vector) {}

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.v + b.v); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.v - b.v); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.v * b.v); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.v / b.v); }
  friend Lanes operator-(const Lanes& a) { return Lanes(-a.v); }
  Lanes& operator+=(const Lanes& b) { return v += b.v, *this; }
  Lanes& operator-=(const Lanes& b) { return v -= b.v, *this; }

  friend Mask<Set> operator<(const Lanes& a, const Lanes& b) { return Mask<Set>(a.v < b.v); }
  friend Mask<Set> operator<=(const Lanes& a, const Lanes& b) { return Mask<Set>(a.v <= b.v); }
  friend Mask<Set> operator>(const Lanes& a, const Lanes& b) { return Mask<Set>(a.v > b.v); }

  Vector v{};
};

template <class Set>
class Mask {
 public:
  using Integers = typename Lanes<Set>::Integers;
  explicit Mask(const Integers& vector) : m(vector) {}

  friend Mask operator&(const Mask& a, const Mask& b) { return Mask(a.m & b.m); }
  friend Mask operator!(const Mask& a) { return Mask(~a.m); }

  Integers m;  // all bits of a lane set or cleared
};

// Returns the mask of the first `count` lanes.
template <class Set>
Mask<Set> first_lanes(int count) {
  typename Mask<Set>::Integers numbers;
  for (int k = 0; k < Set::width; ++k) numbers[k] = k;
  return Mask<Set>(numbers < static_cast<std::int64_t>(count));
}

template <class Set>
Lanes<Set> select(const Mask<Set>& condition, const Lanes<Set>& yes, const Lanes<Set>& no) {
  return Lanes<Set>(condition.m ? yes.v : no.v);
}

template <class Set>
Lanes<Set> larger(const Lanes<Set>& a, const Lanes<Set>& b) {
  return Lanes<Set>(a.v < b.v ? b.v : a.v);
}

// Returns the mask as bits: bit k for lane k.
template <class Set>
unsigned bits(const Mask<Set>& mask) {
#ifdef __AVX512DQ__
  return _mm512_movepi64_mask(reinterpret_cast<const __m512i&>(mask.m));
#else
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<const __m256d&>(mask.m)));
#endif
}

template <class Set>
bool any(const Mask<Set>& mask) {
  return bits(mask) != 0;
}

template <class Set>
Lanes<Set> square_root(const Lanes<Set>& x) {
#ifdef __AVX512F__
  return Lanes<Set>(_mm512_sqrt_pd(x.v));
#else
  return Lanes<Set>(_mm256_sqrt_pd(x.v));
#endif
}

}  // namespace peclet::engine

// Names of the vector ABI. NOLINTBEGIN(bugprone-reserved-identifier)
#ifdef __AVX512F__
extern "C" __m512d _ZGVeN8v_exp(__m512d);
#else
extern "C" __m256d _ZGVdN4v_exp(__m256d);
#endif
// NOLINTEND(bugprone-reserved-identifier)

namespace peclet::engine {

// Returns the natural logarithm of positive normal numbers, to 2 units in the last place:
//   x = 2^e m,   ln m = 2 artanh(s),   s = (m - 1)/(m + 1)
// with m in [sqrt(1/2), sqrt(2)), |s| < 0.172, and a polynomial in s^2 through Chebyshev points (relative
// error 2e-18). A call of glibc's vector logarithm would put all other lanes on the stack.
template <class Set>
PECLET_ALWAYS_INLINE Lanes<Set> logarithm(const Lanes<Set>& x) {
  using Integers = typename Lanes<Set>::Integers;
  using Vector = typename Lanes<Set>::Vector;
  typedef std::uint64_t Unsigned __attribute__((vector_size(sizeof(Vector))));
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd, mantissa = 0x000fffffffffffff;
  constexpr std::int64_t two_to_52 = 0x4330000000000000;
  // Moves the interval's lower end to a power of two: the exponent field is then e + 1023.
  const Integers image = reinterpret_cast<Integers>(x.v) + (0x3ff0000000000000 - root_half);
  // Written into the mantissa of 2^52, an integer becomes a double on every processor.
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

// Returns e^x by glibc's libmvec (part of libm), with an error of at most 4 units in the last place.
template <class Set>
PECLET_ALWAYS_INLINE Lanes<Set> exponential(const Lanes<Set>& x) {
#ifdef __AVX512F__
  return Lanes<Set>(_ZGVeN8v_exp(x.v));
#else
  return Lanes<Set>(_ZGVdN4v_exp(x.v));
#endif
}

}  // namespace peclet::engine
