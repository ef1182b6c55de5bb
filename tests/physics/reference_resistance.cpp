#include "tests/physics/reference_resistance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace peclet::engine {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

struct Directions {
  Matrix3 along, across;  // n n and 1 - n n
  Matrix3 turn;           // turn v = v x n
};

Directions directions_of(const Vector3& n) {
  const std::array<double, 3> c = {n.x, n.y, n.z};
  Directions d{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      d.along[a][b] = c[a] * c[b];
      d.across[a][b] = (a == b ? 1.0 : 0.0) - c[a] * c[b];
    }
  }
  d.turn = {{{0, n.z, -n.y}, {-n.z, 0, n.x}, {n.y, -n.x, 0}}};
  return d;
}

// Puts the block `factor` m at rows of `row` and columns of `column` (0 F_i, 1 F_j, 2 T_i, 3 T_j).
void add_block(Matrix12& R, std::size_t row, std::size_t column, double factor, const Matrix3& m) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      R[3 * row + a][3 * column + b] += factor * m[a][b];
    }
  }
}

}  // namespace

Matrix12 reference_resistance(double viscosity, double radius_i, double radius_j, const Vector3& separation,
                              double inner_gap) {
  using std::pow;
  const double pi = std::numbers::pi, r = norm(separation), sum = radius_i + radius_j;
  const double gap = std::max(2 * (r - sum) / sum, inner_gap), log = std::log(1 / gap), q = r / sum;
  const double b = radius_j / radius_i, c = 1 / b;
  const double squeeze =
      6 * pi * viscosity * radius_i *
      (2 * b * b / pow(1 + b, 3) / gap + b * (1 + 7 * b + b * b) / (5 * pow(1 + b, 3)) * log);
  const double shear =
      6 * pi * viscosity * radius_i * 4 * b * (2 + b + 2 * b * b) / (15 * pow(1 + b, 3)) * log;
  const double pump_i = -4 * pi * viscosity * pow(radius_i, 2) * b * (4 + b) / (5 * pow(1 + b, 2)) * log * q;
  const double pump_j = -4 * pi * viscosity * pow(radius_j, 2) * c * (4 + c) / (5 * pow(1 + c, 2)) * log * q;
  const double twist_i = 8 * pi * viscosity * pow(radius_i, 3) * 2 * b / (5 * (1 + b)) * log * q * q;
  const double twist_j = 8 * pi * viscosity * pow(radius_j, 3) * 2 * c / (5 * (1 + c)) * log * q * q;
  const double twist_ij = 8 * pi * viscosity * pow(radius_i, 3) * b * b / (10 * (1 + b)) * log * q * q;

  const Directions d = directions_of((1 / r) * separation);
  Matrix12 R{};
  for (const std::size_t row : {0U, 1U}) {
    const double sign = row == 0 ? 1 : -1;
    for (const std::size_t column : {0U, 1U}) {
      const double same = row == column ? 1 : -1;
      add_block(R, row, column, same * squeeze, d.along);
      add_block(R, row, column, same * shear, d.across);
    }
    add_block(R, row, 2, -sign * pump_i, d.turn);
    add_block(R, row, 3, -sign * pump_j, d.turn);
    add_block(R, 2, row, sign * pump_i, d.turn);
    add_block(R, 3, row, sign * pump_j, d.turn);
  }
  add_block(R, 2, 2, twist_i, d.across);
  add_block(R, 3, 3, twist_j, d.across);
  add_block(R, 2, 3, twist_ij, d.across);
  add_block(R, 3, 2, twist_ij, d.across);
  return R;
}

double quadratic_form(const Matrix12& R, const std::array<double, 12>& v) {
  double sum = 0;
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = 0; b < 12; ++b) {
      sum += v[a] * R[a][b] * v[b];
    }
  }
  return sum;
}

}  // namespace peclet::engine
