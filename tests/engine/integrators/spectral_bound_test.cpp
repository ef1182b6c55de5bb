// The packing's matrix compared with forces and slips, its largest eigenvalue with all eigenvalues.
#include "engine/integrators/spectral_bound.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>

#include "engine/kernels/force_field.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/every_image.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/linear_algebra.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

constexpr std::size_t count = 12;
constexpr Eigen::Index rows = 6 * count;  // by particle, velocity then spin
using Dense = Eigen::Matrix<double, rows, rows>;
using Rows = Eigen::Vector<double, rows>;

constexpr Terms every_term = {.lubrication = true,
                              .noise = false,
                              .contact = true,
                              .damping = true,
                              .friction = true,
                              .rolling = true,
                              .conservative = true};

std::vector<PairKind> kinds_of(const System& system, const Physics& physics) {
  return make_pair_kinds(physics, distinct_radii(system.particles.radius));
}

// Returns the matrix, column by column, from unit vectors.
Dense dense(const PackingMatrix& matrix) {
  Dense all;
  for (Eigen::Index k = 0; k < rows; ++k) all.col(k) = matrix * Rows::Unit(k);
  return all;
}

void expect_equal(const Dense& a, const Dense& b) {
  EXPECT_LE(largest_entry(a - b), 1e-10 * largest_entry(b));
}

Eigen::Index row_of(std::size_t particle) { return 6 * static_cast<Eigen::Index>(particle); }

Rows inverse_roots(const ParticleState& particles) {
  Rows inertia;
  for (std::size_t i = 0; i < count; ++i) {
    inertia.segment<3>(row_of(i)).setConstant(particles.mass[i]);
    inertia.segment<3>(row_of(i) + 3).setConstant(particles.inertia[i]);
  }
  return inertia.cwiseSqrt().cwiseInverse();
}

Rows loads(ForceField& field, System& system) {
  VectorField force(count), torque(count);
  field.evaluate(system, force, torque);
  Rows all;
  for (std::size_t i = 0; i < count; ++i) {
    all.segment<6>(row_of(i)) << to_eigen(force[i]), to_eigen(torque[i]);
  }
  return all;
}

Vector3 unit_vector(std::size_t k) { return {k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0}; }

// Returns the decrease of forces and torques by a unit change of one velocity or spin, springs unchanged. The
// forces are linear, so unit changes are exact.
Dense resistance_by_forces(System system, const Physics& physics) {
  ForceField field(physics, system.particles, /*timestep=*/0, /*seed=*/1, /*threads=*/1);
  const Rows before = loads(field, system), roots = inverse_roots(system.particles);
  Dense matrix;
  for (std::size_t k = 0; k < rows; ++k) {
    System moved = system;
    VectorField& motion = k % 6 < 3 ? moved.particles.velocity : moved.particles.angular_velocity;
    motion.set(k / 6, motion[k / 6] + unit_vector(k % 3));
    matrix.col(static_cast<Eigen::Index>(k)) = before - loads(field, moved);
  }
  return roots.asDiagonal() * matrix * roots.asDiagonal();
}

// K as the sum of k g g^T, with g the extension rate of a spring of stiffness k per unit velocity and spin.
class StiffnessByExtensions {
 public:
  explicit StiffnessByExtensions(const ParticleState& particles) : roots_(inverse_roots(particles)) {}

  void add(double stiffness, std::size_t i, std::size_t j, const Vector3& velocity, const Vector3& spin_first,
           const Vector3& spin_second) {
    Rows growth = Rows::Zero();
    growth.segment<6>(row_of(i)) << -to_eigen(velocity), to_eigen(spin_first);
    growth.segment<6>(row_of(j)) << to_eigen(velocity), to_eigen(spin_second);
    growth.array() *= roots_.array();
    matrix_ += stiffness * growth * growth.transpose();
  }

  const Dense& matrix() const { return matrix_; }

 private:
  Rows roots_;
  Dense matrix_ = Dense::Zero();
};

