// Loops that do nothing but one kind of arithmetic, as fast as an instruction set can.
//
// Plain data, because this is shared with files that are compiled for one processor only.
#pragma once

#include <cstdint>

#include "engine/kernels/lanes/single_access.h"

namespace peclet::engine {

// Each does `rounds` rounds of `per_round` operations on as many numbers; returns a number that depends on
// all of them.
struct PeakLoops {
  using Loop = double (*)(std::uint64_t rounds);
  Loop multiply_add, divide, square_root;
  std::uint64_t per_round;
};

extern const PeakLoops baseline_peak_loops;
extern const PeakLoops avx2_peak_loops;
extern const PeakLoops avx512_peak_loops;

// Enough independent chains to hide the latency of one operation.
constexpr int chains = 12;

template <class Real, class Operation>
double run_chains(std::uint64_t rounds, const Operation& operation) {
  Real x[chains];
  for (int k = 0; k < chains; ++k) {
    x[k] = Real{1.0 + 0.01 * k};
  }
  for (std::uint64_t r = 0; r < rounds; ++r) {
    for (Real& each : x) {
      each = operation(each);
    }
  }
  double sum = 0;
  for (const Real& each : x) {
    sum += sum_of_lanes(each);
  }
  return sum;
}

template <class Real>
double multiply_add_loop(std::uint64_t rounds) {
  const Real a{0.999}, b{0.001};
  return run_chains<Real>(rounds, [&](const Real& x) { return x * a + b; });
}
template <class Real>
double divide_loop(std::uint64_t rounds) {
  const Real a{1.1};
  return run_chains<Real>(rounds, [&](const Real& x) { return a / x; });
}
template <class Real>
double square_root_loop(std::uint64_t rounds) {
  return run_chains<Real>(rounds, [&](const Real& x) { return square_root(x); });
}

template <class Real>
constexpr PeakLoops peak_loops_of() {
  return {&multiply_add_loop<Real>, &divide_loop<Real>, &square_root_loop<Real>,
          std::uint64_t{chains} * width_of<Real>};
}

}  // namespace peclet::engine
