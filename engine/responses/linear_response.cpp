#include "engine/responses/linear_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

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

constexpr std::uint64_t least_steps = 512;

double lag_time(std::uint64_t lag, double timestep) { return timestep * static_cast<double>(lag); }

// Of a step and the partner of the one before, a lag of 0 is one step.
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

Axis axis_of(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, unit, values};
}

std::vector<double> times_of(const std::vector<std::uint64_t>& lags, double timestep) {
  std::vector<double> times;
  times.reserve(lags.size());
  for (const std::uint64_t lag : lags) times.push_back(lag_time(lag, timestep));
  return times;
}

std::vector<Quantity> response_quantities(const Scene&, const Window& window) {
  const Axis time =
      axis_of("time", "time",
              times_of(SquaredSums::lengths(levels_to_half_of(window.steps), window.steps), window.timestep));
  const Axis lag = axis_of("lag", "time", times_of(correlation_lags(window.steps), window.timestep));
  const Axis frequency = axis_of("frequency", "1 / time", frequencies(window));
  return {{.name = "zero_shear_viscosity", .symbol = "η_r(0)", .unit = "1"},
          {.name = "zero_shear_rise", .symbol = "rise of η_r(0)", .unit = "1"},
          {.name = "linear_response/viscosity", .symbol = "η(t) / η", .unit = "1", .axes = {time}},
          {.name = "linear_response/correlation", .symbol = "η_GK(t) / η", .unit = "1", .axes = {lag}},
          {.name = "linear_response/modulus", .symbol = "G(t)", .unit = "stress", .axes = {lag}},
          {.name = "linear_response/storage", .symbol = "G'", .unit = "stress", .axes = {frequency}},
          {.name = "linear_response/loss", .symbol = "G''", .unit = "stress", .axes = {frequency}}};
}

}  // namespace

LinearResponse::LinearResponse(const Scene& scene, const System& system, const Window& window)
    : Observable(1),
      timestep_(window.timestep),
      steps_(window.steps),
      plateau_(plateau_of(window.steps)),
      viscosity_(scene.physics.viscosity),
      factor_(1 / (system.box.volume() * scene.physics.viscosity * scene.physics.thermal_energy)),
      background_(1 + stresslet(scene.volume_fraction, {.xy = 1}).xy),
      velocities_are_found_(scene.method == Method::implicit_steps),
      sums_(components, SquaredSums(levels_to_half_of(window.steps))),
      correlators_(components, MultipleTau(levels_to_half_of(window.steps))) {}

LinearResponse::Components LinearResponse::components_of(const SymmetricTensor& s) {
  return {s.xy, s.xz, s.yz, (s.xx - s.yy) / 2, (s.xx + s.yy - 2 * s.zz) / (2 * std::numbers::sqrt3)};
}

void LinearResponse::take_flux(const MomentumFlux& flux) {
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

LinearResponse::Curve LinearResponse::moments() const {
  Curve curve;
  for (const SquaredSums::Value& value : sums_[0].values()) {
    curve.time.push_back(lag_time(value.length, timestep_));
  }
  curve.value.assign(curve.time.size(), 0);
  for (const SquaredSums& sums : sums_) {
    const std::vector<SquaredSums::Value> values = sums.values();
    for (std::size_t k = 0; k < values.size(); ++k) {
      curve.value[k] += 0.5 * factor_ / components * values[k].mean_square;
    }
  }
  return curve;
}

// From `from`, which is a time of the curve as its double is.
double LinearResponse::slope(const Curve& moments, double from) const {
  const auto at = [&](double time) {
    const auto place = std::ranges::lower_bound(moments.time, time - 0.5 * timestep_);
    return moments.value[static_cast<std::size_t>(place - moments.time.begin())];
  };
  return (at(2 * from) - at(from)) / from;
}

// eta+(0) + integral of (d eta+ / dt) exp(-i w t).
std::complex<double> LinearResponse::viscosity_at(const Curve& moments, double frequency) const {
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

void LinearResponse::add_correlation_to(Json& curves) const {
  std::vector<MultipleTau::Value> mean = correlators_[0].values();
  for (std::size_t c = 1; c < components; ++c) {
    const std::vector<MultipleTau::Value> own = correlators_[c].values();
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k].correlation += own[k].correlation;
  }
  // What acts at once, and half of the first step's: trapezia up to a lag leave out half of their ends.
  const double at_once = 0.5 * timestep_ * factor_ * squares_ / static_cast<double>(components * taken_);
  double integral = 0, before = 0, last = 0;
  curves["lag"] = curves["modulus"] = curves["correlation"] = Json::array();
  for (std::size_t k = 0; k < mean.size(); ++k) {
    const double value = factor_ / components * mean[k].correlation;
    const double now = lag_time(mean[k].lag + 1, timestep_);
    integral += k == 0 ? 0.5 * timestep_ * value : 0.5 * (now - before) * (value + last);
    before = now;
    last = value;
    curves["lag"].push_back(now);
    curves["modulus"].push_back(viscosity_ * value);
    curves["correlation"].push_back(background_ + at_once + integral + 0.5 * timestep_ * value);
  }
}

void LinearResponse::add_to(Json& mean) const {
  const Curve curve = moments();
  const double plateau = lag_time(plateau_, timestep_);
  const double found = slope(curve, plateau);
  mean["zero_shear_viscosity"] = background_ + found;
  mean["zero_shear_rise"] = found - slope(curve, 0.5 * plateau);
  Json& curves = mean["linear_response"];
  curves["time"] = curve.time;
  curves["viscosity"] = Json::array();
  for (std::size_t k = 0; k < curve.time.size(); ++k) {
    curves["viscosity"].push_back(background_ + curve.value[k] / curve.time[k]);
  }
  curves["frequency"] = frequencies({.timestep = timestep_, .steps = steps_});
  curves["storage"] = curves["loss"] = Json::array();
  for (const Json& frequency : curves["frequency"]) {
    const double w = frequency.get<double>();
    const std::complex<double> modulus = std::complex<double>(0, w * viscosity_) * viscosity_at(curve, w);
    curves["storage"].push_back(modulus.real());
    curves["loss"].push_back(modulus.imag());
  }
  add_correlation_to(curves);
}

void LinearResponse::save(ArchiveWriter& archive) const {
  for (const SquaredSums& sums : sums_) sums.save(archive);
  for (const MultipleTau& correlator : correlators_) correlator.save(archive);
  archive.put(squares_);
  archive.put(taken_);
  archive.put(last_);
  archive.put(before_);
}

void LinearResponse::load(ArchiveReader& archive) {
  for (SquaredSums& sums : sums_) sums.load(archive);
  for (MultipleTau& correlator : correlators_) correlator.load(archive);
  squares_ = archive.get<double>();
  taken_ = archive.get<std::uint64_t>();
  last_ = archive.get<Parts>();
  before_ = archive.get<Parts>();
}

ObservableKind linear_response() {
  return {"linear_response", every_step,
          [](const Scene&, const Window& window, const std::string& file) {
            if (window.steps >= least_steps) return;
            throw InputError(file, "/duration/production", fmt::format("{} steps", window.steps),
                             fmt::format("must have at least {} steps for linear_response", least_steps));
          },
          response_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<LinearResponse>(scene, system, window);
          }};
}

}  // namespace peclet::engine
