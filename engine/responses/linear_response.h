// The viscosity of a suspension at rest, by linear response, without an approximation but those of the step,
// of the number of particles and of the window.
//
// With the flux of momentum J of every step (kernels/momentum_flux.h; V J in the sums below), in the five
// independent components xy, xz, yz, (xx - yy)/2, (xx + yy - 2 zz)/(2 sqrt 3) of its traceless part, which
// count alike, a step response t -> eta+(t) to a shear that begins at 0 follows from Helfand's moment:
//   B(t) = 1/(2 V eta kT) < (integral over t of V J)^2 > = integral of eta+ - 1 - 2.5 phi from 0 to t,
//   eta(t) = 1 + 2.5 phi + B(t) / t -> eta_r at rest.
// Helfand, Phys. Rev. 119, 1 (1960). The random forces are in J: their squares are the viscosity at high
// frequency, and what they do to later forces must not be lost.
//
// `viscosity` is eta(t) at the times `time`. `zero_shear_viscosity` is the slope 1 + 2.5 phi + (B(2t) -
// B(t))/t at a sixteenth t of the window (the longest time of the grid up to there), which has the plateau
// where eta(t) still has what was missing at short times. `zero_shear_rise` is that slope less the one from
// t/2 to t: where it is not zero within its error, the window is too short.
//
// Green and Kubo's form of the same number, as a check, has a partner under reversal of time (Ernst & Brito,
// Europhys. Lett. 73, 183 (2006); Jung & Schmid, J. Chem. Phys. 144, 204104 (2016)), in discrete steps
//   eta_r = 1 + 2.5 phi + dt/(V eta kT) [ < J_0^2 >/2 + sum over k > 0 of < (C + D)_k (C_0 - D_0') > ],
// with the conservative part C and the dissipative one D of V J; D' is that of the velocities on the other
// side of the step, which is D_-1 where a step finds the velocities that its forces feel (implicit), D_1
// where it is given them (explicit). `correlation` is eta up to the lag, `modulus` the correlation times
// V/kT: G(t) without what the random forces do at once.
//
// `storage` G' and `loss` G'' at `frequency` w, from 1 over eight steps down to 1 over the plateau's time, in
// the scene's units, solvent included: i w eta eta*(w) with eta* of the step response between whose values at
// the middle of two times lines are drawn.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "engine/averages/multiple_tau.h"
#include "engine/averages/squared_sums.h"
#include "engine/responses/responses.h"

namespace peclet::engine {

class LinearResponse : public Observable {
 public:
  static constexpr std::size_t components = 5;

  // Requires a thermal energy > 0 and a fluid at rest.
  LinearResponse(const Scene& scene, const System& system, const Window& window);

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override;
  void sample(const System& /*system*/, std::size_t /*block*/) override {}
  void add_to(Json& mean) const override;
  void add_blocks_to(Json&) const override {}
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  using Components = std::array<double, components>;
  struct Parts {
    Components conservative{}, dissipative{};
  };
  struct Curve {
    std::vector<double> time, value;
  };
  static Components components_of(const SymmetricTensor& tensor);

  Curve moments() const;  // B(t)
  double slope(const Curve& moments, double from) const;
  std::complex<double> viscosity_at(const Curve& moments, double frequency) const;
  void add_correlation_to(Json& curves) const;

  double timestep_;
  std::uint64_t steps_, plateau_;           // of the window, and the time t of the plateau in steps
  double viscosity_, factor_, background_;  // 1 / (V eta kT), 1 + 2.5 phi
  bool velocities_are_found_;
  std::vector<SquaredSums> sums_;         // one for each component, as below
  std::vector<MultipleTau> correlators_;  // of a step and the partner of the one before
  double squares_ = 0;                    // of J, of all components and steps
  std::uint64_t taken_ = 0;
  Parts last_, before_;  // of the last step and the one before
};

}  // namespace peclet::engine
