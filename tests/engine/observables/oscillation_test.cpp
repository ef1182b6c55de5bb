// Moduli of known stresses, and of suspensions with known viscosity.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/realisation/stress_means.h"
#include "tests/engine/observables/loose_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

constexpr double amplitude = 0.2, frequency = 3;

Scene oscillating(const char* method, std::uint64_t cycles) {
  Json document = small_scene();
  document["flow"] = {{"oscillation", {{"amplitude", amplitude}, {"frequency", frequency}}}};
  document["integrator"] = {{"method", method}};
  document["duration"] = {{"equilibration", {{"cycles", 0}}}, {"production", {{"cycles", cycles}}}};
  document["observables"] = {"oscillation"};
  return read_scene(document, "scene.json");
}

// Returns the observable of spheres whose pairs have the stress sigma_xy(k, w t) in step k, at the middle of
// implicit steps and at the end of explicit ones. The flux is sigma times the volume.
template <class Stress>
std::unique_ptr<Observable> after_stress(const Scene& scene, std::uint64_t steps_per_cycle,
                                         std::uint64_t cycles, const Stress& stress) {
  const double timestep = 2 * std::numbers::pi / frequency / static_cast<double>(steps_per_cycle);
  const double volume = edge * edge * edge, ahead = scene.method == Method::implicit_steps ? 0.5 : 1;
  auto made = observable_of(scene, loose_spheres(4), steps_per_cycle * cycles, timestep);
  for (std::uint64_t k = 0; k < steps_per_cycle * cycles; ++k) {
    MomentumFlux flux;
    flux.by_pairs.xy = volume * stress(k, frequency * timestep * (static_cast<double>(k) + ahead));
    made->take_flux(flux);
  }
  return made;
}

class Moduli : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(EitherMethod, Moduli, testing::Values("explicit", "implicit"),
                         [](const auto& method) { return std::string(method.param); });

// sigma = g [(1 + cycle) sin + 5 cos + 2 sin 3 + 3 cos 3] in each of four cycles.
TEST_P(Moduli, AreThoseOfAStressThatIsASumOfHarmonics) {
  constexpr std::uint64_t steps = 200, cycles = 4;
  const auto made =
      after_stress(oscillating(GetParam(), cycles), steps, cycles, [](std::uint64_t k, double phase) {
        const std::uint64_t cycle = k / steps;
        return amplitude * ((1 + static_cast<double>(cycle)) * std::sin(phase) + 5 * std::cos(phase) +
                            2 * std::sin(3 * phase) + 3 * std::cos(3 * phase));
      });
  const Json mean = mean_of(*made);
  // eta = 0.1, phi = 0.45.
  const double background = 0.1 * frequency * (1 + 2.5 * 0.45);
  EXPECT_NEAR(mean["storage_modulus"].get<double>(), (1 + 2 + 3 + 4) / 4.0, 1e-12);
  EXPECT_NEAR(mean["loss_modulus"].get<double>(), 5 + background, 1e-12);
  EXPECT_NEAR(mean["dynamic_viscosity"].get<double>(), (5 + background) / (0.1 * frequency), 1e-11);
  EXPECT_NEAR(mean["third_storage_modulus"].get<double>(), 2, 1e-12);
  EXPECT_NEAR(mean["third_loss_modulus"].get<double>(), 3, 1e-12);
  const Json blocks = blocks_of(*made);
  ASSERT_EQ(blocks["storage_modulus"].size(), cycles);
  for (std::size_t block = 0; block < cycles; ++block) {
    EXPECT_NEAR(blocks["storage_modulus"][block].get<double>(), 1 + static_cast<double>(block), 1e-4);
  }
}

// The storage modulus is 1 + cycle. Every block has a cycle, so that the first ones show the transient.
TEST(Moduli, HaveAsManyBlocksAsTheirCyclesFill) {
  constexpr std::uint64_t steps = 64;
  for (const std::uint64_t cycles : {3U, 4U, 7U, 12U, 31U, 32U, 50U, 100U}) {
    const auto made =
        after_stress(oscillating("implicit", cycles), steps, cycles, [](std::uint64_t k, double phase) {
          const std::uint64_t cycle = k / steps;
          return amplitude * (1 + static_cast<double>(cycle)) * std::sin(phase);
        });
    const Json blocks = blocks_of(*made);
    if (cycles < 4) {
      EXPECT_TRUE(blocks.empty());
      continue;
    }
    const Json& values = blocks["storage_modulus"];
    EXPECT_EQ(values.size() % 4, 0u) << cycles;
    EXPECT_GT(2 * values.size(), std::min<std::uint64_t>(cycles, 32)) << cycles;
    double sum = 0;
    for (const Json& value : values) {
      ASSERT_TRUE(value.is_number()) << cycles;
      sum += value.get<double>();
    }
    // Blocks of unequal numbers of cycles deviate from the mean of all cycles by at most half a cycle.
    EXPECT_NEAR(sum / static_cast<double>(values.size()), 0.5 * static_cast<double>(cycles + 1), 0.5)
        << cycles;
  }
}

// At small amplitude inertialess spheres respond with the viscosity of steady shear from the same packing.
// The in-phase part is inertia alone, and there is no third harmonic.
TEST(Moduli, OfASmallOscillationAreTheViscosityOfThePacking) {
  const auto run = [](const Json& patch) {
    Json document = Json::parse(
        R"({"particles": {"count": 60, "density": 0.001, "species": [{"radius": 1, "volume_share": 1}]},
        "volume_fraction": 0.4, "seeds_in_common": true, "fluid": {"viscosity": 0.1},
        "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
        "integrator": {"method": "implicit", "tolerance": 1e-6}})");
    document.update(patch);
    const Scene scene = read_scene(document, "scene.json");
    auto simulation = std::make_unique<Simulation>(started(scene, 5));
    EXPECT_TRUE(simulation->advance(1000000).has_value());
    return std::pair(scene, std::move(simulation));
  };
  const auto [steady, sheared] = run(Json::parse(R"({"flow": {"shear_rate": 1e-6}, "observables": ["stress"],
      "duration": {"equilibration": {"strain": 0}, "production": {"strain": 1e-6}}})"));
  const double viscosity = StressMeans(steady)
                               .means(sheared->system(), sum_of(sheared->production().blocks()))
                               .at("relative_viscosity")
                               .get<double>();
  const auto [scene, oscillated] = run(Json::parse(R"({
      "flow": {"oscillation": {"amplitude": 1e-6, "frequency": 1}}, "observables": ["stress", "oscillation"],
      "duration": {"equilibration": {"cycles": 0}, "production": {"cycles": 2}}})"));
  const Json means =
      StressMeans(scene).means(oscillated->system(), sum_of(oscillated->production().blocks()));
  EXPECT_TRUE(means.at("relative_viscosity").is_null());  // oscillating stress
  const Json mean = mean_of(*oscillated->observables().front());
  EXPECT_GT(viscosity, 2.2);  // pairs contribute: 1 + 2.5 phi is 2
  EXPECT_NEAR(mean["dynamic_viscosity"].get<double>(), viscosity, 1e-3 * (viscosity - 2));
  // w rho a^2 / eta = 0.01.
  EXPECT_LT(std::abs(mean["storage_modulus"].get<double>()), 0.01 * mean["loss_modulus"].get<double>());
  EXPECT_LT(std::abs(mean["third_loss_modulus"].get<double>()), 1e-3 * mean["loss_modulus"].get<double>());
}

}  // namespace
}  // namespace peclet::engine
