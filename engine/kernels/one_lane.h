// Reads and writes memory for the loop over pairs: one double, on any processor.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/state/real.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// The number of pairs that a Real holds.
template <class Real>
constexpr int width_of = Real::width;
template <>
inline constexpr int width_of<double> = 1;

// A row for each lane.
template <class Real>
struct RowsOf {
  Row row[width_of<Real>];
};

// Functions of a double; those of lanes have the same names (lane_access.h).
inline Vector3 gather_rows(const double* rows, const std::uint32_t* index, double /*number*/) {
  const double* row = rows + 4 * std::size_t{index[0]};
  return {row[0], row[1], row[2]};
}

inline RowsOf<double> scattered(const Vector3& v) {
  RowsOf<double> result;
  result.row[0] = Row{v.x, v.y, v.z, 0};
  return result;
}

inline unsigned bits(bool condition) { return condition ? 1U : 0U; }
inline double sum_of_lanes(double x) { return x; }
inline double largest_lane(double x) { return x; }
inline bool listed_lanes(int /*count*/, double /*number*/) { return true; }
inline double lane(double x, int /*lane*/) { return x; }
inline void set_lane(double& x, int /*lane*/, double value) { x = value; }
inline double load_lanes(const double* values, int /*count*/, double /*number*/) { return *values; }
inline void store_floats(float* values, double x) { *values = static_cast<float>(x); }
inline void store_lanes(double* values, int /*count*/, double x) { *values = x; }

}  // namespace peclet::engine