// Returns K of the springs of every contact and of the curvature of the repulsion.
Dense stiffness_by_extensions(const System& system, const Physics& physics) {
  const ParticleState& particles = system.particles;
  StiffnessByExtensions sum(particles);
  const auto range = [&](auto i, auto j) { return 1.1 * (particles.radius[i] + particles.radius[j]); };
  for (const SeenPair& pair :
       every_image(particles.position, system.box.lengths(), system.box.tilt(), range)) {
    const double first = particles.radius[pair.first], second = particles.radius[pair.second];
    const double distance = norm(pair.separation), h = distance - first - second;
    const Vector3 n = (1 / distance) * pair.separation;
    const Vector3 t = across(std::abs(n.x) < 0.5 ? Vector3{1, 0, 0} : Vector3{0, 1, 0}, n);
    const Vector3 tangents[] = {(1 / norm(t)) * t, (1 / norm(t)) * cross(n, t)};
    const double length = physics.repulsion->relative_length * (first + second);
    double curvature = 0, pull = 0;
    if (h < physics.repulsion->cutoff_lengths * length) {
      curvature = physics.repulsion->strength * std::exp(-h / length) / (length * length);
      pull = -physics.repulsion->strength * std::exp(-h / length) / length;
    }
    if (physics.attraction && h < physics.attraction->cutoff) {
      const double mean = 2 * first * second / (first + second), gap = std::max(h, 0.0);
      const double c = physics.attraction->hamaker * mean / 12;
      const double squares = gap * gap + std::pow(physics.attraction->regularisation * mean, 2);
      curvature -= 2 * c * gap / (squares * squares);
      pull += c / squares;
    }
    sum.add(std::max(curvature, 0.0), pair.first, pair.second, n, {}, {});
    for (const Vector3& tangent : tangents) {
      sum.add(std::max(pull, 0.0) / distance, pair.first, pair.second, tangent, {}, {});
    }
    if (h >= 0) continue;
    sum.add(physics.contact->normal_stiffness, pair.first, pair.second, n, {}, {});
    const double reduced = 2 * first * second / (first + second);
    for (const Vector3& tangent : tangents) {
      // Slip along t: t.(U_j - U_i) - (l Omega x n).t with (Omega x n).t = Omega.(n x t).
      const Vector3 turn = cross(n, tangent);
      sum.add(physics.contact->tangential_stiffness, pair.first, pair.second, tangent,
              -(first + 0.5 * h) * turn, -(second + 0.5 * h) * turn);
      // Rolling along t: a (n x (Omega_i - Omega_j)).t.
      sum.add(physics.contact->rolling_stiffness, pair.first, pair.second, {}, -reduced * turn,
              reduced * turn);
    }
  }
  return sum.matrix();
}

TEST(PackingMatrix, ResistanceIsWhatForcesLoseToUnitMotions) {
  Physics physics = physics_with(every_term);
  physics.contact->friction = 1e6;  // dashpots of sticking contacts are linear
  const System system = dense_suspension(physics, count, 3);
  const PackingMatrix matrix(system, kinds_of(system, physics), physics, {1, 0});
  expect_equal(dense(matrix), resistance_by_forces(system, physics));
}

TEST(PackingMatrix, StiffnessIsThatOfTheSpringsExtensions) {
  const Physics repelling = physics_with(every_term);
  Physics attracting = repelling;  // pairs that turn
  attracting.attraction = AttractionParameters{.hamaker = 3, .regularisation = 0.01, .cutoff = 0.1};
  for (const Physics& physics : {repelling, attracting}) {
    const System system = dense_suspension(physics, count, 3);
    const PackingMatrix matrix(system, kinds_of(system, physics), physics, {0, 1});
    expect_equal(dense(matrix), stiffness_by_extensions(system, physics));
  }
}

// Iterations may converge to an eigenvalue just below the largest: an upper estimate up to 1 % too low.
TEST(SpectralBound, IsTheLargestOfAllEigenvalues) {
  const Physics physics = physics_with(every_term);
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const System system = dense_suspension(physics, count, seed);
    for (const MatrixWeights weights : {MatrixWeights{1, 0}, {0, 1}, {1e-2, 1e-4}}) {
      const PackingMatrix matrix(system, kinds_of(system, physics), physics, weights);
      const double largest = Eigen::SelfAdjointEigenSolver<Dense>(dense(matrix)).eigenvalues().maxCoeff();
      const SpectralBound rough = largest_eigenvalue(matrix), fine = largest_eigenvalue(matrix, 1e-6);
      EXPECT_LE(rough.value, largest * (1 + 1e-12));
      EXPECT_GE(rough.upper(), 0.99 * largest);
      EXPECT_LE(rough.residual, 0.01 * rough.value);
      EXPECT_NEAR(fine.value, largest, 1e-9 * largest);
    }
  }
}

