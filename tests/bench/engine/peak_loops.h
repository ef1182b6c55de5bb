// Loops of a single kind of arithmetic at the peak rate of an instruction set.
//
// Plain data, because files compiled for one processor include this header.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/kernels/one_lane.h"

namespace peclet::engine {

// Each loop does `rounds` rounds of `per_round` operations on independent numbers. It returns a number that
// depends on all of them.
struct PeakLoops {
  using Loop = double (*)(std::uint64_t rounds);
  Loop multiply_add, divide, square_root;
  std::uint64_t per_round;
  Loop multiply_add_single;  // in single precision
  std::uint64_t singles_per_round;
  // a = b + s c; rows are a whole number of cache lines.
  void (*stream)(double* a, const double* b, const double* c, double s, std::size_t count);
};

extern const PeakLoops baseline_peak_loops;
extern const PeakLoops avx2_peak_loops;
extern const PeakLoops avx512_peak_loops;

// Enough independent chains to hide the latency of one operation.
constexpr int chains = 12;

template <class Real, class Operation>
double run_chains(std::uint64_t rounds, const Operation& operation) {
  Real x[chains];
  for (int k = 0; k < chains; ++k) x[k] = Real{1.0 + 0.01 * k};
  for (std::uint64_t r = 0; r < rounds; ++r) {
    for (Real& each : x) each = operation(each);
  }
  double sum = 0;
  for (const Real& each : x) sum += sum_of_lanes(each);
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

// A vector of single-precision numbers. Real names the set and keeps code of sets apart.
template <class Real, int width>
struct Singles {
  typedef float Vector __attribute__((vector_size(4 * width)));

  Singles() = default;
  explicit Singles(double x) : v(Vector{} + static_cast<float>(x)) {}
  Singles& operator+=(const Singles& b) { return v += b.v, *this; }
  Singles& operator*=(const Singles& b) { return v *= b.v, *this; }
  friend Singles operator+(Singles a, const Singles& b) { return a += b; }
  friend Singles operator*(Singles a, const Singles& b) { return a *= b; }
  friend double sum_of_lanes(const Singles& x) {
    return static_cast<double>(reinterpret_cast<const float&>(x.v));
  }

  Vector v{};
};

template <class Real>
void stream_loop(double* a, const double* b, const double* c, double s, std::size_t count) {
  const Real factor{s};
  for (std::size_t i = 0; i < count; i += width_of<Real>) {
    *reinterpret_cast<Real*>(a + i) =
        *reinterpret_cast<const Real*>(b + i) + factor * *reinterpret_cast<const Real*>(c + i);
  }
}

template <class Real>
constexpr PeakLoops peak_loops_of() {
  // The width of a register of the set; every processor has registers of four.
  constexpr int singles = width_of<Real> == 1 ? 4 : 2 * width_of<Real>;
  return {&multiply_add_loop<Real>,
          &divide_loop<Real>,
          &square_root_loop<Real>,
          std::uint64_t{chains} * width_of<Real>,
          &multiply_add_loop<Singles<Real, singles>>,
          std::uint64_t{chains} * singles,
          &stream_loop<Real>};
}

}  // namespace peclet::engine
