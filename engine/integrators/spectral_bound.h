// The largest eigenvalue of a packing's matrix, by Lanczos iterations.
#pragma once

#include <Eigen/Core>

#include "engine/kernels/pair_kinds.h"
#include "engine/state/system.h"

namespace peclet::engine {

// How a packing resists small motions about its present configuration, per mass.
//
//   A = M^-1/2 (c_R R + c_K K) M^-1/2,  six rows for each particle: velocity and spin.
// R is the resistance: lubrication, drag, damping of contacts. K is the stiffness: springs of contacts along
// n and, as if every contact stuck, tangential and rolling ones, and the curvature of conservative laws. Both
// are symmetric and positive semidefinite: forces that push also turn with n, which only makes the packing
// softer across n (by F/r), and attraction curves to the other side; left out, K is a bound.
struct MatrixWeights {
  double resistance = 0, stiffness = 0;  // c_R, c_K
};

class PackingMatrix {
 public:
  PackingMatrix(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                const MatrixWeights& weights);

  Eigen::Index rows() const { return 3 * drag_rate_.size(); }

  // A vector; particle i has rows 6 i ... 6 i + 5.
  Eigen::VectorXd operator*(const Eigen::VectorXd& vector) const;

 private:
  // Springs couple velocities and spins of a pair in the same form as lubrication does.
  struct Link {
    std::uint32_t first, second;
    PairGeometry shape;
    PairResistance coupling;
  };

  // Of the velocity and of the spin of each particle in turn.
  Eigen::VectorXd per_root_inertia_;  // 1 / sqrt(m), 1 / sqrt(I)
  Eigen::VectorXd drag_rate_;         // c_R zeta / m, c_R zeta_r / I
  std::vector<Link> links_;
};

// There is an eigenvalue within `residual` of `value`, which is at most the largest one.
struct SpectralBound {
  double value = 0, residual = 0;
  int iterations = 0;

  // Not below the largest eigenvalue, unless the iterations have taken another one for it: modes of a packing
  // sit on few spheres, and may not have been met yet. Then it is too low by some thousandths
  // (tests/engine/integrators/spectral_bound_test.cpp).
  double upper() const { return value + residual; }
};

// Iterates from a fixed random vector until the residual is below `tolerance` times the value. The same
// matrix gives the same bits.
SpectralBound largest_eigenvalue(const PackingMatrix& matrix, double tolerance = 0.01);

}  // namespace peclet::engine
