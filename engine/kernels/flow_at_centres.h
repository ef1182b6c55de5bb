// What varies of the flow within the cell, at the centres of all particles, for lubrication that is relative
// to the flow: without Faxen's corrections, which belong to single spheres.
#pragma once

#include "engine/flow/background_flow.h"
#include "engine/kernels/pairs/pair_kernels.h"
#include "engine/state/particles.h"

namespace peclet::engine {

class FlowAtCentres {
 public:
  FlowAtCentres() = default;
  FlowAtCentres(std::size_t particles, int threads)
      : velocity_(particles, threads),
        spin_(particles, threads),
        strain_along_(particles, threads),
        strain_across_(particles, threads) {}

  std::size_t size() const { return velocity_.size(); }

  // Of particles [begin, end) where they are now.
  void set(const BackgroundFlow& flow, const ParticleState& particles, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [velocity, spin, strain] = flow.varying_at(particles.position[i]);
      velocity_.set(i, velocity);
      spin_.set(i, spin);
      strain_along_.set(i, {strain.xx, strain.yy, strain.zz});
      strain_across_.set(i, {strain.xy, strain.xz, strain.yz});
    }
  }

  FlowRows rows() const {
    return {velocity_.data(), spin_.data(), strain_along_.data(), strain_across_.data()};
  }

 private:
  VectorField velocity_, spin_, strain_along_, strain_across_;
};

}  // namespace peclet::engine
