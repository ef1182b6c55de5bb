// Measures the viscosity of a suspension at rest by linear response. It is exact up to the errors of the
// step, the number of particles and the window.
//
// J is the flux of momentum of every step (kernels/pair_pass.h). The five independent components of its
// traceless part, xy, xz, yz, (xx - yy)/2 and (xx + yy - 2 zz)/(2 sqrt 3), count alike. The response eta+(t)
// to a shear that begins at time 0 follows from Helfand's moment B (Phys. Rev. 119, 1 (1960)):
//   B(t) = 1/(2 V eta kT) < (integral over t of V J)^2 > = integral of eta+ - 1 - 2.5 phi from 0 to t
//   eta(t) = 1 + 2.5 phi + B(t) / t -> eta_r at rest
// J includes the random forces: their squares are the viscosity at high frequency, and their effect on later
// forces must not be lost.
//
// `viscosity` is eta(t) at the times `time`. `zero_shear_viscosity`, and `relative_viscosity`, is the slope
//   1 + 2.5 phi + (B(2t) - B(t))/t
// with the longest time t of the grid up to a sixteenth of the window. It reaches the plateau earlier than
// eta(t), which includes the rise at short times. `zero_shear_rise` is this slope minus the one from t/2 to
// t; the window is too short if it is not zero within its error.
//
// The Green-Kubo form of the same number is a check. It correlates with a partner under time reversal (Ernst
// & Brito, Europhys. Lett. 73, 183 (2006); Jung & Schmid, J. Chem. Phys. 144, 204104 (2016)), in discrete
// steps
//   eta_r = 1 + 2.5 phi + dt/(V eta kT) [ < J_0^2 >/2 + sum over k > 0 of < (C + D)_k (C_0 - D_0') > ]
// with J for V J here, its conservative part C and its dissipative part D. D' has the velocities on the other
// side of the step: it is D_-1 if a step finds the velocities that its forces feel (implicit), and D_1 if it
// is given them (explicit). `correlation` is eta up to the lag. `modulus` is the correlation times V/kT: G(t)
// without the instantaneous part.
//
// `storage` G' and `loss` G'' are i w eta eta*(w), solvent included, in the scene's units. `frequency` w runs
// from 1 over eight steps down to 1 over the plateau's time t. eta* is the transform of the step response,
// which is linear between its values at the middle of two times.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "contract/errors.h"
#include "engine/observables/multiple_tau.h"
#include "engine/observables/observable.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

constexpr const char *at_rest_name = "zero_shear_viscosity", *rise_name = "zero_shear_rise";
// In slow flow this is a mean of the stress; at rest it is the limit.
constexpr const char* viscosity_name = "relative_viscosity";
constexpr std::size_t components = 5;

// Returns the number of levels that have lags up to nearly half of the window.
std::size_t levels_to_half_of(std::uint64_t steps) {
  std::size_t levels = 1;
  while ((std::uint64_t{32} << levels) <= steps) ++levels;
  return levels;
}

// Returns the longest grid time [steps] up to a sixteenth of the window; its half and double are grid times.
std::uint64_t plateau_of(std::uint64_t steps) {
  std::uint64_t spacing = 1;
  while (16 * spacing <= steps / 16) spacing *= 2;
  return steps / 16 / spacing * spacing;
}

double lag_time(std::uint64_t lag, double timestep) { return timestep * static_cast<double>(lag); }

// Returns the lags [steps]. They begin at 1: a step is correlated with the partner of the step before.
std::vector<std::uint64_t> correlation_lags(std::uint64_t steps) {
  std::vector<std::uint64_t> lags = MultipleTau::lags(levels_to_half_of(steps), steps - 2);
  for (std::uint64_t& lag : lags) ++lag;
  return lags;
}

std::vector<double> frequencies(const Window& window) {
  std::vector<double> found;
  for (std::uint64_t steps = 8; steps <= plateau_of(window.steps); steps *= 2) {
    found.push_back(1 / lag_time(steps, window.timestep));
  }
  return found;
}

