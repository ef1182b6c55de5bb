// A double that counts its operations. The kernel's code, instantiated with it, gives those of a pair.
#pragma once

#include "engine/kernels/one_lane.h"
#include "tests/bench/engine/operation_counts.h"

namespace peclet::engine {

class Counted {
 public:
  Counted() = default;
  Counted(double x) : value(x) {}  // NOLINT(google-explicit-constructor): constants of a formula

  friend Counted operator+(Counted a, Counted b) { return ++done.sums, Counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return ++done.sums, Counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return ++done.products, Counted(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return ++done.quotients, Counted(a.value / b.value); }
  friend Counted operator-(Counted a) { return {-a.value}; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
  friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }

  double value = 0;

  static thread_local Operations done;
};

inline Counted select(bool condition, Counted yes, Counted no) { return condition ? yes : no; }
inline Counted larger(Counted a, Counted b) { return a < b ? b : a; }
inline Counted square_root(Counted x) { return ++Counted::done.roots, Counted(square_root(x.value)); }
inline Counted logarithm(Counted x) { return ++Counted::done.logarithms, Counted(logarithm(x.value)); }
inline Counted exponential(Counted x) { return ++Counted::done.exponentials, Counted(exponential(x.value)); }

template <>
inline constexpr int width_of<Counted> = 1;

inline Vector3Of<Counted> gather_rows(const double* rows, const std::uint32_t* index, Counted /*number*/) {
  const Vector3 v = gather_rows(rows, index, double{});
  return {v.x, v.y, v.z};
}
inline RowsOf<Counted> scattered(const Vector3Of<Counted>& v) {
  RowsOf<Counted> result;
  result.row[0] = Row{v.x.value, v.y.value, v.z.value, 0};
  return result;
}
inline double sum_of_lanes(Counted x) { return x.value; }
inline double largest_lane(Counted x) { return x.value; }
inline bool listed_lanes(int /*count*/, Counted /*number*/) { return true; }
inline void set_lane(Counted& x, int /*lane*/, double value) { x = value; }
inline Counted load_lanes(const double* values, int /*count*/, Counted /*number*/) { return *values; }
inline void store_lanes(double* values, int /*count*/, Counted x) { *values = x.value; }

}  // namespace peclet::engine
