// Eigenvalues of a small symmetric matrix by Jacobi rotations, in ascending order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace peclet::engine {

template <std::size_t n>
using Matrix = std::array<std::array<double, n>, n>;

template <std::size_t n>
std::array<double, n> symmetric_eigenvalues(Matrix<n> a) {
  const auto rotate = [&a](std::size_t p, std::size_t q) {
    const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
    const double c = std::cos(angle), s = std::sin(angle);
    for (std::size_t k = 0; k < n; ++k) {
      const double kp = a[k][p], kq = a[k][q];
      a[k][p] = c * kp - s * kq;
      a[k][q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double pk = a[p][k], qk = a[q][k];
      a[p][k] = c * pk - s * qk;
      a[q][k] = s * pk + c * qk;
    }
  };
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        if (a[p][q] != 0) {
          rotate(p, q);
        }
      }
    }
  }
  std::array<double, n> values;
  for (std::size_t k = 0; k < n; ++k) {
    values[k] = a[k][k];
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace peclet::engine
