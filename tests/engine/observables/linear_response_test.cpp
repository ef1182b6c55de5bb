// Linear response of a dumbbell with known viscosity.
//
// Two beads have the mean distance L along (1, 1, 0)/sqrt 2, and their distance fluctuates by q. All noise is
// at kT:
//   mu q'' = F - z q' + noise of z,  F = -k q - g q' + noise of g.
// The only nonzero component of V J is xy: -L F / 2. In slow shear the drag holds the beads back, so that
// F = z u with the affine velocity u = L/2 per unit of rate, for any k, g and mu:
//   eta - background = L^2 z / (4 V) = (integral of the flux correlation) / (2 V kT).
// At frequency w, with c = k + i w g, F over the affine displacement is
//   c (i w z - w^2 mu) / (c + i w z - w^2 mu).
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "engine/observables/scene_reading.h"
#include "tests/engine/observables/loose_spheres.h"
#include "tests/physics/estimates.h"

namespace peclet::engine {
namespace {

constexpr double thermal_energy = 2, volume = edge * edge * edge;
constexpr double length = 40, stiffness = 3, friction = 1.5, drag = 2, mass = 0.4;

Scene rest_scene(const char* method) {
  Json document = small_scene();
  document["fluid"]["thermal_energy"] = thermal_energy;
  document["flow"]["shear_rate"] = 0;
  document["contact"] = {{"normal_stiffness", 1e4}};
  document["integrator"] = {{"method", method}, {"timestep", 0.002}};
  document["observables"] = {"linear_response"};
  return read_scene(document, "scene.json");
}

// Explicit steps take F at q and the old velocity; implicit steps at the midpoint q and the new velocity.
class Dumbbell {
 public:
  Dumbbell(bool implicit, double dt, std::uint64_t seed)
      : implicit_(implicit), dt_(dt), generator_(seed), v_(thermal(thermal_energy / mass)) {}

  struct Forces {
    double conservative, dissipative, random;
  };
  Forces advance() {
    const double of_drag = thermal(2 * thermal_energy * drag / dt_);
    Forces f = {-stiffness * q_, -friction * v_, thermal(2 * thermal_energy * friction / dt_)};
    double after = v_ + dt_ / mass * (f.conservative + f.dissipative + f.random + of_drag - drag * v_);
    if (implicit_) {
      after = (mass * v_ + dt_ * (f.conservative + f.random + of_drag)) /
              (mass + dt_ * (friction + drag) + 0.5 * dt_ * dt_ * stiffness);
      f.conservative = -stiffness * (q_ + 0.5 * dt_ * after);
      f.dissipative = -friction * after;
    }
    v_ = after;
    q_ += dt_ * v_;
    return f;
  }

 private:
  double thermal(double variance) { return std::sqrt(variance) * normal_(generator_); }

  bool implicit_;
  double dt_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  double q_ = 0, v_;
};

// Returns the traceless tensor with these five components.
SymmetricTensor with_components(const std::array<double, 5>& c) {
  const double third = c[4] / std::numbers::sqrt3;
  return {.xx = c[3] + third, .yy = third - c[3], .zz = -2 * third, .xy = c[0], .xz = c[1], .yz = c[2]};
}

// Simulates a dumbbell for each component, for five times the statistics.
Json response_of_dumbbells(const Scene& scene, std::uint64_t seed, double sign_of_dissipation) {
  constexpr std::uint64_t steps = 20'000;
  constexpr double dt = 0.02;
  auto observable = observable_of(scene, loose_spheres(2), steps, dt);
  std::vector<Dumbbell> dumbbells;
  for (std::uint64_t c = 0; c < 5; ++c) {
    dumbbells.emplace_back(scene.method == Method::implicit_steps, dt, 5 * seed + c);
  }
  for (std::uint64_t step = 0; step < steps; ++step) {
    std::array<double, 5> acted{}, conservative{}, dissipative{};
    for (std::size_t c = 0; c < 5; ++c) {
      const Dumbbell::Forces f = dumbbells[c].advance();
      acted[c] = -0.5 * length * (f.conservative + f.dissipative + f.random);
      conservative[c] = -0.5 * length * f.conservative;
      dissipative[c] = -0.5 * length * sign_of_dissipation * f.dissipative;
    }
    observable->take_flux(
        {with_components(acted), {}, with_components(conservative), with_components(dissipative)});
  }
  return mean_of(*observable);
}

constexpr double expected = length * length * drag / (4 * volume);

class LinearResponseOfADumbbell : public testing::TestWithParam<const char*> {
 protected:
  static constexpr std::uint64_t seeds = 96;

  // Returns the mean over seeds of value(means of a seed).
  template <class Value>
  Estimate over_seeds(Value&& value, double sign_of_dissipation = 1) const {
    std::vector<double> values;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      values.push_back(value(response_of_dumbbells(scene_, seed, sign_of_dissipation)));
    }
    return estimate(values);
  }
  // Returns the viscosity without the background, in units of the scene.
  double viscosity_of(const Json& relative) const {
    return scene_.physics.viscosity * (relative.get<double>() - background_);
  }

