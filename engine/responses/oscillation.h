// The stress of an oscillating shear gamma = g sin(w t), in phase with the strain and with the rate; of a
// shear that oscillates across a steady one the stress across, sigma_yz.
//
//   sigma_xy = g sum over n odd of [G'_n sin(n w t) + G''_n cos(n w t)]
//   G'_n = (2 / g T) integral of sigma_xy sin(n w t), G''_n with cos, over whole cycles of length T
// storage_modulus and loss_modulus are those of n = 1, dynamic_viscosity is G'' / (eta w); of n = 3 there are
// third_storage_modulus and third_loss_modulus. All in the units of the scene. The stress is the flux of
// momentum that acted in each step (kernels/momentum_flux.h), at the moment that it belongs to: the middle of
// an implicit step, the end of an explicit one. What solvent and stresslets add, 1 + 2.5 phi times eta w, is
// exact. Blocks have whole cycles: 4, 8, 16 or 32 of them, as many as there are cycles for.
#pragma once

#include <array>
#include <vector>

#include "engine/averages/blocked_mean.h"
#include "engine/responses/responses.h"

namespace peclet::engine {

class Oscillation : public Observable {
 public:
  // Requires a flow that oscillates, a window of whole cycles after whole cycles, and steps that divide one.
  Oscillation(const Scene& scene, const System& system, const Window& window);

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override;
  void sample(const System& /*system*/, std::size_t /*block*/) override {}
  void add_to(Json& mean) const override;
  void add_blocks_to(Json& blocks) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  struct Modulus {
    double storage = 0, loss = 0;
  };
  std::size_t block_of_cycle() const;
  void end_cycle();

  double volume_;
  Swing swing_;
  double solvent_;     // eta w
  double background_;  // of G''
  std::uint64_t steps_of_cycle_, cycles_;
  double ahead_;  // of the beginning of a step, in steps: the moment that its flux belongs to
  std::uint64_t taken_ = 0;
  std::array<Modulus, 2> cycle_{};  // sums of this cycle, n = 1 and 3
  std::array<BlockedMean, 5> means_;
};

}  // namespace peclet::engine
