// The stress over the strain of the production window: how it rises when a flow begins, falls when it is
// reversed or stops. Where the rate of the window is not one and constant, over time.
//
// Each of a number of equal parts of the window has a mean of its own, and no blocks. The stress is the flux
// of momentum that acted in each step (kernels/momentum_flux.h) and what solvent and stresslets add; in units
// of viscosity times rate where that is constant, so that shear_stress is the relative viscosity.
#pragma once

#include <array>
#include <vector>

#include "engine/responses/responses.h"

namespace peclet::engine {

class Transient : public Observable {
 public:
  Transient(const Scene& scene, const System& system, const Window& window);

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override { flux_ = stress_of(flux, has_noise_); }
  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json& /*blocks*/) const override {}
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  struct Part {
    std::array<double, 4> sums{};
    std::uint64_t steps = 0;
  };

  ImposedFlow flow_;
  bool has_noise_;
  double viscosity_, volume_fraction_, volume_, unit_;
  double behind_;  // half a step: the time from its middle, whose rate is the step's mean, to its end
  std::uint64_t steps_, taken_ = 0;
  SymmetricTensor flux_;
  std::vector<Part> parts_;
};

}  // namespace peclet::engine
