#include "engine/responses/stress_correlation.h"

#include <array>

namespace peclet::engine {
namespace {

constexpr std::array<double, 6> weights = {1.0 / 5, 1.0 / 5, 1.0 / 5, 1.0 / 30, 1.0 / 30, 1.0 / 30};

// The longest lag of level l is 15 2^l samples: as many levels as that part of the window has room for.
std::size_t levels_to_a_quarter_of(std::uint64_t samples) {
  std::size_t levels = 1;
  while ((std::uint64_t{60} << levels) <= samples) ++levels;
  return levels;
}

std::vector<Quantity> correlation_quantities(const Scene& scene, const Window& window) {
  const std::uint64_t interval = interval_of(scene, stress_correlation(), window);
  const std::uint64_t samples = samples_in(window.steps, interval);
  const double between = window.timestep * static_cast<double>(interval);
  Axis time{"time", "time", Json::array()};
  for (const std::uint64_t lag : MultipleTau::lags(levels_to_a_quarter_of(samples), samples)) {
    time.values.push_back(between * static_cast<double>(lag));
  }
  return {{.name = "stress_correlation/modulus", .symbol = "G(t)", .unit = "stress", .axes = {time}},
          {.name = "stress_correlation/viscosity", .symbol = "η_B(t) / η", .unit = "1", .axes = {time}},
          {.name = "green_kubo_viscosity", .symbol = "η_B / η", .unit = "1"}};
}

}  // namespace

StressCorrelation::StressCorrelation(const Scene& scene, const System& system, const Window& window)
    : Observable(interval_of(scene, stress_correlation(), window)),
      time_(window.timestep * static_cast<double>(interval())),
      thermal_energy_(scene.physics.thermal_energy),
      viscosity_(scene.physics.viscosity),
      volume_(system.box.volume()),
      kinds_(make_pair_kinds(scene.physics, distinct_radii(system.particles.radius))),
      correlators_(weights.size(),
                   MultipleTau(levels_to_a_quarter_of(samples_in(window.steps, interval())))) {}

void StressCorrelation::sample(const System& system, std::size_t) {
  const SymmetricTensor s = structural_brownian_stress(system, kinds_, thermal_energy_);
  const std::array<double, 6> values = {s.xy, s.xz, s.yz, s.xx - s.yy, s.yy - s.zz, s.zz - s.xx};
  for (std::size_t c = 0; c < values.size(); ++c) correlators_[c].add(values[c]);
}

void StressCorrelation::add_to(Json& mean) const {
  std::vector<MultipleTau::Value> sum = correlators_[0].values();
  for (MultipleTau::Value& value : sum) value.correlation *= weights[0];
  for (std::size_t c = 1; c < correlators_.size(); ++c) {
    const std::vector<MultipleTau::Value> own = correlators_[c].values();
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k].correlation += weights[c] * own[k].correlation;
  }
  Json time = Json::array(), modulus = Json::array(), viscosity = Json::array();
  double before = 0, modulus_before = 0, integral = 0;
  for (const MultipleTau::Value& value : sum) {
    const double now = time_ * static_cast<double>(value.lag);
    const double g = volume_ / thermal_energy_ * value.correlation;
    integral += 0.5 * (now - before) * (g + modulus_before);
    before = now;
    modulus_before = g;
    time.push_back(now);
    modulus.push_back(g);
    viscosity.push_back(integral / viscosity_);
  }
  mean["stress_correlation"] = {{"time", time}, {"modulus", modulus}, {"viscosity", viscosity}};
  mean["green_kubo_viscosity"] = integral / viscosity_;
}

void StressCorrelation::save(ArchiveWriter& archive) const {
  for (const MultipleTau& correlator : correlators_) correlator.save(archive);
}

void StressCorrelation::load(ArchiveReader& archive) {
  for (MultipleTau& correlator : correlators_) correlator.load(archive);
}

ObservableKind stress_correlation() {
  return {"stress_correlation", every_step,
          [](const Scene& scene, const Window& window, const std::string& file) {
            need_samples(scene, stress_correlation(), window, 16, file);
          },
          correlation_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<StressCorrelation>(scene, system, window);
          }};
}

}  // namespace peclet::engine
