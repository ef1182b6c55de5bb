// The automatic implicit step and the bounds that set it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/errors.h"
#include "engine/integrators/derived_groups.h"
#include "engine/integrators/stability.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

Scene scene_with(const Json& patch) {
  Json document = small_scene({{"integrator", {{"method", "implicit"}, {"timestep", "auto"}}}});
  document.merge_patch(patch);
  return read_scene(document, "scene.json");
}

// Bounds of the step:
//   - 0.01 / rate (1 + 2 St), half with friction, repulsion or noise at large Pe, a quarter at more friction
//   - 0.0045 eta a^3 / kT, 0.0017 without lubrication
//   - the contact time, with the rates of the explicit step's bound
TEST(ImplicitTimestep, IsTheLeastOfStrainBrownianAndContactTimes) {
  const Json soft = {{"contact", {{"normal_stiffness", 1e-3}, {"friction", 0.5}}}, {"repulsion", nullptr}};
  const double stokes = 0.1 * 1.4 * 1.4 * 2 / 0.1;
  EXPECT_NEAR(automatic_timestep(scene_with(soft)), 0.0025 / 2 / (1 + 2 * stokes), 1e-12);
  Json quiet = soft;
  quiet["fluid"] = {{"thermal_energy", nullptr}};
  EXPECT_NEAR(automatic_timestep(scene_with(quiet)), 0.0025 / 2 / (1 + 2 * stokes), 1e-12);  // rolls
  quiet["contact"].update({{"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}});
  EXPECT_NEAR(automatic_timestep(scene_with(quiet)), 0.005 / 2 / (1 + 2 * stokes), 1e-12);
  quiet["contact"]["kinetic_friction"] = 0.4;
  EXPECT_NEAR(automatic_timestep(scene_with(quiet)), 0.0025 / 2 / (1 + 2 * stokes), 1e-12);
  quiet["contact"].erase("kinetic_friction");
  quiet["contact"]["friction"] = 1.1;
  EXPECT_NEAR(automatic_timestep(scene_with(quiet)), 0.0025 / 2 / (1 + 2 * stokes), 1e-12);
  Json smooth = soft;
  smooth["contact"] = {{"normal_stiffness", 1e-3},
                       {"rolling_stiffness", nullptr},
                       {"friction", nullptr},
                       {"rolling_friction", nullptr}};
  EXPECT_NEAR(automatic_timestep(scene_with(smooth)), 0.005 / 2 / (1 + 2 * stokes), 1e-12);
  smooth["lubrication"] = {{"inner_gap", 1e-3}};
  const double peclet = 6 * pi * 0.1 * 2 / 0.02;
  EXPECT_NEAR(automatic_timestep(scene_with(smooth)),
              0.01 * std::pow(0.1 / (1e-3 * peclet), 0.3) / 2 / (1 + 2 * stokes), 1e-12);
  smooth["lubrication"] = {{"inner_gap", 1e-4}};
  EXPECT_NEAR(automatic_timestep(scene_with(smooth)), 0.01 / 2 / (1 + 2 * stokes), 1e-12);
  smooth["volume_fraction"] = 0.63;
  EXPECT_NEAR(automatic_timestep(scene_with(smooth)), 0.005 / 2 / (1 + 2 * stokes), 1e-12);
  smooth.erase("lubrication");
  smooth["fluid"] = {{"thermal_energy", nullptr}};
  for (const auto& [volume_fraction, strain] :
       {std::pair{0.5, 0.01}, std::pair{0.6, 0.01}, std::pair{0.63, 0.004}, std::pair{0.66, 0.002}}) {
    smooth["volume_fraction"] = volume_fraction;
    EXPECT_NEAR(automatic_timestep(scene_with(smooth)), strain / 2 / (1 + 2 * stokes), 1e-12);
  }
  smooth.erase("repulsion");
  EXPECT_NEAR(automatic_timestep(scene_with(smooth)), 0.005 / 2 / (1 + 2 * stokes), 1e-12);
  Json warm = soft;
  warm["fluid"] = {{"thermal_energy", 5}};
  EXPECT_NEAR(automatic_timestep(scene_with(warm)), 0.0045 * 0.1 / 5, 1e-12);
  warm["lubrication"] = nullptr;
  EXPECT_NEAR(automatic_timestep(scene_with(warm)), 0.0017 * 0.1 / 5, 1e-12);
  Json stiff = soft;
  stiff["contact"] = {{"normal_stiffness", 1e9},
                      {"friction", nullptr},
                      {"rolling_stiffness", nullptr},
                      {"rolling_friction", nullptr}};
  const PairRates rates = stiffest_pair(scene_with(stiff));
  EXPECT_NEAR(automatic_timestep(scene_with(stiff)), 7 * rates.damping / rates.frequency_squared, 1e-15);
  stiff["fluid"] = {{"thermal_energy", nullptr}};
  EXPECT_NEAR(automatic_timestep(scene_with(stiff)), 20 * rates.damping / rates.frequency_squared, 1e-15);
  stiff["fluid"] = Json::object();
  stiff["contact"] = {{"normal_stiffness", 1e9},
                      {"friction", 0.5},
                      {"rolling_stiffness", nullptr},
                      {"rolling_friction", nullptr}};
  const PairRates with_friction = stiffest_pair(scene_with(stiff));
  EXPECT_NEAR(automatic_timestep(scene_with(stiff)),
              2 * with_friction.damping / with_friction.frequency_squared, 1e-15);
  stiff["fluid"] = {{"thermal_energy", nullptr}};
  EXPECT_NEAR(automatic_timestep(scene_with(stiff)),
              4 * with_friction.damping / with_friction.frequency_squared, 1e-15);
}

// The step resolves the relaxation time of a contact along n, for any tangential damping.
TEST(ImplicitTimestep, IsNotLengthenedByATangentialDashpot) {
  const auto step = [](double stiffness, double damping) {
    return automatic_timestep(scene_with(
        {{"fluid", {{"thermal_energy", nullptr}}},
         {"contact",
          {{"normal_stiffness", stiffness}, {"friction", 0.5}, {"tangential_damping", damping}}}}));
  };
  EXPECT_NEAR(step(1e6, 0) / step(2e6, 0), 2, 0.01);
  EXPECT_EQ(step(1e6, 1e5), step(1e6, 0));
}

// The stiffness is strength / kappa^2 exp(-h / kappa), kappa = 1, at h = outer gap (a_i + a_j) / 2 = 0.1. The
// drags 6 pi eta a of two small spheres are in series.
TEST(ImplicitTimestep, IsBoundByARepulsionBeyondLubrication) {
  const Scene scene = scene_with(Json::parse(R"({
    "contact": {"friction": null, "rolling_stiffness": null, "rolling_friction": null},
    "repulsion": {"strength": 1e5, "relative_length": 0.5}})"));
  const double drag = 0.5 * 6 * pi * 0.1, stiffness = 1e5 * std::exp(-0.1);
  EXPECT_NEAR(automatic_timestep(scene) / (20 * drag / stiffness), 1, 1e-12);
  // A repulsion that ends within the range of lubrication sets no bound.
  const Scene short_scene = scene_with(Json::parse(R"({
    "contact": {"friction": null, "rolling_stiffness": null, "rolling_friction": null},
    "repulsion": {"strength": 1e5, "relative_length": 0.5, "cutoff_lengths": 0.09}})"));
  EXPECT_GT(automatic_timestep(short_scene), 1.2 * automatic_timestep(scene));
}

// Attraction alone grows separations at the rate -V'' / drag, at most 9 c / (8 sqrt(3) eps^3) / drag with
// c = A_H a / 12. The step is the inverse, within 1 % for distances spaced by a twelfth of a decade.
TEST(ImplicitTimestep, IsBoundByTheGrowthOfAttraction) {
  const Scene scene = scene_with(Json::parse(R"({
    "particles": {"species": [{"radius": 1}]}, "contact": null, "lubrication": null, "repulsion": null,
    "attraction": {"hamaker": 120, "regularisation": 0.05, "cutoff": 1}})"));
  const double drag = 0.5 * 6 * pi * 0.1, steepest = 9 / (8 * std::sqrt(3.0)) * 10 / 1.25e-4;
  EXPECT_GE(automatic_timestep(scene), drag / steepest * (1 - 1e-12));
  EXPECT_LE(automatic_timestep(scene), drag / steepest * 1.01);
}

// The potential is steepest at 0.6e-5 radii, with -V'' = 9/(8 sqrt 3) c / eps^3.
TEST(ImplicitTimestep, IsBoundByTheGrowthOfNarrowAttraction) {
  const Scene scene = scene_with(Json::parse(R"({
    "particles": {"species": [{"radius": 1}]}, "contact": null, "lubrication": null, "repulsion": null,
    "attraction": {"hamaker": 120, "regularisation": 1e-5, "cutoff": 1}})"));
  const double drag = 0.5 * 6 * pi * 0.1, steepest = 9 / (8 * std::sqrt(3.0)) * 10 / 1e-15;
  EXPECT_GE(automatic_timestep(scene), drag / steepest * (1 - 1e-12));
  EXPECT_LE(automatic_timestep(scene), drag / steepest * 1.02);
}

// Returns a scene of nearly inertialess spheres, Pe = 1; at one radius X_A = 6 pi eta a
// (1 / (4 xi) + 9/40 ln(1 / xi)).
Json light_spheres(double density, double outer_gap, const Json& species) {
  return {{"particles", {{"count", 150}, {"density", density}, {"species", species}}},
          {"fluid", {{"thermal_energy", 0.017}}},
          {"flow", {{"shear_rate", 0.009}}},
          {"contact",
           {{"normal_stiffness", 1e4},
            {"friction", nullptr},
            {"normal_damping", nullptr},
            {"rolling_stiffness", nullptr},
            {"rolling_friction", nullptr}}},
          {"lubrication", {{"inner_gap", 1e-3}, {"outer_gap", outer_gap}}},
          {"repulsion", nullptr},
          {"guard", nullptr},
          {"duration",
           {{"equilibration", {{"time", 0}}}, {"production", {{"time", nullptr}, {"brownian_times", 2}}}}}};
}

// Standard deviation of the approach of a third sphere to one whose pair leaves the range: (m + dt zeta)
// dV = dt F with F^2 = 2 kT X_A / dt, and dt V with V^2 = kT / (m + dt zeta / 2) for both spheres.
TEST(ImplicitTimestep, IsBoundByLeapsOutOfTheRangeOfLubrication) {
  const Json one = Json::parse(R"([{"radius": 1}])");
  for (const double outer_gap : {0.02, 0.05}) {
    for (const double density : {1e-6, 1e-5}) {
      const double step = automatic_timestep(scene_with(light_spheres(density, outer_gap, one)));
      ASSERT_LT(step, 0.9 * 0.0017 * 0.1 / 0.017);
      const double zeta = 6 * pi * 0.1, m = density * 4 * pi / 3;
      const double squeeze = zeta * (0.25 / outer_gap + 9.0 / 40 * std::log(1 / outer_gap));
      const double parting = std::pow(step / (m + step * zeta), 2) * 2 * 0.017 * squeeze / step;
      const double free = 0.017 / (m + 0.5 * step * zeta);
      EXPECT_NEAR(2 * outer_gap / (step * std::sqrt(parting + 2 * free)), 5, 1e-6)
          << outer_gap << ' ' << density;
    }
  }
  // A wide range sets no bound: 0.0017 eta a^3 / kT.
  EXPECT_NEAR(automatic_timestep(scene_with(light_spheres(1e-4, 0.5, one))), 0.01, 1e-12);
}

// Bounds: five standard deviations sqrt(2 kT / m) dt of the distance between two free spheres are twice the
// outer gap. The step is at most 4 velocity decay times; for heavy spheres 0.0045 eta a^3 / kT.
TEST(ImplicitTimestep, OfSpheresThatInertiaCarriesIsBoundByTheirFlight) {
  const Json one = Json::parse(R"([{"radius": 1}])");
  const auto step = [&](double density, double outer_gap) {
    return automatic_timestep(scene_with(light_spheres(density, outer_gap, one)));
  };
  const auto flight = [](double density, double outer_gap) {
    return 2 * outer_gap / (5 * std::sqrt(2 * 0.017 / (density * 4 * pi / 3)));
  };
  EXPECT_NEAR(step(1e-3, 0.02) / flight(1e-3, 0.02), 1, 1e-12);
  EXPECT_NEAR(step(3e-3, 0.03) / flight(3e-3, 0.03), 1, 1e-12);
  const double decay = 1e-4 * 4 * pi / 3 / (6 * pi * 0.1);
  EXPECT_NEAR(step(1e-4, 0.022) / (4 * decay), 1, 1e-12);
  EXPECT_NEAR(step(0.02, 0.05), 0.45 / 17, 1e-12);
}

// The form mari has X_A = 6 pi eta a / 4 (xi + eps). Its range is a surface distance, which equals xi_o at
// radius 2. Contacts act against X_A at eps.
TEST(ImplicitTimestep, KnowsTheRangeOfLubricationRelativeToTheFlow) {
  const auto light = [](double density, double outer_distance) {
    Json patch = light_spheres(density, 0.05, Json::parse(R"([{"radius": 2}])"));
    patch["lubrication"] = {{"form", "mari"},
                            {"inner_gap", nullptr},
                            {"outer_gap", nullptr},
                            {"regularisation", 1e-3},
                            {"outer_distance", outer_distance}};
    return patch;
  };
  const auto mass = [](double density) { return density * 4 * pi / 3 * 8; };
  EXPECT_NEAR(automatic_timestep(scene_with(light(2e-4, 0.02))) /
                  (2 * 0.02 / (5 * std::sqrt(2 * 0.017 / mass(2e-4)))),
              1, 1e-12);
  const double step = automatic_timestep(scene_with(light(1e-7, 0.04)));
  const double zeta = 6 * pi * 0.1 * 2, m = mass(1e-7), squeeze = zeta * 0.25 / (0.5 * 0.04 + 1e-3);
  const double parting = std::pow(step / (m + step * zeta), 2) * 2 * 0.017 * squeeze / step;
  const double free = 0.017 / (m + 0.5 * step * zeta);
  ASSERT_LT(step, 0.9 * 0.0017 * 0.8 / 0.017);
  EXPECT_NEAR(2 * 0.04 / (step * std::sqrt(parting + 2 * free)), 5, 1e-6);
  Json stiff = light(1e-7, 0.04);
  stiff["fluid"] = {{"thermal_energy", nullptr}};
  stiff["contact"]["normal_stiffness"] = 1e9;
  stiff["duration"]["production"] = {{"time", 1}};
  // X_A plus the drag of each sphere, over k.
  EXPECT_NEAR(automatic_timestep(scene_with(stiff)) / (20 * (zeta * 250 + zeta / 2) / 1e9), 1, 1e-9);
}

// With the Brownian bound alone the largest overlap is 0.0088 here; thermal overlaps are about 0.005.
TEST(ImplicitTimestep, LetsNoLightSphereLeapIntoAnother) {
  const Json two = Json::parse(R"([{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}])");
  const Scene scene = scene_with(light_spheres(2e-4, 0.05, two));
  const Schedule schedule = make_schedule(scene, "scene.json");
  Simulation simulation(scene, schedule, 1, 1, "scene.json");
  simulation.start();
  EXPECT_EQ(simulation.advance(schedule.total())->cause, Ending::Cause::completed);
  EXPECT_LT(simulation.largest_overlap(), 0.008);
}

TEST(ImplicitTimestep, IsRefusedBeyondFourTimesTheAutomaticOne) {
  const double automatic = automatic_timestep(scene_with(Json::object()));
  const auto resolved = [&](double factor) {
    return resolved_timestep(scene_with({{"integrator", {{"timestep", factor * automatic}}}}), "scene.json");
  };
  EXPECT_EQ(resolved(3.99), 3.99 * automatic);
  EXPECT_THROW(resolved(4.01), InputError);
}

// Half steps measure the error of smooth motion in uniform shear; not in waves, with noise or friction.
TEST(ImplicitTimestep, IsWarnedOfBeyondTheAutomaticOneWhereNothingElseTellsItsError) {
  const Json smooth = {
      {"contact", {{"friction", nullptr}, {"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}}},
      {"fluid", {{"thermal_energy", 0}}}};
  Json wavy = smooth;
  wavy["flow"] = {{"waves", {{{"periods", 1}, {"sine", 0.1}}}}, {"faxen", true}};
  const auto warns = [](Json patch, double factor) {
    patch["integrator"] = {{"timestep", factor * automatic_timestep(scene_with(patch))}};
    const std::vector<Warning> all = scene_warnings(scene_with(patch));
    return std::any_of(all.begin(), all.end(),
                       [](const Warning& warning) { return warning.code == "timestep"; });
  };
  EXPECT_FALSE(warns(smooth, 3));
  EXPECT_TRUE(warns(wavy, 3));
  EXPECT_FALSE(warns(wavy, 0.9));
}

TEST(ImplicitTimestep, MustBeGivenWhereNothingSetsATime) {
  Json document = small_scene({{"integrator", {{"method", "implicit"}, {"timestep", "auto"}}},
                               {"flow", {{"shear_rate", 0}}},
                               {"fluid", {{"thermal_energy", 0}}}});
  document.erase("contact");
  document.erase("repulsion");
  EXPECT_THROW(resolved_timestep(read_scene(document, "scene.json"), "scene.json"), InputError);
}

}  // namespace
}  // namespace peclet::engine
