// The stress of each sphere in a step, and the stress of the pairs by term.
//
// V sigma_i of sphere i has half of sym(r F_i) of each pair, the stresslet of the sphere as if alone and,
// with noise, -m sym(v v). V is the volume of the cell, tension is positive, axes are those of the flow.
// Hence
//   total stress = solvent + (1/V) sum_i V sigma_i
#pragma once

#include <vector>

#include "engine/kernels/pair_pass.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

class SphereStress final : public PairWatcher {
 public:
  explicit SphereStress(const Physics& physics) : physics_(physics) {}

  // Forgets the pairs of the last step.
  void clear();

  // Return sums over the step, times V: of the pairs, by term, and of the motion.
  const PairSums& pairs() const { return pairs_; }
  const SymmetricTensor& motion() const { return motion_; }

  // Returns the stresslet of each sphere as if alone, times V, in the order of ids.
  std::vector<SymmetricTensor> stresslets(const System& system) const;
  // Returns what pairs and motion give to V sigma_i, in the order of ids.
  const std::vector<SymmetricTensor>& shares() const { return shares_; }

 private:
  void begin(const System& system, double weight) override;
  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override;
  void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) override;

  Physics physics_;
  double weight_ = 0;
  PairSums pairs_;
  SymmetricTensor motion_;
  std::vector<SymmetricTensor> shares_;
};

}  // namespace peclet::engine
