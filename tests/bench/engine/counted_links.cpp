// The kernels of the implicit system, compiled with single-precision numbers that count operations.
//
// Their rows and links are then other types. They and all headers below them get a namespace of their own
// here. Outside it only the headers of counters and teams are included, which contain no numbers.
#include "tests/bench/engine/counted_links.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "engine/state/threads.h"

namespace peclet::counting_engine {

static engine::Operations done;

struct CountedFloat {
  CountedFloat() = default;
  CountedFloat(float x) : value(x) {}       // NOLINT(google-explicit-constructor): constants of a formula
  operator float() const { return value; }  // NOLINT(google-explicit-constructor): uncounted uses

  CountedFloat& operator+=(const CountedFloat& b) { return ++done.sums, value += b.value, *this; }

  float value = 0;
};

template <int width>
class alignas(4 * width) CountedVector {
 public:
  CountedVector() = default;
  template <class... Numbers>
  requires(sizeof...(Numbers) == width) CountedVector(const Numbers&... numbers) : lane_{numbers...} {}

  const CountedFloat& operator[](int k) const { return lane_[k]; }
  CountedFloat& operator[](int k) { return lane_[k]; }

  friend CountedVector operator+(const CountedVector& a, const CountedVector& b) {
    return done.sums += width, each([&](int k) { return a[k].value + b[k].value; });
  }
  friend CountedVector operator-(const CountedVector& a, const CountedVector& b) {
    return done.sums += width, each([&](int k) { return a[k].value - b[k].value; });
  }
  friend CountedVector operator*(const CountedVector& a, const CountedVector& b) {
    return done.products += width, each([&](int k) { return a[k].value * b[k].value; });
  }
  friend CountedVector operator*(const CountedVector& a, float b) {
    return done.products += width, each([&](int k) { return a[k].value * b; });
  }
  friend CountedVector operator*(float a, const CountedVector& b) { return b * a; }
  friend CountedVector operator-(float a, const CountedVector& b) {
    return done.sums += width, each([&](int k) { return a - b[k].value; });
  }
  friend CountedVector operator/(float a, const CountedVector& b) {
    return done.quotients += width, each([&](int k) { return a / b[k].value; });
  }
  friend CountedVector operator-(const CountedVector& a) {
    return each([&](int k) { return -a[k].value; });
  }
  CountedVector& operator+=(const CountedVector& b) { return *this = *this + b; }
  CountedVector& operator-=(const CountedVector& b) { return *this = *this - b; }

  // Returns the vector of number(k) for each lane k.
  template <class Number>
  static CountedVector each(const Number& number) {
    CountedVector result;
    for (int k = 0; k < width; ++k) result.lane_[k].value = number(k);
    return result;
  }

 private:
  CountedFloat lane_[width];
};

using Floats = CountedVector<8>;
using FourFloats = CountedVector<4>;

// Substitutes for the compiler's vector built-ins, under the names of the macros below; they do not count.
template <int width>
float lane_of_both(const CountedVector<width>& a, const CountedVector<width>& b, int place) {
  return place < width ? a[place].value : b[place - width].value;
}
template <int width, class... Places>
CountedVector<sizeof...(Places)> of_lanes(const CountedVector<width>& a, const CountedVector<width>& b,
                                          Places... places) {
  const int from[] = {places...};
  return CountedVector<sizeof...(Places)>::each([&](int k) { return lane_of_both(a, b, from[k]); });
}
template <class To, class From>
To converted(const From& numbers) {
  To result{};
  for (int k = 0; k < 4; ++k) result[k] = static_cast<float>(numbers[k]);
  return result;
}

using engine::Team;

}  // namespace peclet::counting_engine

#define PECLET_FLOATS
#define engine counting_engine
// The kernels call these built-ins by name. NOLINTBEGIN(bugprone-reserved-identifier)
#define __builtin_shufflevector of_lanes
#define __builtin_convertvector(numbers, To) converted<To>(numbers)
// NOLINTEND(bugprone-reserved-identifier)
#include "engine/kernels/link_pivots.h"
#include "engine/kernels/link_solver.h"
#undef __builtin_shufflevector
#undef __builtin_convertvector
#undef engine

namespace peclet::counting_engine {
namespace {

// All kernels of a processor's table, except for assembly, which uses double-precision numbers.
constinit const LinkKernels counting_kernels = {
    nullptr, nullptr, &factorise, &multiply, &set_residual, &squared_motion, &add_motion, &begin, &solve};

class Counting {
 public:
  explicit Counting(const LinkSystem& system) : system_(system), pivots_(system.particles) {
    for (std::vector<MotionRow>& row : rows_) row.resize(system.particles);
    system_.pivots = pivots_.data();
    Team alone;
    done = {};
    counting_kernels.factorise(system_, pivots_.data(), alone);
    factorisation_ = done;
  }

  const engine::Operations& factorisation() const { return factorisation_; }

  engine::Operations of_iterations(const MotionRow* right, int iterations, double& squared_residual) {
    rows_[0].assign(right, right + system_.particles);
    const SolverRows rows = {rows_[0].data(), rows_[1].data(), rows_[2].data(), rows_[3].data(),
                             rows_[4].data(), rows_[5].data(), rows_[6].data()};
    Team alone;
    const double squared = counting_kernels.begin(system_, rows, alone);
    done = {};
    squared_residual = counting_kernels.solve(system_, rows, squared, 0, iterations, alone).squared_residual;
    return done;
  }

 private:
  LinkSystem system_;
  std::vector<Pivot> pivots_;
  std::array<std::vector<MotionRow>, 7> rows_;
  engine::Operations factorisation_;
};

}  // namespace
}  // namespace peclet::counting_engine

namespace peclet::engine {

// The engine's rows and links are read as those of the counting kernels, so sizes and layout must agree.
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
