// The factorised system of an implicit step, and its solution by conjugate gradients.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

class LinkSolverOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, LinkSolverOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

using Matrix = Eigen::MatrixXd;

// Returns A in the order of rows, six numbers each.
Matrix matrix_of(const Links& links) {
  const std::size_t count = links.system().particles.count();
  Matrix matrix(6 * count, 6 * count);
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t k = 0; k < 6; ++k) {
      std::vector<MotionRow> unit(count), product(count);
      unit[row].v[of_a_motion[k]] = 1;
      links.kernels().multiply(links.view(), unit.data(), product.data());
      const std::vector<double> column = numbers(product);
      matrix.col(static_cast<Eigen::Index>(6 * row + k)) =
          Eigen::Map<const Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size()));
    }
  }
  return matrix;
}

// Returns P of the formulas in link_kernels.h, as one matrix with a block for each row.
Matrix pivots_of(const Links& links, const Matrix& matrix) {
  const LinkSystem system = links.view();
  const auto count = static_cast<Eigen::Index>(system.particles);
  Matrix pivots = Matrix::Zero(6 * count, 6 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    pivots.block<6, 6>(6 * i, 6 * i) = matrix.block<6, 6>(6 * i, 6 * i);
  }
  for (const LinkGroup& group : groups_in_order(system)) {
    for (int k = 0; k < links_per_group; ++k) {
      const Eigen::Index i = 6 * Eigen::Index{group.first[k]}, j = 6 * Eigen::Index{group.second[k]};
      const Eigen::Vector3d n = normal_of(group, k);
      const auto squeeze = static_cast<double>(group.squeeze[k]);
      const Eigen::Matrix<double, 6, 6> inverse = pivots.block<6, 6>(j, j).inverse();
      const double compliance = n.dot(inverse.topLeftCorner<3, 3>() * n);
      EXPECT_LE(squeeze * compliance, 1 + 1e-5);
      pivots.block<3, 3>(i, i) -= 0.9 * squeeze * squeeze * compliance * n * n.transpose();
    }
  }
  return pivots;
}

Eigen::VectorXd vector_of(const std::vector<MotionRow>& rows) {
  const std::vector<double> values = numbers(rows);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Returns a suspension of lubricated contacts with friction.
Links rough_links(std::size_t count, InstructionSet set) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  return {physics, dense_suspension(physics, count, 7), set};
}

// The links of a row lead to rows of other levels.
TEST_P(LinkSolverOf, CoupleNoTwoRowsOfALevel) {
  const Links links = rough_links(203, GetParam());
  const Matrix matrix = matrix_of(links);
  EXPECT_EQ(links.order().levels().front().rows_begin, 0);
  EXPECT_EQ(links.order().levels().back().rows_end, 203);
  EXPECT_GE(links.order().levels().size(), 4);  // four spheres in mutual contact
  EXPECT_LE(links.order().levels().size(), 12);
  for (const LinkLevel& level : links.order().levels()) {
    for (Eigen::Index i = level.rows_begin; i < level.rows_end; ++i) {
      for (Eigen::Index j = level.rows_begin; j < i; ++j) {
        EXPECT_EQ((matrix.block<6, 6>(6 * i, 6 * j).cwiseAbs().maxCoeff()), 0);
      }
    }
  }
}

TEST_P(LinkSolverOf, InvertThePivots) {
  const Links links = rough_links(61, GetParam());
  const Matrix pivots = pivots_of(links, matrix_of(links));
  for (std::size_t i = 0; i < 61; ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    const Eigen::Matrix<double, 6, 6> error =
        inverse_of(links.view().pivots[i]) * pivots.block<6, 6>(at, at) -
        Eigen::Matrix<double, 6, 6>::Identity();
    // The condition number of a block is some hundreds.
    EXPECT_LE(largest_entry(error), 1e-3) << i;
  }
}

