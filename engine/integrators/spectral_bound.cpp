#include "engine/integrators/spectral_bound.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/kernels/pair_terms.h"
#include "engine/state/eigen_arrays.h"
#include "engine/terms/drag.h"
#include "engine/terms/keyed_random.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

// Returns c_R R + c_K K of a pair.
PairResistance coupling_of(const Physics& physics, const Terms& terms, const PairKind& kind,
                           const PairGeometry& shape, const MatrixWeights& weights) {
  PairResistance coupling{};
  if (physics.lubrication && shape.distance <= kind.lubrication_range) {
    add_scaled(coupling, weights.resistance, pair_resistance(kind.resistance, kind.gap, shape));
  }
  add_stiffness(coupling, terms, physics.contact.value_or(ContactParameters{}), kind, shape,
                {weights.resistance, weights.stiffness, weights.stiffness}, [] {
                  return OfEachSpring<double>{1, 1};
                });
  // Attraction turns with n, which adds the stiffness V' / r across n.
  const double slope = potential(kind.conservative, shape.distance, shape.sum_of_radii).slope;
  coupling.shear += weights.stiffness * std::max(slope, 0.0) / shape.distance;
  return coupling;
}

}  // namespace

PackingMatrix::PackingMatrix(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                             const MatrixWeights& weights) {
  const ParticleState& particles = system.particles;
  const auto motions = static_cast<Eigen::Index>(2 * particles.count());
  per_root_inertia_.resize(motions);
  drag_rate_.resize(motions);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i], mass = particles.mass[i], inertia = particles.inertia[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    per_root_inertia_.segment<2>(row) << 1 / std::sqrt(mass), 1 / std::sqrt(inertia);
    drag_rate_.segment<2>(row) << weights.resistance * translational_drag(physics.viscosity, radius) / mass,
        weights.resistance * rotational_drag(physics.viscosity, radius) / inertia;
  }
  const Terms terms = required_terms(physics);
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  for (const Pair& pair : system.list.pairs()) {
    const PairKind& kind = kinds[pair.kind];
    const PairGeometry shape = geometry(separation(particles, pair, frames[pair.image]), kind);
    if (shape.distance <= kind.range) {
      links_.push_back({pair.first, pair.second, shape, coupling_of(physics, terms, kind, shape, weights)});
    }
  }
}

Eigen::VectorXd PackingMatrix::operator*(const Eigen::VectorXd& vector) const {
  // Each column is the velocity or the spin of a particle.
  const Eigen::Map<const Eigen::Matrix3Xd> scaled(vector.data(), 3, drag_rate_.size());
  const Eigen::Matrix3Xd motion = scaled * per_root_inertia_.asDiagonal();
  Eigen::Matrix3Xd load = Eigen::Matrix3Xd::Zero(3, motion.cols());
  for (const Link& link : links_) {
    const Eigen::Index i = 2 * Eigen::Index{link.first}, j = 2 * Eigen::Index{link.second};
    const PairMotion of_pair = {from_eigen(motion.col(j) - motion.col(i)), from_eigen(motion.col(i + 1)),
                                from_eigen(motion.col(j + 1))};
    const PairLoad felt = lubrication_load(link.coupling, link.shape, of_pair);
    load.col(i) -= to_eigen(felt.force);
    load.col(j) += to_eigen(felt.force);
    load.col(i + 1) -= to_eigen(felt.torque_first);
    load.col(j + 1) -= to_eigen(felt.torque_second);
  }
  Eigen::VectorXd product(vector.size());
  Eigen::Map<Eigen::Matrix3Xd>(product.data(), 3, load.cols()) =
      scaled * drag_rate_.asDiagonal() + load * per_root_inertia_.asDiagonal();
  return product;
}

namespace {

// A limit far above what any packing has needed.
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
  // The solver takes entries that are small beside 1 as zero. The matrix may be zero.
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
    // True if the vectors span all that the start vector reaches: only rounding is left.
    const bool exhausted = !(length > 1e-12 * diagonal(k));
    if (exhausted || bound.iterations % iterations_between_looks == 0) {
      const Largest found = largest_of(diagonal.head(k + 1), beside.head(k));
      bound.value = found.eigenvalue;
      bound.residual = exhausted ? 0 : length * found.last_component;
      if (exhausted || bound.residual <= tolerance * bound.value) break;
    }
    before.swap(vector);
    vector = product / length;
  }
  return bound;
}

}  // namespace peclet::engine
