// The strain at a given stress as a Brownian particle: its momentum balance and temperature, with pairs of
// known friction and noise.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/integrators/integrator.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/driver.h"
#include "engine/terms/keyed_random.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine::strain_noise {
namespace {

constexpr double viscosity = 0.1, energy = 0.02, fraction = 0.45, timestep = 0.01, stress = 0.3, edge = 8;
constexpr double solvent = viscosity * (1 + 2.5 * fraction), volume = edge * edge * edge;
// Far above the friction of solvent and stresslets, 0.21.
constexpr double friction = 10;
constexpr std::uint64_t seed = 3;

// Returns the stress of the noise of a friction in one step.
double noise_of(double of_friction, Purpose purpose, std::uint64_t step) {
  return std::sqrt(2 * energy * of_friction / (volume * timestep)) *
         KeyedRandom(seed, purpose).normals(step, 0).first.x;
}

// Pairs with the stress friction times rate, and its noise.
class KnownPairs : public Integrator {
 public:
  explicit KnownPairs(const ControlledShear& shear)
      : Integrator(ForceField({}, {}, strain_noise::timestep, seed, 1), strain_noise::timestep),
        shear_(shear) {}

  static double noise(std::uint64_t step) { return noise_of(friction, Purpose::pair_noise, step); }

  Intervals intervals() const override { return {}; }
  void start(System& /*system*/) override {}
  StepReport advance_open(System& system) override {
    StepReport report;
    report.sums.of(StressTerm::lubrication).xy = 0.5 * volume * friction * shear_.present_rate();
    report.motion.xy = 0.5 * volume * friction * shear_.present_rate();
    report.sums.of(StressTerm::brownian_lubrication).xy = volume * noise(system.step);
    ++system.step;
    return report;
  }
  void complete(System& /*system*/) override {}
  double stability_share(const System& /*system*/) const override { return 0; }
  std::optional<double> spurious_energy(const System& /*system*/) const override { return std::nullopt; }
  HalfSteps compare_half_steps(const System& /*system*/, int /*steps*/) const override { return {}; }

 private:
  const ControlledShear& shear_;
};

class StrainNoise : public testing::Test {
 protected:
  StrainNoise() { system_.box = PeriodicCell({edge, edge, edge}, Matrix3{}); }

  double rate() const { return shear_->present_rate(); }
  void step() { control_.advance(pairs_, system_, nullptr); }

  std::shared_ptr<ControlledShear> shear_ =
      std::make_shared<ControlledShear>(stress, stress / friction, viscosity, 1e4);
  KnownPairs pairs_{*shear_};
  StressControl control_{
      read_scene(small_scene({{"flow", {{"shear_rate", nullptr}, {"stress", stress}}}}), "scene.json"),
      shear_, timestep, seed};
  System system_;
};

// sigma - <acting sigma> = M d(rate) / (V T) over a window of length T. All friction acts on the mean of the
// rates before and after a step.
TEST_F(StrainNoise, TakesUpTheMomentumThatTheStressLeaves) {
  for (int n = 0; n < 1030; ++n) step();
  const double before = rate();
  constexpr int steps = 900;
  double left = 0;
  for (int n = 0; n < steps; ++n) {
    const double noise =
        KnownPairs::noise(system_.step) - noise_of(solvent, Purpose::strain_noise, system_.step);
    const double old = rate();
    step();
    left += timestep * (stress - (friction + solvent) * 0.5 * (old + rate()) - noise);
  }
  EXPECT_NEAR(control_.inertia() * (rate() - before), left, 1e-11);
  EXPECT_GT(std::abs(left), 1e-3);
}

// The variance of the rate about its mean, times M / kT. Its error is sqrt(2 * 20 / 8e6) = 0.22 % for a
// memory of 20 steps. Friction on the old rate alone would give 1.026.
TEST_F(StrainNoise, HasTheTemperatureOfTheSpheres) {
  const double mean = stress / (friction + solvent);
  double squares = 0;
  constexpr int steps = 8'000'000;
  for (int n = 0; n < steps; ++n) {
    step();
    squares += (rate() - mean) * (rate() - mean) / steps;
  }
  EXPECT_NEAR(squares * control_.inertia() * volume / energy, 1, 0.01);
}

}  // namespace
}  // namespace peclet::engine::strain_noise
