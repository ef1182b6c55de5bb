// CardNumber is the double with which kernels for cards compute.
//
// Its functions use arithmetic alone, each operation rounded by itself. So a card and its emulation by the
// processor give the same bits.
#pragma once

#include <cstdint>

#include "engine/state/vector3.h"

namespace peclet::engine {

// The result of a comparison, as formulas of lanes combine it.
struct CardMask {
  constexpr CardMask(bool holds) : v(holds) {}   // NOLINT(google-explicit-constructor): a comparison
  constexpr operator bool() const { return v; }  // NOLINT(google-explicit-constructor): a condition

  friend constexpr CardMask operator&(CardMask a, CardMask b) { return a.v && b.v; }

  bool v;
};

struct CardNumber {
  CardNumber() = default;
  constexpr CardNumber(double x) : v(x) {}  // NOLINT(google-explicit-constructor): constants of a formula

  friend CardNumber operator+(CardNumber a, CardNumber b) { return a.v + b.v; }
  friend CardNumber operator-(CardNumber a, CardNumber b) { return a.v - b.v; }
  friend CardNumber operator*(CardNumber a, CardNumber b) { return a.v * b.v; }
  friend CardNumber operator/(CardNumber a, CardNumber b) { return a.v / b.v; }
  friend CardNumber operator-(CardNumber a) { return -a.v; }
  CardNumber& operator+=(CardNumber b) { return v += b.v, *this; }
  CardNumber& operator-=(CardNumber b) { return v -= b.v, *this; }

  friend CardMask operator<(CardNumber a, CardNumber b) { return a.v < b.v; }
  friend CardMask operator<=(CardNumber a, CardNumber b) { return a.v <= b.v; }
  friend CardMask operator>(CardNumber a, CardNumber b) { return a.v > b.v; }
  friend CardMask operator>=(CardNumber a, CardNumber b) { return a.v >= b.v; }

  double v = 0;
};

using CardVector = Vector3Of<CardNumber>;

PECLET_ALWAYS_INLINE CardNumber select(bool condition, CardNumber yes, CardNumber no) {
  return condition ? yes.v : no.v;
}
PECLET_ALWAYS_INLINE CardNumber larger(CardNumber a, CardNumber b) { return a.v < b.v ? b.v : a.v; }
PECLET_ALWAYS_INLINE CardNumber square_root(CardNumber x) { return __builtin_sqrt(x.v); }

// Returns the natural logarithm of a positive normal number, by the polynomial of kernels/lanes.h.
PECLET_ALWAYS_INLINE CardNumber logarithm(CardNumber x) {
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd, mantissa = 0x000fffffffffffff;
  const std::int64_t image = __builtin_bit_cast(std::int64_t, x.v) + (0x3ff0000000000000 - root_half);
  const auto exponent = static_cast<double>((image >> 52) - 1023);
  const double m = __builtin_bit_cast(double, (image & mantissa) + root_half);
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double p = 0.14808478677658146;
  p = p * z + 0.1531264853646304;
  p = p * z + 0.18183626900937036;
  p = p * z + 0.22222197158358406;
  p = p * z + 0.2857142875935839;
  p = p * z + 0.3999999999931189;
  p = p * z + 0.6666666666666761;
  p = p * z + 2.0;
  return exponent * 0.693147180559945309417 + s * p;
}

// Returns e^x, to 2 units in the last place, for |x| < 700; beyond that its value there. e^x = 2^k e^r with
// |r| <= ln 2 / 2, and Taylor's polynomial of degree 13.
PECLET_ALWAYS_INLINE CardNumber exponential(CardNumber x) {
  constexpr double bound = 700, per_binade = 1.44269504088896340736;
  constexpr double high = 0.693147180369123816490, low = 1.90821492927058770002e-10;  // their sum is ln 2
  const double y = x.v < -bound ? -bound : x.v > bound ? bound : x.v;
  const double k = __builtin_floor(y * per_binade + 0.5);
  const double r = (y - k * high) - k * low;
  double p = 1.0 / 6227020800;
  p = p * r + 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  return p * __builtin_bit_cast(double, (static_cast<std::int64_t>(k) + 1023) << 52);
}

}  // namespace peclet::engine
