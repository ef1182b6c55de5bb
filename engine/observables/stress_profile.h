// The stress of the pairs by y, and the balance of momentum, in equal bins of the box along y.
//
// Each pair's stress lies on the line between its centres (Irving & Kirkwood 1950, J. Chem. Phys. 18, 817; as
// the mean over a bin: Cormier, Rickman & Delph 2001, J. Appl. Phys. 89, 99):
//   stress_k = (1 / V_k) sum over pairs of sym(r F_i) l_k,
// l_k the part of the line within bin k. `momentum_flux` is the same of r_y F_i, not made symmetric: what the
// traction on planes y = const is, F on what lies below. Its means over two bins differ by the drag of the
// spheres between them,
//   flux_k - flux_(k-1) = -(1 / A) sum_i F_drag,i t(y_i) = -drag_k,
// t the tent that is 1 at the boundary and 0 a bin's width away, A = Lx Lz, but for inertia, which has no
// mean in steady flow. `imbalance` is the largest |flux_k - flux_(k-1) + drag_k| over the largest |flux_k|.
#pragma once

#include <array>
#include <vector>

#include "engine/averages/blocked_mean.h"
#include "engine/kernels/pair_watcher.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

class StressProfile final : public PairWatcher {
 public:
  StressProfile(const Physics& physics, std::size_t bins);

  // Components of the stress, and of the flux of momentum along y.
  static const Json& stress_components();
  static const Json& flux_components();
  // Terms that pairs have stress of, in the order of the list.
  static std::vector<StressTerm> terms(const Physics& physics);
  // Without noise, whose forces have no drag.
  static bool has_balance(const Physics& physics) { return !(physics.thermal_energy > 0); }

  void begin(const System& system, double weight) override;
  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override;
  // A profile has the stress of pairs only, so the stress of a particle's motion is left out.
  void take_motion(const System& /*system*/, std::size_t /*particle*/,
                   const SymmetricTensor& /*stress*/) override {}
  // Ends the step whose pairs were taken.
  void add_step(std::size_t block);

  void add_to(Json& profiles) const;
  void add_blocks_to(Json& profiles) const;
  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  static constexpr std::size_t count_of_stress_components = 4, count_of_flux_components = 3;
  template <std::size_t components>
  using Rows = std::array<BlockedMean, components>;

  template <class Self, class Function>
  static void for_each(Self& self, Function&& function);
  Json imbalance() const;
  void add_drag(const System& system);

  Physics physics_;
  std::vector<StressTerm> terms_;
  double unit_;
  std::size_t bins_;
  double width_ = 0, area_ = 0, weight_ = 0;
  // Of the step.
  std::vector<SymmetricTensor> step_stress_;  // rows of bins for each term
  std::vector<Vector3> step_flux_, step_drag_;
  // Of the window.
  Rows<count_of_stress_components> stress_;
  std::vector<Rows<count_of_stress_components>> by_term_;
  Rows<count_of_flux_components> flux_, drag_;
};

}  // namespace peclet::engine
