// What the formulas of a pair need of a number besides arithmetic, for a single double.
//
// The terms are templates on the number: `double`, or the Lanes of an instruction set, which hold several
// pairs side by side and bring functions of the same names (kernels/lanes.h). A comparison gives bool or a
// mask.
#pragma once

#include <cmath>

// The loop over pairs is one function with everything in it, or its lanes would travel through memory.
#define PECLET_ALWAYS_INLINE [[gnu::always_inline]] inline
#define PECLET_INLINE_LAMBDA __attribute__((always_inline))

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
