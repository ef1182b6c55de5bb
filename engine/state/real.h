// The functions of a double that pair formulas need besides arithmetic.
//
// Pair formulas are templates on the number: `double`, or the Lanes of an instruction set, which hold several
// pairs side by side and have functions of the same names (kernels/lanes.h). A comparison gives bool or a
// mask.
#pragma once

#include <cmath>

// Everything in the loop over pairs is inlined: calls would pass lanes through memory.
#define PECLET_ALWAYS_INLINE [[gnu::always_inline]] inline
#define PECLET_INLINE_LAMBDA __attribute__((always_inline))

// Unrolls a loop in programs for cards, whose compiler would index arrays in memory otherwise.
#ifdef __CUDA__
#define PECLET_UNROLL _Pragma("unroll")
#else
#define PECLET_UNROLL
#endif

namespace peclet::engine {

inline bool any(bool condition) { return condition; }
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline double larger(double a, double b) { return a < b ? b : a; }
inline double square_root(double x) { return std::sqrt(x); }
inline double logarithm(double x) { return std::log(x); }
inline double exponential(double x) { return std::exp(x); }

// A vector in memory: four doubles, the fourth always zero.
typedef double Row __attribute__((vector_size(32)));

}  // namespace peclet::engine