// Rates of two equal spheres in contact: 2 X_A / m plus the drag along the line of centres, and 2 k_n / m.
// With stiff tangential springs at levers l and inertia 2/5 m a^2: (2 + 5 l^2 / a^2) k_t / m.
TEST(SpectralBound, OfOnePairIsItsAnalyticRate) {
  constexpr double overlap = 1e-3;
  Physics physics;
  physics.viscosity = 0.1;
  physics.contact = ContactParameters{.normal_stiffness = 1e4};
  physics.lubrication = LubricationParameters{.inner_gap = 1e-3, .outer_gap = 0.05};
  System system = spheres_in({20, 20, 20}, physics, {1, 1});
  system.particles.position.set(0, {9, 9, 9});
  system.particles.position.set(1, {9 + (2 - overlap) * 0.6, 9, 9 + (2 - overlap) * 0.8});
  const auto largest = [&](const MatrixWeights& weights) {
    const std::vector<PairKind> kinds = kinds_of(system, physics);
    system.list = NeighbourList(range_table(kinds, 1), 0.1);
    system.list.build(system.particles, system.box);
    return largest_eigenvalue(PackingMatrix(system, kinds, physics, weights)).value;
  };
  const double mass = 4 * pi / 3 * 0.1, drag = 6 * pi * 0.1;
  const double squeeze = drag * (0.25 / 1e-3 + 9.0 / 40 * std::log(1e3));
  EXPECT_NEAR(largest({1, 0}), (2 * squeeze + drag) / mass, 1e-9 * squeeze / mass);
  EXPECT_NEAR(largest({0, 1}), 2e4 / mass, 1e-9 * 2e4 / mass);
  physics.contact->friction = 1;
  physics.contact->tangential_stiffness = 3e4;
  const double lever = 1 - 0.5 * overlap;
  const double sticking = (2 + 5 * lever * lever) * 3e4 / mass;
  EXPECT_NEAR(largest({0, 1}), sticking, 1e-9 * sticking);
}

// Iterations that stop early may miss a mode on few spheres. Of these sixty cases (three kinds of physics,
// fixed seeds) four upper estimates are too low, by at most 0.7 %.
TEST(SpectralBound, UpperEstimateIsHardlyEverBelowTheLargestEigenvalue) {
  int below = 0;
  double lowest = 2;
  for (const Terms terms : {Terms{.lubrication = true, .contact = true}, {.contact = true}, every_term}) {
    const Physics physics = physics_with(terms);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const System system = dense_suspension(physics, 300, seed);
      const PackingMatrix matrix(system, kinds_of(system, physics), physics, {1e-2, 1e-4});
      const double ratio = largest_eigenvalue(matrix).upper() / largest_eigenvalue(matrix, 1e-8).value;
      below += ratio < 1 - 1e-12 ? 1 : 0;
      lowest = std::min(lowest, ratio);
      EXPECT_LT(ratio, 1.02);
    }
  }
  EXPECT_LE(below, 6);
  EXPECT_GT(lowest, 0.99);
}

// Rates may have any magnitude, since units are those of the scene.
TEST(SpectralBound, ScalesWithTheMatrix) {
  const Physics physics = physics_with(every_term);
  const System system = dense_suspension(physics, count, 1);
  const auto largest = [&](double scale) {
    return largest_eigenvalue(PackingMatrix(system, kinds_of(system, physics), physics, {scale, 0}), 1e-6);
  };
  const SpectralBound one = largest(1);
  for (const double scale : {1e-100, 1e-12, 1e12, 1e100}) {
    const SpectralBound scaled = largest(scale);
    EXPECT_NEAR(scaled.value / scale, one.value, 1e-12 * one.value) << scale;
    EXPECT_EQ(scaled.iterations, one.iterations) << scale;
  }
}

TEST(SpectralBound, OfAMatrixThatIsNotFiniteIsNotANumber) {
  const Physics physics = physics_with(every_term);
  const System system = dense_suspension(physics, count, 1);
  const MatrixWeights weights = {std::numeric_limits<double>::quiet_NaN(), 0};
  const PackingMatrix matrix(system, kinds_of(system, physics), physics, weights);
  EXPECT_TRUE(std::isnan(largest_eigenvalue(matrix).upper()));
}

TEST(SpectralBound, OfSpheresWithoutNeighboursIsTheirDrag) {
  Physics physics;
  physics.viscosity = 0.1;
  System system = spheres_in({20, 20, 20}, physics, {1, 1.4});
  system.particles.position.set(1, {9, 9, 9});
  const double spin = 8 * pi * 0.1 / (0.4 * 4 * pi / 3 * 0.1);  // of the smaller sphere
  EXPECT_NEAR(largest_eigenvalue(PackingMatrix(system, {}, physics, {1, 0})).value, spin, 1e-12 * spin);
  EXPECT_EQ(largest_eigenvalue(PackingMatrix(system, {}, physics, {0, 1})).upper(), 0);
}

}  // namespace
}  // namespace peclet::engine
