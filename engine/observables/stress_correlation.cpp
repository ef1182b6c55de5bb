// Measures the autocorrelation of the structural Brownian stress of a suspension at rest, and its viscosity.
//
//   G(t) = (V / kT) < S(s) S(s + t) >,   eta_B(t) = integral of G from 0 to t   (Green and Kubo)
//
// S are the five independent components of the traceless structural_brownian_stress(), combined so that
// rotations do not matter: xy, xz, yz with weights 1/5 and xx - yy, yy - zz, zz - xx with 1/30. Li's thesis
// (fig. 4.3b) fits
//   eta_B(t) = eta_phi (1 - exp(-t / tau))
//
// The result has `modulus` G in the scene's units and `viscosity` eta_B / eta over the lags `time`, by the
// trapezoidal rule. green_kubo_viscosity is the last value, at up to a quarter of the window.
#include <array>

#include "engine/observables/multiple_tau.h"
#include "engine/observables/observable.h"
#include "engine/observables/structure.h"

namespace peclet::engine {
namespace {

constexpr std::array<double, 6> weights = {1.0 / 5, 1.0 / 5, 1.0 / 5, 1.0 / 30, 1.0 / 30, 1.0 / 30};
constexpr const char* green_kubo_name = "green_kubo_viscosity";

// Returns the number of levels with lags, the longest of 15 2^l samples, up to a quarter of the window.
std::size_t levels_to_a_quarter_of(std::uint64_t samples) {
  std::size_t levels = 1;
  while ((std::uint64_t{60} << levels) <= samples) ++levels;
  return levels;
}

class StressCorrelation : public Observable {
 public:
  // Requires a thermal energy > 0 and a fluid at rest.
  explicit StressCorrelation(const Plan& plan)
      : Observable(plan),
        time_(plan.time_between()),
        thermal_energy_(plan.scene.physics.thermal_energy),
        viscosity_(plan.scene.physics.viscosity),
        volume_(plan.window.volume()),
        kinds_(pair_kinds_in(plan.scene)),
        correlators_(weights.size(), MultipleTau(levels_to_a_quarter_of(plan.samples()))) {
    plan.need_samples("stress_correlation", 16);
    const std::size_t levels = levels_to_a_quarter_of(plan.samples());
    const Axis time = axis_of_lags("time", MultipleTau::lags(levels, plan.samples()), time_);
    beside("stress_correlation/time", time.values);
    derive({.name = "stress_correlation/modulus", .symbol = "G(t)", .unit = "stress", .axes = {time}},
           [this] { return curves().modulus; });
    derive({.name = "stress_correlation/viscosity", .symbol = "η_B(t) / η", .unit = "1", .axes = {time}},
           [this] { return curves().viscosity; });
    derive({.name = green_kubo_name, .symbol = "η_B / η", .unit = "1"},
           [this] { return curves().viscosity.back(); });
    keep(correlators_);
  }

  void sample(const System& system, std::size_t) override {
    const SymmetricTensor s = structural_brownian_stress(system, kinds_, thermal_energy_);
    const std::array<double, 6> values = {s.xy, s.xz, s.yz, s.xx - s.yy, s.yy - s.zz, s.zz - s.xx};
    for (std::size_t c = 0; c < values.size(); ++c) correlators_[c].add(values[c]);
  }

 private:
  struct Curves {
    Json modulus = Json::array(), viscosity = Json::array();
  };

  Curves curves() const {
    Curves curves;
    double before = 0, modulus_before = 0, integral = 0;
    for (const LagMean& value : weighted_sum(correlators_, weights)) {
      const double now = time_ * static_cast<double>(value.lag);
      const double g = volume_ / thermal_energy_ * value.mean;
      integral += 0.5 * (now - before) * (g + modulus_before);
      before = now;
      modulus_before = g;
      curves.modulus.push_back(g);
      curves.viscosity.push_back(integral / viscosity_);
    }
    return curves;
  }

  double time_;  // between samples
  double thermal_energy_, viscosity_, volume_;
  std::vector<PairKind> kinds_;
  std::vector<MultipleTau> correlators_;  // one for each weight
};

}  // namespace

ObservableKind stress_correlation() {
  return {.name = "stress_correlation",
          .meaning = "of the structural Brownian stress of a fluid at rest, and its Green-Kubo viscosity",
          .sampling = Sampling::often,
          .numbers = {green_kubo_name},
          .read = [](const SceneDocument& document, const Scene& scene) {
            require_rest(document, scene, "stress_correlation");
            return maker<StressCorrelation>();
          }};
}

}  // namespace peclet::engine