class LinearResponse : public Observable {
 public:
  // Requires a thermal energy > 0 and a fluid at rest.
  explicit LinearResponse(const Plan& plan)
      : Observable(plan),
        timestep_(plan.window.timestep),
        plateau_(plateau_of(plan.window.steps)),
        viscosity_(plan.scene.physics.viscosity),
        factor_(1 /
                (plan.window.volume() * plan.scene.physics.viscosity * plan.scene.physics.thermal_energy)),
        background_(1 + stresslet(plan.scene.volume_fraction, {.xy = 1}).xy),
        velocities_are_found_(plan.scene.method == Method::implicit_steps),
        sums_(components, SquaredSums(levels_to_half_of(plan.window.steps))),
        correlators_(components, MultipleTau(levels_to_half_of(plan.window.steps))) {
    constexpr std::uint64_t least_steps = 512;
    if (plan.window.steps < least_steps) {
      throw InputError(plan.file, "/duration/production", fmt::format("{} steps", plan.window.steps),
                       fmt::format("must have at least {} steps for linear_response", least_steps));
    }
    keep(sums_, correlators_, squares_, taken_, last_, before_);
    const auto at_rest = [this] { return background_ + slope(moments(), plateau_time()); };
    derive({.name = at_rest_name, .symbol = "η_r(0)", .unit = "1"}, at_rest);
    derive({.name = viscosity_name, .symbol = "η_r", .unit = "1"}, at_rest);
    derive({.name = rise_name, .symbol = "rise of η_r(0)", .unit = "1"}, [this] {
      const Curve curve = moments();
      return slope(curve, plateau_time()) - slope(curve, 0.5 * plateau_time());
    });
    register_curves(plan.window);
  }

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override {
    const Components acted = components_of(flux.acted());
    const Parts now = {components_of(flux.conservative), components_of(flux.dissipative)};
    // The partner of the last step needs the step before it or the present step.
    const Parts& other = velocities_are_found_ ? before_ : now;
    for (std::size_t c = 0; c < components; ++c) {
      sums_[c].add(timestep_ * acted[c]);
      squares_ += acted[c] * acted[c];
      if (taken_ >= 2) {
        correlators_[c].add(now.conservative[c] + now.dissipative[c],
                            last_.conservative[c] - other.dissipative[c]);
      }
    }
    ++taken_;
    before_ = last_;
    last_ = now;
  }

 private:
  using Components = std::array<double, components>;
  struct Parts {
    Components conservative{}, dissipative{};
  };
  struct Curve {
    std::vector<double> time, value;
  };
  struct Correlation {
    Json modulus = Json::array(), viscosity = Json::array();
  };

  static Components components_of(const SymmetricTensor& s) {
    return {s.xy, s.xz, s.yz, (s.xx - s.yy) / 2, (s.xx + s.yy - 2 * s.zz) / (2 * std::numbers::sqrt3)};
  }
  double plateau_time() const { return lag_time(plateau_, timestep_); }

  void register_curves(const Window& window) {
    const std::size_t levels = levels_to_half_of(window.steps);
    const Axis time = axis_of_lags("time", SquaredSums::lengths(levels, window.steps), timestep_);
    const Axis lag = axis_of_lags("lag", correlation_lags(window.steps), timestep_);
    const Axis frequency{"frequency", "1 / time", frequencies(window)};
    for (const Axis* const axis : {&time, &lag, &frequency}) {
      beside("linear_response/" + axis->name, axis->values);
    }
    const auto curve = [&](const char* name, const char* symbol, const char* unit, const Axis& axis,
                           const Numbers& value) {
      derive({.name = std::string("linear_response/") + name, .symbol = symbol, .unit = unit, .axes = {axis}},
             value);
    };
    curve("viscosity", "η(t) / η", "1", time, [this] { return step_response(); });
    curve("correlation", "η_GK(t) / η", "1", lag, [this] { return correlation().viscosity; });
    curve("modulus", "G(t)", "stress", lag, [this] { return correlation().modulus; });
    curve("storage", "G'", "stress", frequency,
          [=, this] { return moduli(frequency, [](const std::complex<double>& g) { return g.real(); }); });
    curve("loss", "G''", "stress", frequency,
          [=, this] { return moduli(frequency, [](const std::complex<double>& g) { return g.imag(); }); });
  }

  // Returns B(t).
  Curve moments() const {
    Curve curve;
    for (const LagMean& value : sums_[0].values()) curve.time.push_back(lag_time(value.lag, timestep_));
    curve.value.assign(curve.time.size(), 0);
    for (const SquaredSums& sums : sums_) {
      const std::vector<LagMean> values = sums.values();
      for (std::size_t k = 0; k < values.size(); ++k) {
        curve.value[k] += 0.5 * factor_ / components * values[k].mean;
      }
    }
    return curve;
  }

