// largest_eigenvalue() finds the largest eigenvalue of a PackingMatrix by Lanczos iterations.
#pragma once

#include <Eigen/Core>

#include "engine/kernels/pair_kinds.h"
#include "engine/state/system.h"

namespace peclet::engine {

struct MatrixWeights {
  double resistance = 0, stiffness = 0;  // c_R, c_K
};

// PackingMatrix is the resistance of a packing, per mass, to small motions about its present configuration:
//   A = M^-1/2 (c_R R + c_K K) M^-1/2,  with six rows for each particle: velocity and spin.
// R is the resistance: lubrication, drag, damping of contacts. K is the stiffness: springs of contacts along
// n, tangential and rolling springs as if every contact stuck, and the curvature of conservative laws. Both
// are symmetric and positive semidefinite. K is an upper bound: it leaves out that pushing forces turn with
// n, which softens the packing across n by F/r, and the negative curvature of attraction.
class PackingMatrix {
 public:
  PackingMatrix(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                const MatrixWeights& weights);

  Eigen::Index rows() const { return 3 * drag_rate_.size(); }

  // Returns A times a vector, in which particle i has the rows 6 i ... 6 i + 5.
  Eigen::VectorXd operator*(const Eigen::VectorXd& vector) const;

 private:
  // A coupled pair. Springs couple velocities and spins in the form of lubrication.
  struct Link {
    std::uint32_t first, second;
    PairGeometry shape;
    PairResistance coupling;
  };

  // Entries alternate between the velocity and the spin of a particle.
  Eigen::VectorXd per_root_inertia_;  // 1 / sqrt(m), 1 / sqrt(I)
  Eigen::VectorXd drag_rate_;         // c_R zeta / m, c_R zeta_r / I
  std::vector<Link> links_;
};

// SpectralBound says that an eigenvalue lies within `residual` of `value`, which is at most the largest one.
struct SpectralBound {
  double value = 0, residual = 0;
  int iterations = 0;

  // Returns an upper bound of the largest eigenvalue, if `value` is close to that one. Modes of a packing are
  // localised on few spheres, so the iterations may have missed the largest one. The bound is then too low by
  // some thousandths (tests/engine/integrators/spectral_bound_test.cpp).
  double upper() const { return value + residual; }
};

// Iterates from a fixed random vector until the residual is at most `tolerance` times the value. The same
// matrix gives the same bits.
SpectralBound largest_eigenvalue(const PackingMatrix& matrix, double tolerance = 0.01);

}  // namespace peclet::engine
