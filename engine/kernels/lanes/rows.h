// How many pairs a number holds, and a row of memory for each of them.
#pragma once

#include "engine/state/row.h"

namespace peclet::engine {

// How many pairs a number holds.
template <class Real>
constexpr int width_of = Real::width;
template <>
constexpr int width_of<double> = 1;

// A row for each lane.
template <class Real>
struct RowsOf {
  Row row[width_of<Real>];
};

}  // namespace peclet::engine