TEST_P(LinkSolverOf, SolveTheSystem) {
  const Links links = rough_links(203, GetParam());
  const std::size_t count = links.system().particles.count();
  const auto right = random_rows(count, 12);
  SolverStorage storage(count);
  const SolverRows rows = storage.view();
  storage.of[0] = right;
  Team alone;
  const double begun = links.kernels().begin(links.view(), rows, alone);
  // r.C^-1 r with C = (P + L) P^-1 (P + L^T).
  const Matrix matrix = matrix_of(links), pivots = pivots_of(links, matrix);
  const auto size = static_cast<Eigen::Index>(6 * count);
  Matrix lower = pivots;
  for (Eigen::Index i = 0; i < size / 6; ++i) {
    lower.block(6 * i, 0, 6, 6 * i) = matrix.block(6 * i, 0, 6, 6 * i);
  }
  const auto squared_norm = [&](const Eigen::VectorXd& residual) {
    const Eigen::VectorXd reduced = lower.partialPivLu().solve(residual);
    return reduced.dot(pivots * reduced);
  };
  EXPECT_NEAR(begun / squared_norm(vector_of(right)), 1, 1e-4);
  // For eigenvalues of C^-1 A between a and b, conjugate gradients need at most ln(2 / e) sqrt(b / a) / 2
  // iterations to an error e in the norm of A.
  const Matrix whole = lower * pivots.inverse() * lower.transpose();
  const Eigen::VectorXd spectrum =
      Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(matrix, whole, Eigen::EigenvaluesOnly).eigenvalues();
  const double ratio = spectrum.maxCoeff() / spectrum.minCoeff(), smaller = 1e-5;
  const SolverReport report =
      links.kernels().solve(links.view(), rows, begun, smaller * smaller * begun, 1000, alone);
  EXPECT_LE(report.squared_residual, smaller * smaller * begun);
  EXPECT_GT(report.iterations, 5);
  EXPECT_LT(report.iterations, 1 + 0.5 * std::sqrt(ratio) * std::log(2 * std::sqrt(ratio) / smaller));
  // The reported residual is the true one, in that norm and within single precision.
  const Eigen::VectorXd rest = vector_of(right) - matrix * vector_of(storage.of[0]);
  EXPECT_LT(squared_norm(rest), 4 * smaller * smaller * begun);
}

TEST_P(LinkSolverOf, SquareTheMotionRelativeToTheFlow) {
  const Links links = rough_links(203, GetParam());
  const ParticleState& particles = links.system().particles;
  const Matrix3 gradient = simple_shear(0.3);
  std::vector<OneBodyFactors> inertia(distinct_radii(particles.radius).size());
  std::vector<MotionRow> relative(particles.count()), scratch(particles.count());
  double inertial = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const std::size_t row = links.order().row()[i];
    inertia[particles.size_class[i]] = {particles.mass[i], particles.inertia[i]};
    const Vector3 u = particles.velocity[i] - gradient * particles.position[i];
    const Vector3 w = particles.angular_velocity[i] - Vector3{0, 0, -0.15};
    relative[row] = motion_row(u, w);
    inertial += particles.mass[i] * dot(u, u) + particles.inertia[i] * dot(w, w);
  }
  const StepRows step_rows = {.velocity_before = nullptr,
                              .spin_before = nullptr,
                              .position = particles.position.data(),
                              .velocity = particles.velocity.data(),
                              .spin = particles.angular_velocity.data(),
                              .force = nullptr,
                              .torque = nullptr,
                              .noise_force = nullptr,
                              .noise_torque = nullptr,
                              .inertia = inertia.data(),
                              .timestep = step,
                              .flow = plain_flow(gradient),
                              .varying_velocity = nullptr,
                              .varying_spin = nullptr};
  Team alone;
  const SquaredMotion found = links.kernels().squared_motion(links.view(), step_rows, scratch.data(), alone);
  const Eigen::VectorXd motion = vector_of(relative);
  EXPECT_NEAR(found.inertial / inertial, 1, 1e-12);
  EXPECT_NEAR(found.whole / motion.dot(matrix_of(links) * motion), 1, 1e-5);
}

}  // namespace
}  // namespace peclet::engine
