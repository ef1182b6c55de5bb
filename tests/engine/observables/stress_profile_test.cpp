// Stress and momentum balance by y, for pairs set by hand and for a realisation.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "tests/engine/observables/loose_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

constexpr std::size_t bins = 5;  // 2 wide, of volume 200

// Returns the profiles of one step, whose pairs `take` shows; eta = 1, without noise.
template <class Take>
Json of_step(const System& system, double shear_rate, double weight, const Take& take) {
  const Json document = small_scene({{"fluid", {{"viscosity", 1}, {"thermal_energy", nullptr}}},
                                     {"flow", {{"shear_rate", shear_rate}}},
                                     {"observables", {"profiles"}},
                                     {"profiles", {{"bins", bins}}}});
  const auto observable = observable_of(read_scene(document, "scene.json"), system, 256);
  observable->watcher()->begin(system, weight);
  take(*observable->watcher());
  observable->sample(system, 0);
  return mean_of(*observable).at("profiles");
}

// Returns the profiles of spheres 0 and 1 with this force and stress between them.
Json of_pair(const System& system, const Vector3& force, const SymmetricTensor& stress, double weight = 1) {
  return of_step(system, 0, weight, [&](PairWatcher& profile) {
    PairSums sums;
    sums.of(StressTerm::contact_normal) = stress;
    profile.take(system, system.list.pairs().front(), sums, force);
  });
}

// Returns two spheres and a list of their pair.
System two_spheres_at(const Vector3& first, const Vector3& second) {
  System system = loose_spheres(2);
  system.particles.position.set(0, first);
  system.particles.position.set(1, second);
  RangeTable ranges(2);
  for (const std::size_t k : {0U, 1U, 2U, 3U}) ranges.at(k / 2, k % 2) = 4;
  system.list = NeighbourList(ranges, 0.1);
  rebuild_neighbours(system, 1);
  return system;
}

// From y = 1 to 4: a third of the line lies in the first bin, two thirds in the second.
TEST(StressProfile, LiesOnTheLineBetweenTheCentres) {
  const System system = two_spheres_at({3, 1, 3}, {3.5, 4, 3});
  const Json found = of_pair(system, {2, -4, 6}, {7, -12, 1, 3, 0, 0});
  const Json& stress = found["stress"]["contact_normal"];
  const double expected[] = {7, -12, 1, 3};
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_NEAR(stress[c][0].get<double>(), expected[c] / 200 / 3, 1e-15) << c;
    EXPECT_NEAR(stress[c][1].get<double>(), expected[c] / 200 * 2 / 3, 1e-15) << c;
    EXPECT_EQ(stress[c][2], 0) << c;
  }
  EXPECT_EQ(found["stress"]["pairs"], stress);
  const double flux[] = {3 * 2, 3 * -4, 3 * 6};
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(found["momentum_flux"][c][1].get<double>(), flux[c] / 200.0 * 2 / 3, 1e-15) << c;
}

TEST(StressProfile, GoesOnAtTheOtherSideOfTheBoxAndInEitherDirection) {
  const System system = two_spheres_at({3, 1, 3}, {3, -2, 3});
  const Json found = of_pair(system, {}, {0, 6, 0, 0, 0, 0});
  EXPECT_NEAR(found["stress"]["pairs"][1][0].get<double>(), 6.0 / 200 / 3, 1e-15);
  EXPECT_NEAR(found["stress"]["pairs"][1][4].get<double>(), 6.0 / 200 * 2 / 3, 1e-15);
}

TEST(StressProfile, OfALineAlongABinIsInThatBin) {
  const System system = two_spheres_at({3, 4, 3}, {6, 4, 3});
  const Json found = of_pair(system, {}, {6, 0, 0, 0, 0, 0}, 0.5);
  EXPECT_NEAR(found["stress"]["pairs"][0][2].get<double>(), 3.0 / 200, 1e-15);
}

// A sphere of radius 1 at rest, a quarter of a bin above the boundary at 2; the flow there is 0.3.
TEST(StressProfile, HasTheDragOfTheSpheresAroundABoundary) {
  System system = loose_spheres(1, 0.3 / 2.5);
  system.particles.position.set(0, {3, 2.5, 3});
  const Json found = of_step(system, 0.3 / 2.5, 1, [](PairWatcher&) {});
  const double unit = 0.3 / 2.5, drag = 6 * std::numbers::pi * 0.3 / 100 / unit;
  EXPECT_NEAR(found["drag"][0][1].get<double>(), 0.75 * drag, 1e-14);
  EXPECT_NEAR(found["drag"][0][2].get<double>(), 0.25 * drag, 1e-14);
  EXPECT_EQ(found["drag"][0][0], 0);
}

const Json& quiet_result(const Json& patch = Json::object()) {
  Json every_step = {{"fluid", {{"thermal_energy", 0}}},
                     {"observables", {"profiles"}},
                     {"profiles", {{"bins", 7}, {"interval", 0.002}}}};
  every_step.merge_patch(patch);
  static std::map<std::string, Json> made;
  Json& result = made[every_step.dump()];
  if (result.is_null()) result = result_of(every_step);
  return result;
}

// The mean over the box equals the stress, if sampled at every step.
TEST(StressProfile, HasTheStressOfTheBoxAsItsMean) {
  const Json& mean = quiet_result().at("mean");
  for (const char* term : {"lubrication", "contact_normal", "contact_damping", "friction", "repulsion"}) {
    const Json& rows = mean.at("profiles").at("stress").at(term);
    for (std::size_t c = 0; c < 4; ++c) {
      double sum = 0;
      for (const Json& value : rows[c]) sum += value.get<double>() / 7;
      const double expected = mean.at("stress").at(term)[c];
      EXPECT_NEAR(sum, expected, 1e-10 * std::abs(expected)) << term << ' ' << c;
    }
  }
}

// A bin gains the momentum of its spheres, m (u_end - u_begin), small against the exchange in a long window.
TEST(StressProfile, BalancesTheDrag) {
  Json patch = Json::parse(R"({"particles": {"density": 1e-3}, "box": {"height": 14},
      "flow": {"shear_rate": 0, "waves": [{"periods": 1, "sine": 5}], "faxen": true},
      "integrator": {"method": "implicit", "timestep": 0.002},
      "contact": {"friction": 0, "normal_damping": 0, "rolling_stiffness": 0, "rolling_friction": 0},
      "duration": {"production": {"time": 4}}})");
  const Json& profiles = quiet_result(patch).at("mean").at("profiles");
  EXPECT_LT(profiles.at("momentum_imbalance").get<double>(), 2e-3);
  double largest = 0;
  for (const Json& drag : profiles.at("drag")[0]) largest = std::max(largest, std::abs(drag.get<double>()));
  double flux = 0;
  for (const Json& one : profiles.at("momentum_flux")[0]) flux = std::max(flux, std::abs(one.get<double>()));
  EXPECT_GT(largest, 0.1 * flux);  // the size of an omission
}

TEST(StressProfile, WithNoiseHasNoBalance) {
  const Json result = result_of({{"observables", {"profiles"}}});
  EXPECT_FALSE(result.at("mean").at("profiles").contains("drag"));
  EXPECT_FALSE(result.at("quantities").contains("profiles/momentum_flux"));
  EXPECT_TRUE(result.at("quantities").contains("profiles/stress/pairs"));
}

}  // namespace
}  // namespace peclet::engine