  Json step_response() const {
    const Curve curve = moments();
    Json viscosity = Json::array();
    for (std::size_t k = 0; k < curve.time.size(); ++k) {
      viscosity.push_back(background_ + curve.value[k] / curve.time[k]);
    }
    return viscosity;
  }

  // Returns the slope between `from` and twice `from`, which must be times of the curve.
  double slope(const Curve& moments, double from) const {
    const auto at = [&](double time) {
      const auto place = std::ranges::lower_bound(moments.time, time - 0.5 * timestep_);
      return moments.value[static_cast<std::size_t>(place - moments.time.begin())];
    };
    return (at(2 * from) - at(from)) / from;
  }

  // Returns eta*(w) = eta+(0) + integral of (d eta+ / dt) exp(-i w t).
  std::complex<double> viscosity_at(const Curve& moments, double frequency) const {
    using namespace std::complex_literals;
    double last_time = 0, last_moment = 0, last_middle = 0, last_slope = 0;
    std::complex<double> sum = background_;
    for (std::size_t k = 0; k < moments.time.size(); ++k) {
      // The integral ends at twice the lag time of the plateau.
      if (moments.time[k] > lag_time(2 * plateau_, timestep_) + 0.5 * timestep_) break;
      const double slope = (moments.value[k] - last_moment) / (moments.time[k] - last_time);
      if (k == 0) {
        sum += slope;
      } else {
        const double middle = 0.5 * (last_time + moments.time[k]);
        const auto factor_at = [&](double time) { return std::exp(-1i * frequency * time); };
        const std::complex<double> mean =
            (factor_at(middle) - factor_at(last_middle)) / (-1i * frequency * (middle - last_middle));
        sum += (slope - last_slope) * mean;
        last_middle = middle;
      }
      last_slope = slope;
      last_time = moments.time[k];
      last_moment = moments.value[k];
    }
    return sum;
  }

  template <class Part>
  Json moduli(const Axis& frequency, const Part& part) const {
    const Curve curve = moments();
    Json values = Json::array();
    for (const Json& at : frequency.values) {
      const double w = at.get<double>();
      values.push_back(part(std::complex<double>(0, w * viscosity_) * viscosity_at(curve, w)));
    }
    return values;
  }

  Correlation correlation() const {
    Correlation curves;
    constexpr std::array<double, components> alike = {1, 1, 1, 1, 1};
    const std::vector<LagMean> mean = weighted_sum(correlators_, alike);
    // The instantaneous part. Trapezia leave out half of the first and of the last step, added below.
    const double at_once = 0.5 * timestep_ * factor_ * squares_ / static_cast<double>(components * taken_);
    double integral = 0, before = 0, last = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) {
      const double value = factor_ / components * mean[k].mean;
      const double now = lag_time(mean[k].lag + 1, timestep_);
      integral += k == 0 ? 0.5 * timestep_ * value : 0.5 * (now - before) * (value + last);
      before = now;
      last = value;
      curves.modulus.push_back(viscosity_ * value);
      curves.viscosity.push_back(background_ + at_once + integral + 0.5 * timestep_ * value);
    }
    return curves;
  }

  double timestep_;
  std::uint64_t plateau_;                   // the time t of the plateau in steps
  double viscosity_, factor_, background_;  // factor: 1 / (V eta kT); background: 1 + 2.5 phi
  bool velocities_are_found_;
  std::vector<SquaredSums> sums_;         // one for each component
  std::vector<MultipleTau> correlators_;  // for each component: of a step with the partner of the step before
  double squares_ = 0;                    // sum of (V J)^2 over components and steps
  std::uint64_t taken_ = 0;
  Parts last_, before_;  // the last step and the step before
};

MakeFromPlan read_response(const SceneDocument& document, const Scene& scene) {
  require_rest(document, scene, "linear_response");
  if (const std::string reason = lacking_equilibrium(scene.physics); !reason.empty()) {
    document.refuse("/observables", "must not list linear_response with {}", reason);
  }
  return maker<LinearResponse>();
}

}  // namespace

ObservableKind linear_response() {
  return {.name = "linear_response",
          .meaning =
              "the exact viscosity of a fluid at rest from the momentum flux of every step, with curves over "
              "time and frequency",
          .sampling = Sampling::of_every_step,
          .numbers = {at_rest_name, rise_name, viscosity_name},
          .read = read_response};
}

}  // namespace peclet::engine
