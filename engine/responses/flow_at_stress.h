// The rate of a flow at a given stress, and whether it has flowed to the end.
//
// A realisation that has jammed stands still for the rest of its window, and counts so: shear_rate is the
// strain over the time of the whole window, flowing is 0. Over seeds the mean of `flowing` is the share that
// flows. Viscosities are stress over mean rate, never a mean of stress over rate:
//   apparent_viscosity            stress / (viscosity <rate>)
//   viscosity_of_those_flowing    the same of the realisations that flow to the end
#pragma once

#include <array>

#include "engine/averages/blocked_mean.h"
#include "engine/responses/responses.h"

namespace peclet::engine {

class FlowAtStress : public Observable {
 public:
  FlowAtStress(const Scene& scene, const Window& window);

  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json& blocks) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  double stress_, viscosity_;
  std::uint64_t steps_, taken_ = 0;
  std::array<double, count_of_blocks> rates_{};  // sums over the steps of each block
};

}  // namespace peclet::engine
