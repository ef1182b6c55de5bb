// Autocorrelation of the structural Brownian stress of a suspension at rest, and the viscosity that follows.
//
//   G(t) = (V / kT) < S(s) S(s + t) >,   eta_B(t) = integral of G from 0 to t   (Green and Kubo)
//
// S are the five independent components of the traceless stress, in the combination that every rotation
// leaves alone: xy, xz, yz with weights 1/5 and xx - yy, yy - zz, zz - xx with 1/30. The stress is that of
// structural_brownian_stress(); Li's thesis, section 4.3 (fig. 4.3b), fits eta_B(t) with eta_phi (1 -
// exp(-t / tau)).
//
// The result has `modulus` G in the scene's units and `viscosity` eta_B / eta, by the trapezoidal rule over
// the lags `time`; green_kubo_viscosity is the last of them, up to a quarter of a window of 60 samples or
// more.
#pragma once

#include <array>

#include "engine/averages/multiple_tau.h"
#include "engine/observables/structure.h"
#include "engine/responses/responses.h"

namespace peclet::engine {

class StressCorrelation : public Observable {
 public:
  // Requires a thermal energy > 0 and a fluid at rest.
  StressCorrelation(const Scene& scene, const System& system, const Window& window);

  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json&) const override {}
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  double time_;  // between samples
  double thermal_energy_, viscosity_, volume_;
  std::vector<PairKind> kinds_;
  std::vector<MultipleTau> correlators_;  // six
};

}  // namespace peclet::engine