  Scene scene_ = rest_scene(GetParam());
  double background_ = 1 + 2.5 * scene_.volume_fraction;
};

TEST_P(LinearResponseOfADumbbell, IsItsDragWhateverHoldsItTogether) {
  const Estimate found =
      over_seeds([&](const Json& mean) { return viscosity_of(mean.at("zero_shear_viscosity")); });
  EXPECT_LT(found.error, 0.04 * expected);
  EXPECT_NEAR(found.mean, expected, 3 * found.error);
}

// The integral extends over many relaxation times of the dumbbell, whose slowest rate is k / (g + z) = 0.86.
// The Green-Kubo formula with the opposite sign of the dissipative part is far off.
TEST_P(LinearResponseOfADumbbell, IsThatOfTheCorrelationToo) {
  const auto by_correlation = [&](const Json& mean) {
    const Json& curves = mean.at("linear_response");
    std::size_t k = 0;
    while (curves.at("lag")[k].get<double>() < 8) ++k;
    return viscosity_of(curves.at("correlation")[k]);
  };
  const Estimate found = over_seeds(by_correlation);
  EXPECT_LT(found.error, 0.03 * expected);
  EXPECT_NEAR(found.mean, expected, 3 * found.error);
  const Estimate wrong = over_seeds(by_correlation, -1);
  EXPECT_GT(std::abs(wrong.mean - expected), 10 * wrong.error);
}

TEST_P(LinearResponseOfADumbbell, HasItsModuli) {
  std::vector<double> frequency;
  std::vector<std::vector<double>> storage, loss;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Json curves = response_of_dumbbells(scene_, seed, 1).at("linear_response");
    frequency = curves.at("frequency").get<std::vector<double>>();
    storage.resize(frequency.size());
    loss.resize(frequency.size());
    for (std::size_t k = 0; k < frequency.size(); ++k) {
      storage[k].push_back(curves.at("storage")[k].get<double>());
      loss[k].push_back(curves.at("loss")[k].get<double>() -
                        frequency[k] * scene_.physics.viscosity * background_);
    }
  }
  int compared = 0;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    const double w = frequency[k];
    if (w > 1 || w < 0.05) continue;  // steps are 0.02; the slope covers times up to 50
    const std::complex<double> i(0, 1), held = stiffness + i * w * friction,
                                        lost = i * w * drag - w * w * mass;
    const std::complex<double> modulus = length * length / (4 * volume) * held * lost / (held + lost);
    const Estimate in_phase = estimate(storage[k]), ahead = estimate(loss[k]);
    EXPECT_LT(in_phase.error + ahead.error, 0.1 * std::abs(modulus)) << w;
    EXPECT_NEAR(in_phase.mean, modulus.real(), 3.5 * in_phase.error) << w;
    EXPECT_NEAR(ahead.mean, modulus.imag(), 3.5 * ahead.error) << w;
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

INSTANTIATE_TEST_SUITE_P(EitherMethod, LinearResponseOfADumbbell, testing::Values("implicit", "explicit"),
                         [](const auto& of) { return std::string(of.param); });

// All five components have equal weight, and rotations have no effect. A constant flux s has <(s t)^2> = s^2
// t^2, s^2 = (xx^2 + yy^2 + zz^2)/2 - (xx + yy + zz)^2/6 + xy^2 + xz^2 + yz^2 summed over the five.
TEST(LinearResponse, CountsFiveComponentsAlike) {
  const Scene scene = rest_scene("implicit");
  for (const SymmetricTensor& flux :
       {SymmetricTensor{.xy = 1}, SymmetricTensor{.xx = 1},
        SymmetricTensor{.xx = 1, .yy = -2, .zz = 0.5, .yz = 3}, SymmetricTensor{.xx = 4, .yy = 4, .zz = 4}}) {
    auto observable = observable_of(scene, loose_spheres(2), 1024);
    for (int step = 0; step < 1024; ++step) observable->take_flux({flux, {}, {}, {}});
    const double trace = flux.xx + flux.yy + flux.zz;
    const double square = (flux.xx * flux.xx + flux.yy * flux.yy + flux.zz * flux.zz) / 2 -
                          trace * trace / 6 + flux.xy * flux.xy + flux.xz * flux.xz + flux.yz * flux.yz;
    // Expected: the slope of s^2 t^2 / (2 V eta kT 5) from t to 2t, t a sixteenth of the window.
    const double t = 64 * timestep;
    const double slope = square * 3 * t / (2 * volume * scene.physics.viscosity * thermal_energy * 5);
    const Json mean = mean_of(*observable);
    EXPECT_NEAR(mean.at("zero_shear_viscosity").get<double>(), 1 + 2.5 * scene.volume_fraction + slope,
                1e-12 * (1 + slope));
    EXPECT_NEAR(mean.at("zero_shear_rise").get<double>(), slope / 2, 1e-12 * (1 + slope));
  }
}

}  // namespace
}  // namespace peclet::engine
