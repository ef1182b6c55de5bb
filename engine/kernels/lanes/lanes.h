// Several doubles side by side, one for each of as many pairs: the number that the vectorised kernels compute
// with.
//
// Set names an instruction set: its width, and in its type a mark that keeps code compiled for one set apart
// from code for another. Arithmetic is the compiler's vector extension.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "engine/state/vector3.h"

namespace peclet::engine {

namespace {
// The set that this file is compiled for. Its name is this file's alone, and so is all code made of it.
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

  Integers m;  // all bits of a lane, or none
};

// The first `count` lanes.
template <class Set>
Mask<Set> first_lanes(int count) {
  typename Mask<Set>::Integers numbers;
  for (int k = 0; k < Set::width; ++k) {
    numbers[k] = k;
  }
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

// Bit k is lane k.
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
