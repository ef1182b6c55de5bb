// Inverts symmetric positive definite 6 x 6 matrices.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/state/real.h"

namespace peclet::engine {
namespace {

// Returns the index of an element in the lower triangle of a symmetric 6 x 6 matrix, row after row.
constexpr int entry(int row, int column) { return row * (row + 1) / 2 + column; }
constexpr int entries = 21;

// Inverts a matrix, or several side by side: A = L D L^T, A^-1 = L^-T D^-1 L^-1. Numbers are in single
// precision.
template <class Numbers>
PECLET_ALWAYS_INLINE void invert(const Numbers* a, Numbers* inverse) {
  Numbers lower[entries], inverse_lower[entries], per_pivot[6];
  PECLET_UNROLL
  for (int row = 0; row < 6; ++row) {
    Numbers scaled[6];  // L_rk D_k
    Numbers pivot = a[entry(row, row)];
    PECLET_UNROLL
    for (int column = 0; column < row; ++column) {
      Numbers sum = a[entry(row, column)];
      PECLET_UNROLL
      for (int k = 0; k < column; ++k) sum -= scaled[k] * lower[entry(column, k)];
      scaled[column] = sum;
      lower[entry(row, column)] = sum * per_pivot[column];
      pivot -= sum * lower[entry(row, column)];
    }
    per_pivot[row] = 1.0F / pivot;
  }
  PECLET_UNROLL
  for (int column = 0; column < 6; ++column) {
    PECLET_UNROLL
    for (int row = column + 1; row < 6; ++row) {
      Numbers sum = lower[entry(row, column)];
      PECLET_UNROLL
      for (int k = column + 1; k < row; ++k) sum += lower[entry(row, k)] * inverse_lower[entry(k, column)];
      inverse_lower[entry(row, column)] = Numbers{} - sum;
    }
  }
  PECLET_UNROLL
  for (int row = 0; row < 6; ++row) {
    PECLET_UNROLL
    for (int column = 0; column <= row; ++column) {
      Numbers sum = row == column ? per_pivot[row] : inverse_lower[entry(row, column)] * per_pivot[row];
      PECLET_UNROLL
      for (int k = row + 1; k < 6; ++k) {
        sum += inverse_lower[entry(k, row)] * per_pivot[k] * inverse_lower[entry(k, column)];
      }
      inverse[entry(row, column)] = sum;
    }
  }
}

}  // namespace
}  // namespace peclet::engine
