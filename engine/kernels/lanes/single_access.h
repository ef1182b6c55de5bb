// How the loop over pairs reads and writes a single pair; lane_access.h is the same for several.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/kernels/lanes/rows.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// The row of the first index.
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
