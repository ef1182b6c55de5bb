// The automatic implicit step and the bounds that set it.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "engine/integrators/derived_groups.h"
#include "engine/integrators/stability.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

const Json by_automatic_steps = {{"integrator", {{"method", "implicit"}, {"timestep", "auto"}}}};

Scene scene_by_automatic_steps(const Json& patch) {
  return scene_from(together({by_automatic_steps, patch}));
}
double step_of(const Json& patch) { return automatic_timestep(scene_by_automatic_steps(patch)).value; }
std::string limit_of(const Json& patch) { return automatic_timestep(scene_by_automatic_steps(patch)).limit; }

// Bounds of the step:
//   - 0.01 / rate (1 + 2 St), half with friction, repulsion or noise at large Pe, a quarter at more friction
//   - 0.0045 eta a^3 / kT, 0.0017 without lubrication
//   - the contact time, with the rates of the explicit step's bound
TEST(ImplicitTimestep, IsTheLeastOfStrainBrownianAndContactTimes) {
  const double stokes = 0.1 * 1.4 * 1.4 * 2 / 0.1;
  const auto expect_strain = [&](const Json& patch, double strain) {
    EXPECT_NEAR(step_of(patch), strain / 2 / (1 + 2 * stokes), 1e-12) << patch;
    EXPECT_EQ(limit_of(patch), "flow") << patch;
  };
  const Json soft = {{"contact", {{"normal_stiffness", 1e-3}, {"friction", 0.5}}}, {"repulsion", nullptr}};
  expect_strain(soft, 0.0025);
  Json quiet = together({soft, without_noise});
  expect_strain(quiet, 0.0025);  // rolls
  quiet["contact"].update({{"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}});
  const auto with = [&](const Json& contact) { return together({quiet, {{"contact", contact}}}); };
  expect_strain(quiet, 0.005);
  expect_strain(with({{"kinetic_friction", 0.4}}), 0.0025);
  expect_strain(with({{"friction", 1.1}}), 0.0025);
  Json smooth = together({soft, without_friction});
  expect_strain(smooth, 0.005);
  smooth["lubrication"] = {{"inner_gap", 1e-3}};
  const double peclet = 6 * pi * 0.1 * 2 / 0.02;
  expect_strain(smooth, 0.01 * std::pow(0.1 / (1e-3 * peclet), 0.3));
  smooth["lubrication"] = {{"inner_gap", 1e-4}};
  expect_strain(smooth, 0.01);
  smooth["volume_fraction"] = 0.63;
  expect_strain(smooth, 0.005);
  smooth.erase("lubrication");
  smooth["fluid"] = {{"thermal_energy", nullptr}};
  for (const auto& [volume_fraction, strain] :
       {std::pair{0.5, 0.01}, std::pair{0.6, 0.01}, std::pair{0.63, 0.004}, std::pair{0.66, 0.002}}) {
    smooth["volume_fraction"] = volume_fraction;
    expect_strain(smooth, strain);
  }
  smooth.erase("repulsion");
  expect_strain(smooth, 0.005);
  Json warm = soft;
  warm["fluid"] = {{"thermal_energy", 5}};
  EXPECT_NEAR(step_of(warm), 0.0045 * 0.1 / 5, 1e-12);
  EXPECT_EQ(limit_of(warm), "noise");
  warm["lubrication"] = nullptr;
  EXPECT_NEAR(step_of(warm), 0.0017 * 0.1 / 5, 1e-12);
  EXPECT_EQ(limit_of(warm), "noise");
  const Json stiff = together({soft, without_friction, {{"contact", {{"normal_stiffness", 1e9}}}}});
  const Json stiff_with_friction = together({stiff, {{"contact", {{"friction", 0.5}}}}});
  for (const auto& [patch, factor] : {std::pair(stiff, 7), std::pair(stiff_with_friction, 2)}) {
    const PairRates rates = stiffest_pair(scene_by_automatic_steps(patch));
    const double time = rates.damping / rates.frequency_squared;
    EXPECT_NEAR(step_of(patch), factor * time, 1e-15);
    EXPECT_EQ(limit_of(patch), "contacts");
    EXPECT_NEAR(step_of(together({patch, without_noise})), (factor == 7 ? 20 : 4) * time, 1e-15);
  }
}

// The step resolves the relaxation time of a contact along n, for any tangential damping.
TEST(ImplicitTimestep, IsNotLengthenedByATangentialDashpot) {
  const auto step = [](double stiffness, double damping) {
    const Json contact = {
        {"normal_stiffness", stiffness}, {"friction", 0.5}, {"tangential_damping", damping}};
    return step_of(together({without_noise, {{"contact", contact}}}));
  };
  EXPECT_NEAR(step(1e6, 0) / step(2e6, 0), 2, 0.01);
  EXPECT_EQ(step(1e6, 1e5), step(1e6, 0));
}

// The stiffness is strength / kappa^2 exp(-h / kappa), kappa = 1, at h = outer gap (a_i + a_j) / 2 = 0.1. The
// drags 6 pi eta a of two small spheres are in series.
TEST(ImplicitTimestep, IsBoundByARepulsionBeyondLubrication) {
  const Json strong =
      together({without_friction, {{"repulsion", {{"strength", 1e5}, {"relative_length", 0.5}}}}});
  const double drag = 0.5 * 6 * pi * 0.1, stiffness = 1e5 * std::exp(-0.1);
  EXPECT_NEAR(step_of(strong) / (20 * drag / stiffness), 1, 1e-12);
  EXPECT_EQ(limit_of(strong), "repulsion");
  // A repulsion that ends within the range of lubrication sets no bound.
  const Json short_one = together({strong, {{"repulsion", {{"cutoff_lengths", 0.09}}}}});
  EXPECT_GT(step_of(short_one), 1.2 * step_of(strong));
}

// Attraction alone grows separations at the rate -V'' / drag, at most 9 c / (8 sqrt(3) eps^3) / drag with
// c = A_H a / 12. The step is the inverse, within 1 % for distances spaced by a twelfth of a decade. The
// potential of narrow attraction is steepest at 0.6e-5 radii.
TEST(ImplicitTimestep, IsBoundByTheGrowthOfAttraction) {
  for (const auto& [regularisation, within] : {std::pair{0.05, 1.01}, std::pair{1e-5, 1.02}}) {
    Json patch =
        Json::parse(R"({"particles": {"species": [{"radius": 1}]}, "contact": null, "lubrication": null,
                                 "repulsion": null, "attraction": {"hamaker": 120, "cutoff": 1}})");
    patch["attraction"]["regularisation"] = regularisation;
    const double drag = 0.5 * 6 * pi * 0.1;
    const double steepest = 9 / (8 * std::sqrt(3.0)) * 10 / std::pow(regularisation, 3);
    EXPECT_GE(step_of(patch), drag / steepest * (1 - 1e-12));
    EXPECT_LE(step_of(patch), drag / steepest * within);
    EXPECT_EQ(limit_of(patch), "attraction");
  }
}

// Returns a scene of nearly inertialess spheres, Pe = 1; at one radius X_A = 6 pi eta a
// (1 / (4 xi) + 9/40 ln(1 / xi)).
Json light_spheres(double density, double outer_gap, const Json& species) {
  Json patch = together({elastic_contacts, Json::parse(R"({
      "particles": {"count": 150}, "fluid": {"thermal_energy": 0.017}, "flow": {"shear_rate": 0.009},
      "contact": {"normal_stiffness": 1e4}, "lubrication": {"inner_gap": 1e-3},
      "repulsion": null, "guard": null,
      "duration": {"equilibration": {"time": 0}, "production": {"time": null, "brownian_times": 2}}})")});
  patch["particles"].update({{"density", density}, {"species", species}});
  patch["lubrication"]["outer_gap"] = outer_gap;
  return patch;
}

const Json one_size = Json::parse(R"([{"radius": 1}])");

// Standard deviation of the approach of a third sphere to one whose pair leaves the range: (m + dt zeta)
// dV = dt F with F^2 = 2 kT X_A / dt, and dt V with V^2 = kT / (m + dt zeta / 2) for both spheres. Expects
// that it is a fifth of `range`.
void expect_leap(double step, double m, double zeta, double squeeze, double range) {
  const double parting = std::pow(step / (m + step * zeta), 2) * 2 * 0.017 * squeeze / step;
  const double free = 0.017 / (m + 0.5 * step * zeta);
  EXPECT_NEAR(range / (step * std::sqrt(parting + 2 * free)), 5, 1e-6);
}

TEST(ImplicitTimestep, IsBoundByLeapsOutOfTheRangeOfLubrication) {
  for (const double outer_gap : {0.02, 0.05}) {
    for (const double density : {1e-6, 1e-5}) {
      SCOPED_TRACE(testing::Message() << outer_gap << ' ' << density);
      const double step = step_of(light_spheres(density, outer_gap, one_size)), zeta = 6 * pi * 0.1;
      ASSERT_LT(step, 0.9 * 0.0017 * 0.1 / 0.017);
      const double squeeze = zeta * (0.25 / outer_gap + 9.0 / 40 * std::log(1 / outer_gap));
      expect_leap(step, density * 4 * pi / 3, zeta, squeeze, 2 * outer_gap);
      EXPECT_EQ(limit_of(light_spheres(density, outer_gap, one_size)), "inertia");
    }
  }
  // A wide range sets no bound: 0.0017 eta a^3 / kT.
  EXPECT_NEAR(step_of(light_spheres(1e-4, 0.5, one_size)), 0.01, 1e-12);
}

// Bounds: five standard deviations sqrt(2 kT / m) dt of the distance between two free spheres are twice the
// outer gap. The step is at most 4 velocity decay times; for heavy spheres 0.0045 eta a^3 / kT.
TEST(ImplicitTimestep, OfSpheresThatInertiaCarriesIsBoundByTheirFlight) {
  const auto step = [&](double density, double outer_gap) {
    return step_of(light_spheres(density, outer_gap, one_size));
  };
  const auto flight = [](double density, double outer_gap) {
    return 2 * outer_gap / (5 * std::sqrt(2 * 0.017 / (density * 4 * pi / 3)));
  };
  EXPECT_NEAR(step(1e-3, 0.02) / flight(1e-3, 0.02), 1, 1e-12);
  EXPECT_EQ(limit_of(light_spheres(1e-3, 0.02, one_size)), "inertia");
  EXPECT_EQ(limit_of(light_spheres(0.02, 0.05, one_size)), "noise");
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
    patch["lubrication"] = strained_lubrication["lubrication"];
    patch["lubrication"].update({{"regularisation", 1e-3}, {"outer_distance", outer_distance}});
    return patch;
  };
  const auto mass = [](double density) { return density * 4 * pi / 3 * 8; };
  EXPECT_NEAR(step_of(light(2e-4, 0.02)) / (2 * 0.02 / (5 * std::sqrt(2 * 0.017 / mass(2e-4)))), 1, 1e-12);
  const double step = step_of(light(1e-7, 0.04)), zeta = 6 * pi * 0.1 * 2;
  ASSERT_LT(step, 0.9 * 0.0017 * 0.8 / 0.017);
  expect_leap(step, mass(1e-7), zeta, zeta * 0.25 / (0.5 * 0.04 + 1e-3), 2 * 0.04);
  Json stiff = light(1e-7, 0.04);
  stiff["fluid"] = {{"thermal_energy", nullptr}};
  stiff["contact"]["normal_stiffness"] = 1e9;
  stiff["duration"]["production"] = {{"time", 1}};
  // X_A plus the drag of each sphere, over k.
  EXPECT_NEAR(step_of(stiff) / (20 * (zeta * 250 + zeta / 2) / 1e9), 1, 1e-9);
}

// With the Brownian bound alone the largest overlap is 0.0088 here; thermal overlaps are about 0.005.
TEST(ImplicitTimestep, LetsNoLightSphereLeapIntoAnother) {
  const Json two = Json::parse(R"([{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}])");
  Simulation simulation = started(scene_by_automatic_steps(light_spheres(2e-4, 0.05, two)), 1);
  EXPECT_EQ(simulation.advance(simulation.schedule().total())->cause, Ending::Cause::completed);
  EXPECT_LT(simulation.largest_overlap(), 0.008);
}

TEST(ImplicitTimestep, IsRefusedBeyondFourTimesTheAutomaticOne) {
  const double automatic = step_of(Json::object());
  const auto resolved = [&](double factor) {
    return resolved_timestep(scene_by_automatic_steps({{"integrator", {{"timestep", factor * automatic}}}}),
                             "scene.json")
        .value;
  };
  EXPECT_EQ(resolved(3.99), 3.99 * automatic);
  EXPECT_THROW(resolved(4.01), InputError);
}

// Half steps measure the error of smooth motion in uniform shear; not in waves, with noise or friction.
TEST(ImplicitTimestep, IsWarnedOfBeyondTheAutomaticOneWhereNothingElseTellsItsError) {
  const Json smooth = together({without_friction, {{"fluid", {{"thermal_energy", 0}}}}});
  Json wavy = smooth;
  wavy["flow"] = {{"waves", {{{"periods", 1}, {"sine", 0.1}}}}, {"faxen", true}};
  const auto warns = [](Json patch, double factor) {
    patch["integrator"] = {{"timestep", factor * step_of(patch)}};
    const std::vector<Warning> all = scene_warnings(scene_by_automatic_steps(patch));
    return std::any_of(all.begin(), all.end(),
                       [](const Warning& warning) { return warning.code == "timestep"; });
  };
  EXPECT_FALSE(warns(smooth, 3));
  EXPECT_TRUE(warns(wavy, 3));
  EXPECT_FALSE(warns(wavy, 0.9));
}

TEST(ImplicitTimestep, MustBeGivenWhereNothingSetsATime) {
  const Scene scene = scene_by_automatic_steps(together({at_rest, Json::parse(R"({
      "fluid": {"thermal_energy": 0}, "contact": null, "repulsion": null})")}));
  EXPECT_THROW(resolved_timestep(scene, "scene.json"), InputError);
}

}  // namespace
}  // namespace peclet::engine
