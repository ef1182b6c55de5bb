#include "tests/physics/reference_resistance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace peclet::engine {
namespace {

// A function of resistance near contact: inverse / xi + logarithm ln(1/xi) + O(1). It belongs to a sphere and
// depends on lambda, the other radius over its own.
struct Divergent {
  double inverse, logarithm;
};

// Functions on the sphere that moves or turns, in units of 6 pi eta a, 4 pi eta a^2 and 8 pi eta a^3.
Divergent x_a_own(double lambda) {
  const double g = std::pow(1 + lambda, -3);
  return {2 * lambda * lambda * g, lambda * (1 + 7 * lambda + lambda * lambda) / 5 * g};
}
Divergent y_a_own(double lambda) {
  return {0, 4.0 / 15 * lambda * (2 + lambda + 2 * lambda * lambda) * std::pow(1 + lambda, -3)};
}
Divergent y_b_own(double lambda) { return {0, -lambda * (4 + lambda) / 5 * std::pow(1 + lambda, -2)}; }
Divergent y_c_own(double lambda) { return {0, 0.4 * lambda / (1 + lambda)}; }

// Functions on the other sphere, in units of 3 pi eta S, pi eta S^2 and pi eta S^3, S the sum of both radii.
Divergent times(double factor, const Divergent& g) { return {factor * g.inverse, factor * g.logarithm}; }
Divergent x_a_other(double lambda) { return times(-2 / (1 + lambda), x_a_own(lambda)); }
Divergent y_a_other(double lambda) { return times(-2 / (1 + lambda), y_a_own(lambda)); }
Divergent y_b_other(double lambda) { return times(-4 * std::pow(1 + lambda, -2), y_b_own(lambda)); }
Divergent y_c_other(double lambda) { return {0, 0.8 * lambda * lambda * std::pow(1 + lambda, -4)}; }

// Returns the matrix of cross(d) v = v x d, epsilon_ijk d_k.
Eigen::Matrix3d cross(const Eigen::Vector3d& d) {
  return (Eigen::Matrix3d() << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0).finished();
}

// Returns the resistance with spins counted once; `squeezing` selects the terms of a squeezing function.
Matrix12 resistance_at(double xi, double viscosity, double radius_i, double radius_j,
                       const Vector3& separation, Divergent (*squeezing)(const Divergent&)) {
  const double pi_eta = std::numbers::pi * viscosity, S = radius_i + radius_j;
  const auto at_gap = [&](const Divergent& g) { return g.inverse / xi - g.logarithm * std::log(xi); };

  const Eigen::Vector3d n = to_eigen(separation).normalized();
  const Eigen::Matrix3d along = n * n.transpose(), across = Eigen::Matrix3d::Identity() - along;
  Matrix12 R = Matrix12::Zero();
  const auto block = [&R](Eigen::Index row, Eigen::Index column) {
    return R.block<3, 3>(3 * row, 3 * column);
  };
  for (const Eigen::Index one : {0, 1}) {
    const Eigen::Index other = 1 - one;
    const double a = one == 0 ? radius_i : radius_j, lambda = (S - a) / a;
    // The formulas are for sphere 1, whose partner lies along d.
    const Eigen::Matrix3d turn = cross(one == 0 ? n : Eigen::Vector3d(-n));
    block(one, one) =
        6 * pi_eta * a * (at_gap(squeezing(x_a_own(lambda))) * along + at_gap(y_a_own(lambda)) * across);
    block(one, other) =
        3 * pi_eta * S * (at_gap(squeezing(x_a_other(lambda))) * along + at_gap(y_a_other(lambda)) * across);
    // Torques by velocities; forces by spins are the transposed block.
    block(2 + one, one) = 4 * pi_eta * a * a * at_gap(y_b_own(lambda)) * turn;
    block(2 + one, other) = pi_eta * S * S * at_gap(y_b_other(lambda)) * turn;
    block(2 + one, 2 + one) = 8 * pi_eta * std::pow(a, 3) * at_gap(y_c_own(lambda)) * across;
    block(2 + one, 2 + other) = pi_eta * std::pow(S, 3) * at_gap(y_c_other(lambda)) * across;
  }
  R.topRightCorner<6, 6>() = R.bottomLeftCorner<6, 6>().transpose();
  return R;
}

}  // namespace

Matrix12 reference_resistance(double viscosity, double radius_i, double radius_j, const Vector3& separation,
                              double inner_gap) {
  const double lever = norm(separation) / (radius_i + radius_j);
  const double xi = std::max(2 * lever - 2, inner_gap);
  const Matrix12 R =
      resistance_at(xi, viscosity, radius_i, radius_j, separation, [](const Divergent& g) { return g; });
  Vector12 levers;
  levers << Eigen::Vector<double, 6>::Ones(), Eigen::Vector<double, 6>::Constant(lever);
  return levers.asDiagonal() * R * levers.asDiagonal();
}

Matrix12 reference_relative_resistance(double viscosity, double radius_i, double radius_j,
                                       const Vector3& separation, double regularisation) {
  const double xi = 2 * norm(separation) / (radius_i + radius_j) - 2;
  return resistance_at(std::max(xi, 0.0) + regularisation, viscosity, radius_i, radius_j, separation,
                       [](const Divergent& g) {
                         return Divergent{g.inverse, 0};
                       });
}

}  // namespace peclet::engine
