// The viscosity of a suspension at rest, by linear response, without an approximation but those of the step,
// of the number of particles and of the window.
//
// With the flux of momentum J of every step (kernels/pair_pass.h; V J in the sums below), in the five
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
constexpr std::size_t components = 5;

// Up to nearly half of the window.
std::size_t levels_to_half_of(std::uint64_t steps) {
  std::size_t levels = 1;
  while ((std::uint64_t{32} << levels) <= steps) ++levels;
  return levels;
}

// The longest time of the grid up to a sixteenth of the window; half of it and twice as much are there, too.
std::uint64_t plateau_of(std::uint64_t steps) {
  std::uint64_t spacing = 1;
  while (16 * spacing <= steps / 16) spacing *= 2;
  return steps / 16 / spacing * spacing;
}

double lag_time(std::uint64_t lag, double timestep) { return timestep * static_cast<double>(lag); }

// A lag of 0 is one step: a step is correlated with the partner of the one before.
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
    derive({.name = at_rest_name, .symbol = "η_r(0)", .unit = "1"},
           [this] { return background_ + slope(moments(), plateau_time()); });
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
    // The partner of the last step needs the one before it or this one.
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

  // B(t).
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

  // From `from`, which is a time of the curve as its double is.
  double slope(const Curve& moments, double from) const {
    const auto at = [&](double time) {
      const auto place = std::ranges::lower_bound(moments.time, time - 0.5 * timestep_);
      return moments.value[static_cast<std::size_t>(place - moments.time.begin())];
    };
    return (at(2 * from) - at(from)) / from;
  }

  // eta+(0) + integral of (d eta+ / dt) exp(-i w t).
  std::complex<double> viscosity_at(const Curve& moments, double frequency) const {
    using namespace std::complex_literals;
    double last_time = 0, last_moment = 0, last_middle = 0, last_slope = 0;
    std::complex<double> sum = background_;
    for (std::size_t k = 0; k < moments.time.size(); ++k) {
      // Beyond twice the time of the plateau nothing is added.
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
    // The part that acts at once, and half of the first step: trapezia leave out half of their last step.
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
  std::vector<SquaredSums> sums_;         // one for each component, as below
  std::vector<MultipleTau> correlators_;  // of a step and the partner of the one before
  double squares_ = 0;                    // of J, of all components and steps
  std::uint64_t taken_ = 0;
  Parts last_, before_;  // of the last step and the one before
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
              "the viscosity of a fluid at rest, exactly, from the flux of momentum of every step; its "
              "curves over time and frequency",
          .sampling = Sampling::of_every_step,
          .numbers = {at_rest_name, rise_name},
          .read = read_response};
}

}  // namespace peclet::engine
