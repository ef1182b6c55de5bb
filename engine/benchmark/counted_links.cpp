// The kernels of the implicit system once more, with single-precision numbers that count.
//
// Their rows and links are then other types. So they, and all headers that they stand on, have a namespace of
// their own here, and nothing of the engine's may be included but what says counts.
#include "engine/benchmark/counted_links.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace peclet::counting_engine {

static engine::Operations done;

struct CountedFloat {
  CountedFloat() = default;
  CountedFloat(float x) : value(x) {}       // NOLINT(google-explicit-constructor): constants of a formula
  operator float() const { return value; }  // NOLINT(google-explicit-constructor): what is not counted

  CountedFloat& operator+=(const CountedFloat& b) { return ++done.sums, value += b.value, *this; }

  float value = 0;
};

constexpr int lanes = 8;

class alignas(32) CountedFloats {
 public:
  CountedFloats() = default;
  template <class... Numbers>
  requires(sizeof...(Numbers) == lanes) CountedFloats(const Numbers&... numbers) : lane_{numbers...} {}

  const CountedFloat& operator[](int k) const { return lane_[k]; }
  CountedFloat& operator[](int k) { return lane_[k]; }

  friend CountedFloats operator+(const CountedFloats& a, const CountedFloats& b) {
    return done.sums += lanes, each([&](int k) { return a[k].value + b[k].value; });
  }
  friend CountedFloats operator-(const CountedFloats& a, const CountedFloats& b) {
    return done.sums += lanes, each([&](int k) { return a[k].value - b[k].value; });
  }
  friend CountedFloats operator*(const CountedFloats& a, const CountedFloats& b) {
    return done.products += lanes, each([&](int k) { return a[k].value * b[k].value; });
  }
  friend CountedFloats operator*(const CountedFloats& a, float b) {
    return done.products += lanes, each([&](int k) { return a[k].value * b; });
  }
  friend CountedFloats operator*(float a, const CountedFloats& b) { return b * a; }
  friend CountedFloats operator-(float a, const CountedFloats& b) {
    return done.sums += lanes, each([&](int k) { return a - b[k].value; });
  }
  friend CountedFloats operator/(float a, const CountedFloats& b) {
    return done.quotients += lanes, each([&](int k) { return a / b[k].value; });
  }
  friend CountedFloats operator-(const CountedFloats& a) {
    return each([&](int k) { return -a[k].value; });
  }
  CountedFloats& operator+=(const CountedFloats& b) { return *this = *this + b; }
  CountedFloats& operator-=(const CountedFloats& b) { return *this = *this - b; }

 private:
  template <class Number>
  static CountedFloats each(const Number& number) {
    CountedFloats result;
    for (int k = 0; k < lanes; ++k) {
      result.lane_[k].value = number(k);
    }
    return result;
  }

  CountedFloat lane_[lanes];
};

using Floats = CountedFloats;

// As __builtin_shuffle: from one vector, and from two that count as one of twice the length.
template <class Places>
CountedFloats shuffled(const CountedFloats& a, const Places& from) {
  CountedFloats result;
  for (int k = 0; k < lanes; ++k) {
    result[k] = a[from[k] % lanes];
  }
  return result;
}
template <class Places>
CountedFloats shuffled(const CountedFloats& a, const CountedFloats& b, const Places& from) {
  CountedFloats result;
  for (int k = 0; k < lanes; ++k) {
    const int place = from[k] % (2 * lanes);
    result[k] = place < lanes ? a[place] : b[place - lanes];
  }
  return result;
}

}  // namespace peclet::counting_engine

#define PECLET_FLOATS
#define engine counting_engine
#define __builtin_shuffle shuffled  // NOLINT(bugprone-reserved-identifier): the kernels call it by this name
#include "engine/kernels/links/link_pivots.h"
#undef __builtin_shuffle
#undef engine

namespace peclet::counting_engine {
namespace {

// Whatever a processor's table has; assembly, of double-precision numbers, apart.
constinit const LinkKernels counting_kernels = {nullptr,         &factorise,  &multiply, &set_residual,
                                                &squared_motion, &add_motion, &begin,    &solve};

class Counting {
 public:
  explicit Counting(const LinkSystem& system)
      : system_(system), inverse_pivots_(6 * system.particles), squeezing_(system.particles) {
    for (std::vector<MotionRow>& row : rows_) {
      row.resize(system.particles);
    }
    std::vector<MotionRow> scratch(rows_of_scratch(system.particles));
    done = {};
    counting_kernels.factorise(system_, scratch.data(), inverse_pivots_.data(), squeezing_.data());
    factorisation_ = done;
    system_.inverse_pivots = inverse_pivots_.data();
    system_.squeezing = squeezing_.data();
  }

  const engine::Operations& factorisation() const { return factorisation_; }

  engine::Operations of_iterations(const MotionRow* right, int iterations, double& squared_residual) {
    const SolverRows rows = {rows_[0].data(), rows_[1].data(), rows_[2].data(), rows_[3].data(),
                             rows_[4].data(), rows_[5].data(), rows_[6].data(), rows_[7].data()};
    const double squared = counting_kernels.begin(system_, right, rows);
    done = {};
    squared_residual = counting_kernels.solve(system_, rows, squared, 0, iterations).squared_residual;
    return done;
  }

 private:
  LinkSystem system_;
  std::vector<MotionRow> inverse_pivots_;
  std::vector<SqueezingRow> squeezing_;
  std::array<std::vector<MotionRow>, 8> rows_;
  engine::Operations factorisation_;
};

}  // namespace
}  // namespace peclet::counting_engine

namespace peclet::engine {

// The engine's rows and links are read as those of the counting kernels: numbers of the same size at the same
// places.
static_assert(sizeof(counting_engine::Floats) == 8 * sizeof(float) && alignof(counting_engine::Floats) == 32);

SolverOperations count_solver_operations(const LinkSystem& system, const MotionRow* right, int iterations) {
  namespace counted = counting_engine;
  counted::Counting counting(reinterpret_cast<const counted::LinkSystem&>(system));
  const auto* const rows = reinterpret_cast<const counted::MotionRow*>(right);
  double squared_residual = 0;
  const Operations fewer = counting.of_iterations(rows, iterations - 1, squared_residual);
  const Operations all = counting.of_iterations(rows, iterations, squared_residual);
  return {counting.factorisation(), all - fewer, squared_residual};
}

}  // namespace peclet::engine
