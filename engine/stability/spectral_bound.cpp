#include "engine/stability/spectral_bound.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/random/keyed_random.h"
#include "engine/state/eigen_vector.h"

namespace peclet::engine {
namespace {

// Far more than any packing has needed.
constexpr int most_lanczos_iterations = 200;
constexpr int iterations_between_looks = 4;

Eigen::VectorXd start_vector(Eigen::Index rows) {
  const KeyedRandom random(/*seed=*/0, Purpose::initial_velocity);  // any numbers will do
  Eigen::VectorXd vector(rows);
  for (Eigen::Index row = 0; row < rows; row += 6) {
    const NormalPair normals = random.normals(0, static_cast<std::uint32_t>(row / 6));
    vector.segment<6>(row) << to_eigen(normals.first), to_eigen(normals.second);
  }
  return vector.normalized();
}

// The largest eigenvalue of a symmetric tridiagonal matrix, and |last component| of its unit eigenvector.
struct Largest {
  double eigenvalue, last_component;
};

Largest largest_of(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside) {
  // Entries are small to the solver when they are so beside 1. The matrix may be zero.
  const double unit = std::max(diagonal.maxCoeff(), std::numeric_limits<double>::min());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal / unit, beside / unit);
  const Eigen::Index last = diagonal.size() - 1;
  return {unit * solver.eigenvalues()(last), std::abs(solver.eigenvectors()(last, last))};
}

}  // namespace

SpectralBound largest_eigenvalue(const PackingMatrix& matrix, double tolerance) {
  Eigen::VectorXd vector = start_vector(matrix.rows()), before = Eigen::VectorXd::Zero(matrix.rows());
  Eigen::VectorXd diagonal(most_lanczos_iterations),
      beside(most_lanczos_iterations);  // beside(k) couples k and k + 1
  double length = 0;
  SpectralBound bound;
  while (bound.iterations < most_lanczos_iterations) {
    Eigen::VectorXd product = matrix * vector;
    const int k = bound.iterations++;
    diagonal(k) = vector.dot(product);
    product -= diagonal(k) * vector + length * before;
    length = beside(k) = product.norm();
    // The vectors span everything that the start vector reaches: nothing is left but rounding.
    const bool exhausted = !(length > 1e-12 * diagonal(k));
    if (exhausted || bound.iterations % iterations_between_looks == 0) {
      const Largest found = largest_of(diagonal.head(k + 1), beside.head(k));
      bound.value = found.eigenvalue;
      bound.residual = exhausted ? 0 : length * found.last_component;
      if (exhausted || bound.residual <= tolerance * bound.value) {
        break;
      }
    }
    before.swap(vector);
    vector = product / length;
  }
  return bound;
}

}  // namespace peclet::engine
