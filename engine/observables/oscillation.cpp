// Measures the stress of an oscillating shear gamma = g sin(w t), in phase with the strain and with the rate.
// In a shear that oscillates across a steady one it is the transverse stress sigma_yz.
//
//   sigma_xy = g sum over n odd of [G'_n sin(n w t) + G''_n cos(n w t)]
//   G'_n = (2 / g T) integral of sigma_xy sin(n w t), G''_n with cos, over whole cycles of length T
// storage_modulus and loss_modulus are those of n = 1, dynamic_viscosity is G''_1 / (eta w), and
// third_storage_modulus and third_loss_modulus are those of n = 3. Moduli are in the units of the scene. The
// stress is the flux of momentum that acted in each step (kernels/pair_pass.h), at the moment that it belongs
// to: the middle of an implicit step, the end of an explicit one. Solvent and stresslets add (1 + 2.5 phi)
// eta w to G'', which is exact. Each of 4, 8, 16 or 32 blocks has whole cycles.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "engine/flow/flow_kind.h"
#include "engine/observables/observable.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

const Quantity moduli[] = {{"storage_modulus", "G'", "stress"},
                           {"loss_modulus", "G''", "stress"},
                           {"dynamic_viscosity", "η' / η", "1"},
                           {"third_storage_modulus", "G'_3", "stress"},
                           {"third_loss_modulus", "G''_3", "stress"}};

// Returns the number of equal blocks of a window of `cycles`: a power of two, with at least a cycle in each.
// Fewer than four cycles give no blocks, because the test for transients compares quarters.
std::size_t blocks_of_cycles(std::uint64_t cycles) {
  const std::size_t blocks = std::bit_floor(std::min<std::uint64_t>(cycles, count_of_blocks));
  return blocks < count_of_quarters ? 0 : blocks;
}

class Oscillation : public Observable {
 public:
  // Requires an oscillating flow, whole cycles before and in the window, and steps that divide a cycle.
  explicit Oscillation(const Plan& plan)
      : Observable(plan),
        volume_(plan.window.volume()),
        swing_(*plan.scene.physics.flow.deformation().swing()),
        solvent_(plan.scene.physics.viscosity * swing_.frequency),
        background_(solvent_ * (1 + stresslet(plan.scene.volume_fraction, {.xy = 1}).xy)),
        steps_of_cycle_(static_cast<std::uint64_t>(
            std::llround(*plan.scene.physics.flow.period() / plan.window.timestep))),
        cycles_(plan.window.steps / steps_of_cycle_),
        ahead_(plan.scene.method == Method::implicit_steps ? 0.5 : 1.0) {
    for (const Quantity& modulus : moduli) {
      means_.push_back(&mean_if(true, modulus, blocks_of_cycles(cycles_)));
    }
    keep(taken_, cycle_);
  }

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override {
    const double in_cycle = static_cast<double>(taken_ % steps_of_cycle_) + ahead_;
    const double phase = 2 * std::numbers::pi * in_cycle / static_cast<double>(steps_of_cycle_);
    const double part = 2 * flux.acted().*swing_.component /
                        (volume_ * swing_.amplitude * static_cast<double>(steps_of_cycle_));
    cycle_[0].storage += part * std::sin(phase);
    cycle_[0].loss += part * std::cos(phase);
    cycle_[1].storage += part * std::sin(3 * phase);
    cycle_[1].loss += part * std::cos(3 * phase);
    ++taken_;
    if (taken_ % steps_of_cycle_ == 0) end_cycle();
  }

 private:
  struct Modulus {
    double storage = 0, loss = 0;
  };

  void end_cycle() {
    const auto block = static_cast<std::size_t>((taken_ / steps_of_cycle_ - 1) * count_of_blocks / cycles_);
    const double loss = background_ + cycle_[0].loss;
    const double values[] = {cycle_[0].storage, loss, loss / solvent_, cycle_[1].storage, cycle_[1].loss};
    for (std::size_t k = 0; k < means_.size(); ++k) {
      means_[k]->add(block, 0, values[k]);
      means_[k]->weigh(block, 1);
    }
    cycle_ = {};
  }

  double volume_;
  Swing swing_;
  double solvent_;     // eta w
  double background_;  // part of solvent and stresslets in G''
  std::uint64_t steps_of_cycle_, cycles_;
  double ahead_;  // moment that the flux of a step belongs to, in steps after its beginning
  std::uint64_t taken_ = 0;
  std::array<Modulus, 2> cycle_{};  // sums of this cycle, n = 1 and 3
  std::vector<BlockedMean*> means_;
};

}  // namespace

ObservableKind oscillation() {
  std::vector<std::string> names;
  for (const Quantity& modulus : moduli) names.push_back(modulus.name);
  return {.name = "oscillation",
          .meaning =
              "G' and G'' of an oscillating shear, and the third harmonic of the stress; with "
              "cross_shear those of the transverse stress",
          .sampling = Sampling::of_every_step,
          .numbers = names,
          .read = [](const SceneDocument& document, const Scene& scene) {
            if (!scene.physics.flow.period()) {
              document.refuse("/observables", "must not list oscillation without {}", flows_with("cycles"));
            }
            require_stress_of_forces(document, scene, "oscillation");
            return maker<Oscillation>();
          }};
}

}  // namespace peclet::engine
