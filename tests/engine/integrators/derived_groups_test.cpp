// Time scales and groups compared with those published with Table 4.1 of Li (2023).
#include "engine/integrators/derived_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/flow/shear.h"
#include "engine/integrators/stability.h"
#include "engine/observables/scene_reading.h"
#include "tests/contract/refusal.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

Scene scene_of(double shear_rate, double thermal_energy) {
  Scene scene;
  scene.particles.density = 0.1;
  scene.particles.reference_radius = 1;
  scene.physics.viscosity = 0.1;
  scene.physics.flow = steady_shear(shear_rate);
  scene.physics.thermal_energy = thermal_energy;
  scene.physics.contact = ContactParameters{.normal_stiffness = 1e4};
  return scene;
}

using Codes = std::vector<std::string>;

Codes codes_of(const std::vector<Warning>& warnings) {
  Codes codes;
  for (const Warning& warning : warnings) codes.push_back(warning.code);
  return codes;
}
Codes warning_codes(const Scene& scene) { return codes_of(scene_warnings(scene)); }

TEST(DerivedGroups, ReproduceThePublishedTable) {
  const struct {
    double peclet, shear_rate, thermal_energy;
  } rows[] = {{0.01, 9e-5, 0.017},  {0.046, 4.2e-4, 0.017}, {0.22, 1.9e-3, 0.017}, {1, 9e-3, 0.017},
              {4.6, 9e-3, 3.7e-3},  {22, 9e-3, 7.9e-4},     {100, 9e-3, 1.7e-4},   {460, 9e-3, 3.7e-5},
              {2200, 9e-3, 7.9e-6}, {1e4, 9e-3, 1.7e-6}};
  for (const auto& row : rows) {
    const DerivedGroups groups = derived_groups(scene_of(row.shear_rate, row.thermal_energy));
    EXPECT_NEAR(*groups.peclet / row.peclet, 1, 0.045) << row.peclet;  // two published digits
    EXPECT_NEAR(*groups.contact_time, 0.0032, 0.00005);
    EXPECT_NEAR(*groups.inertial_time, 1, 1e-12);
    EXPECT_NEAR(*groups.brownian_time * row.thermal_energy, 0.1, 1e-12);
    EXPECT_NEAR(*groups.shear_time * row.shear_rate, 1, 1e-12);
    EXPECT_NEAR(*groups.stokes, row.shear_rate, 1e-12);
    EXPECT_NEAR(*groups.relative_stiffness * row.shear_rate, 1e5, 1e-6);
  }
}

TEST(DerivedGroups, ScaleWithTheReferenceRadius) {
  Scene scene = scene_of(0.5, 0.2);
  scene.particles.reference_radius = 2;
  const DerivedGroups groups = derived_groups(scene);
  EXPECT_NEAR(*groups.inertial_time, 4, 1e-12);
  EXPECT_NEAR(*groups.brownian_time, 4, 1e-12);
  EXPECT_NEAR(*groups.contact_time, std::sqrt(8e-5), 1e-12);
  EXPECT_NEAR(*groups.relative_stiffness, 1e5, 1e-6);
  EXPECT_NEAR(*groups.peclet, 37.699111843077517, 1e-12);  // 12 pi
}

// a = 2: eta rate = 0.1 * 0.5, kT / 8, F_CL / 4, and the force at contact over 4. It is A / (0.01 * 4) of the
// exponential repulsion, F_ER a / a_0 of the screened one.
TEST(DerivedGroups, StressesAreThoseOfFlowHeatAndForces) {
  Scene scene = scene_of(0.5, 0.2);
  scene.particles.reference_radius = 2;
  scene.physics.contact->friction = 0.5;
  scene.physics.contact->critical_load = 3;
  scene.physics.repulsion = RepulsionParameters{.strength = 0.6, .relative_length = 0.01};
  Json groups = to_json(derived_groups(scene));
  EXPECT_NEAR(groups.at("viscous_stress").get<double>(), 0.05, 1e-15);
  EXPECT_NEAR(groups.at("thermal_stress").get<double>(), 0.025, 1e-15);
  EXPECT_NEAR(groups.at("critical_stress").get<double>(), 0.75, 1e-15);
  EXPECT_NEAR(groups.at("repulsion_stress").get<double>(), 0.6 / 0.04 / 4, 1e-12);
  scene.physics.repulsion = RepulsionParameters{
      .form = RepulsionParameters::Form::screened, .force = 5, .debye_length = 0.1, .reference_radius = 4};
  EXPECT_NEAR(derived_groups(scene).repulsion_stress.value(), 5 * 2.0 / 4 / 4, 1e-12);
  EXPECT_FALSE(derived_groups(scene_of(0, 0)).viscous_stress);
  EXPECT_FALSE(derived_groups(scene_of(0.5, 0)).critical_stress);
}

TEST(DerivedGroups, WhatHasNoMeaningIsNull) {
  Scene scene = scene_of(0, 0);
  scene.physics.contact.reset();
  EXPECT_EQ(to_json(derived_groups(scene)), (Json{{"peclet", nullptr},
                                                  {"stokes", 0.0},
                                                  {"relative_stiffness", nullptr},
                                                  {"contact_time", nullptr},
                                                  {"inertial_time", 1.0},
                                                  {"brownian_time", nullptr},
                                                  {"shear_time", nullptr},
                                                  {"flow_over_rest", nullptr},
                                                  {"largest_stokes", nullptr},
                                                  {"largest_inertia_over_brownian", nullptr}}));
}

// Published system at Pe = 0.01: (600 pi)^2 phi / (300 v eta_r (eta_r - 1 - 2.5 phi)),
// v = (4 pi / 3) / (0.5 + 0.5 / 1.4^3) = 6.1400, eta_r = 17.526 at phi = 0.5, 2.9251 at 0.3; as 1 / Pe^2.
TEST(DerivedGroups, NearRestTheFlowIsComparedWithRest) {
  Scene scene = scene_of(1, 1);
  scene.particles.species = {{1, 0.5}, {1.4, 0.5}};
  scene.physics.contact = ContactParameters{.normal_stiffness = 1e4};
  const auto compared = [&](double peclet, double fraction) {
    Scene near = scene;
    near.volume_fraction = fraction;
    near.physics.flow = steady_shear(peclet / (6 * std::numbers::pi * 0.1));
    return derived_groups(near).flow_over_rest;
  };
  EXPECT_NEAR(compared(0.01, 0.5).value(), 3.6025, 5e-4);
  EXPECT_NEAR(compared(0.01, 0.3).value(), 168.361, 5e-3);
  EXPECT_NEAR(compared(0.001, 0.5).value() / compared(0.01, 0.5).value(), 100, 1e-6);
  EXPECT_FALSE(compared(0.1001, 0.5));
  EXPECT_FALSE(compared(0.01, 0.6));
  Scene oscillating = scene;
  oscillating.volume_fraction = 0.5;
  oscillating.physics.flow = ImposedFlow(std::make_shared<OscillatoryShear>(0.001, 1));
  EXPECT_FALSE(derived_groups(oscillating).flow_over_rest);
  scene.physics.contact->friction = 0.1;
  EXPECT_FALSE(compared(0.01, 0.5));
}

// rho a^2 w / eta = 0.3 for any amplitude.
TEST(SceneWarnings, InertiaBesideAnOscillationGoesByItsFrequency) {
  const auto codes = [](double density) {
    Json document = small_scene({{"particles", {{"density", density}, {"species", {{{"radius", 1}}}}}},
                                 {"fluid", {{"thermal_energy", 0}}}});
    document["flow"] = {{"oscillation", {{"amplitude", 1e-3}, {"frequency", 3}}}};
    document["integrator"] = {{"method", "implicit"}};
    document["duration"] = {{"equilibration", {{"cycles", 1}}}, {"production", {{"cycles", 1}}}};
    return warning_codes(read_scene(document, "scene.json"));
  };
  EXPECT_EQ(codes(0.01), Codes{"inertia-shear"});
  EXPECT_EQ(codes(0.003), Codes{});
}

TEST(SceneWarnings, InertiaIsReportedFromTheBoundOn) {
  EXPECT_EQ(warning_codes(scene_of(0.009, 0.0169)), Codes{});
  EXPECT_EQ(warning_codes(scene_of(0.009, 0.017)), Codes{"inertia-thermal"});  // 0.17, as published
  EXPECT_EQ(warning_codes(scene_of(0.0999, 0)), Codes{});
  EXPECT_EQ(warning_codes(scene_of(0.1, 0)), Codes{"inertia-shear"});
  EXPECT_EQ(warning_codes(scene_of(1, 1)), (Codes{"inertia-shear", "inertia-thermal"}));
  EXPECT_EQ(warning_codes(scene_of(0, 0)), Codes{});
}

// Desmond & Weeks (2014): 0.634 + 0.0658 d + 0.0857 S d^2. Radii 1 : 1.4 in equal volumes are 1000 : 364 in
// number, so d = 0.160 and S = 1.05: 0.634 + 0.0105 + 0.0023.
TEST(WarningsBeforeRun, DenserThanARandomPackingIsSaid) {
  const auto text = [](double fraction) {
    const std::vector<Warning> found =
        warnings_before_run(read_scene(small_scene({{"volume_fraction", fraction}}), "scene.json"));
    return found.empty() ? "" : found.front().code + ": " + found.front().message;
  };
  EXPECT_EQ(text(0.63), "");
  EXPECT_TRUE(contains(text(0.66),
                       "packing: random packings of these spheres reach a volume fraction of about 0.647"));
}

TEST(WarningsBeforeRun, SoftSpheresAreSaid) {
  const auto codes = [](double stiffness) {  // viscosity times radius times rate: 0.2
    const Json scene =
        small_scene(together({without_noise, {{"contact", {{"normal_stiffness", stiffness}}}}}));
    return codes_of(warnings_before_run(read_scene(scene, "scene.json")));
  };
  EXPECT_EQ(codes(40), Codes{"soft"});
  EXPECT_EQ(codes(2e3), Codes{});
}

// Mean overlaps of 15 stress a / k_n, here 15 / k_n.
TEST(WarningsBeforeRun, ContactsThatAreSoftForTheirStressAreSaid) {
  const auto codes = [](double stiffness) {
    Json scene = small_scene({{"contact", {{"normal_stiffness", stiffness}}},
                              {"fluid", {{"thermal_energy", nullptr}}},
                              {"duration", {{"production", {{"stress_times", 400}}}}}});
    scene["flow"] = {{"stress", 1}};
    return codes_of(warnings_before_run(read_scene(scene, "scene.json")));
  };
  EXPECT_EQ(codes(14e3), Codes{"soft"});
  EXPECT_EQ(codes(16e3), Codes{});
}

// stress a^2 over the critical load is 1 / load here, and viscosity rate a^2 over it 0.2 / load.
TEST(WarningsBeforeRun, ACriticalLoadOfAnotherUnitIsSaid) {
  const auto codes = [](double load, bool at_stress) {
    Json scene =
        small_scene({{"contact", {{"normal_stiffness", 1e6}, {"friction", 0.5}, {"critical_load", load}}},
                     {"fluid", {{"thermal_energy", nullptr}}}});
    if (at_stress) {
      scene["flow"] = {{"stress", 1}};
      scene["duration"] = {{"equilibration", {{"time", 0}}}, {"production", {{"stress_times", 400}}}};
    }
    return codes_of(warnings_before_run(read_scene(scene, "scene.json")));
  };
  for (const double load : {1.1e-4, 1.0, 0.9e4}) EXPECT_EQ(codes(load, true), Codes{}) << load;
  for (const double load : {0.9e-4, 1.1e4}) EXPECT_EQ(codes(load, true), Codes{"critical-load"}) << load;
  for (const double load : {0.22e-4, 0.18e4}) EXPECT_EQ(codes(load, false), Codes{}) << load;
  for (const double load : {0.18e-4, 0.22e4}) EXPECT_EQ(codes(load, false), Codes{"critical-load"}) << load;
}

// k_B T = 0.02: 0.03 sqrt(k_n k_B T) is 0.424 at k_n = 10^4 and 4.24 at 10^6.
Scene rough_noisy_scene(const Json& patch) {
  const Json rough = {{"repulsion", nullptr},
                      {"flow", {{"shear_rate", 0.1}}},  // viscosity times rate is 0.01
                      {"contact", {{"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}}},
                      {"duration", {{"production", {{"time", 10}}}}}};
  return read_scene(small_scene(together({rough, patch})), "scene.json");
}
Codes codes_of_rough_noisy_scene(const Json& patch) {
  return codes_of(warnings_before_run(rough_noisy_scene(patch)));
}
const auto with_stiffness = [](double stiffness) {
  return Json{{"contact", {{"normal_stiffness", stiffness}}}};
};

TEST(WarningsBeforeRun, AnOnsetOfFrictionThatSoftnessSetsIsSaid) {
  const Codes soft{"soft"}, none;
  const auto codes = codes_of_rough_noisy_scene;
  EXPECT_EQ(codes(with_stiffness(1e4)), soft);
  EXPECT_EQ(codes(with_stiffness(5.5e4)), soft);  // 99.5 times viscosity rate
  EXPECT_EQ(codes(with_stiffness(5.6e4)), none);  // 100.4 times
  const auto at_rate = [](double rate) { return Json{{"flow", {{"shear_rate", rate}}}}; };
  EXPECT_EQ(codes(at_rate(1.4)), soft);  // 3.03 times
  EXPECT_EQ(codes(at_rate(1.42)), none);
  EXPECT_EQ(codes({{"contact", {{"friction", 0}}}}), none);
  EXPECT_EQ(codes({{"fluid", {{"thermal_energy", nullptr}}}}), none);
}

TEST(WarningsBeforeRun, TheOnsetOfFrictionAtAGivenStressIsSaid) {
  const auto codes = [](double stress) {
    return codes_of_rough_noisy_scene(
        {{"flow", {{"shear_rate", nullptr}, {"stress", stress}}},
         {"contact", {{"normal_stiffness", 1e6}}},
         {"duration", {{"production", {{"time", nullptr}, {"stress_times", 400}}}}}});
  };
  EXPECT_EQ(codes(0.43), Codes{"soft"});
  EXPECT_EQ(codes(0.42), Codes{});
  EXPECT_EQ(codes(42), Codes{"soft"});
  EXPECT_EQ(codes(43), Codes{});
}

// The force of the repulsion at contact is strength / (0.01 * 2 a).
TEST(WarningsBeforeRun, NoOnsetOfFrictionThatARepulsionSetsIsSaid) {
  const auto codes = codes_of_rough_noisy_scene;
  const auto repelled = [](double strength) {
    return Json{{"repulsion", {{"form", "exponential"}, {"strength", strength}, {"relative_length", 0.01}}}};
  };
  EXPECT_EQ(codes(repelled(0.0084)), Codes{"soft"});
  EXPECT_EQ(codes(repelled(0.0086)), Codes{});
  EXPECT_EQ(codes({{"contact", {{"critical_load", 0.42}}}}), Codes{"soft"});
  EXPECT_EQ(codes({{"contact", {{"critical_load", 0.43}}}}), Codes{});
}

TEST(WarningsBeforeRun, TheOnsetOfFrictionInMixturesIsThatOfTheGrains) {
  const auto codes = [](double alpha) {
    const Json mixture = {{"colloids", {{{"radius", 1}, {"volume_share", 1}}}},
                          {"grains", {{{"radius", 5}, {"volume_share", 1}}}},
                          {"alpha", alpha}};
    return codes_of_rough_noisy_scene(
        {{"particles", {{"species", nullptr}, {"count", 500}, {"mixture", mixture}}},
         {"volume_fraction", 0.3},
         {"integrator", {{"method", "implicit"}, {"timestep", nullptr}}}});
  };
  EXPECT_EQ(codes(0), Codes{"soft"});
  EXPECT_EQ(codes(0.5), Codes{});  // 42.4 / 25 times viscosity rate
}

TEST(WarningsOfTheStress, LongImplicitStepsAtTheOnsetOfFrictionAreSaid) {
  const auto by = [](const char* method) {
    return Json{{"integrator", {{"method", method}, {"timestep", "auto"}}}};
  };
  // `share` is that of the automatic step.
  const auto codes = [&](double stress, const Json& patch, double share = 1) {
    const Scene scene = rough_noisy_scene(together({by("implicit"), patch}));
    std::vector<Warning> warnings;
    warn_of_step_at_onset_of_friction(scene, share * automatic_timestep(scene).value, stress, warnings);
    return codes_of(warnings);
  };
  const Json usual = Json::object();
  const Codes said{"timestep"}, none;
  EXPECT_EQ(codes(0.141, usual), none);
  EXPECT_EQ(codes(0.142, usual), said);  // a third of 0.4243 is 0.1414
  EXPECT_EQ(codes(1.27, usual), said);   // three times is 1.2728
  EXPECT_EQ(codes(1.28, usual), none);
  EXPECT_EQ(codes(0.4, {{"contact", {{"friction", 0}}}}), none);
  EXPECT_EQ(codes(0.4, {{"contact", {{"critical_load", 0.43}}}}), none);
  EXPECT_EQ(codes(0.4, by("explicit")), none);
  EXPECT_EQ(codes(0.4, usual, 1.0 / 63), said);
  EXPECT_EQ(codes(0.4, usual, 1.0 / 64), none);
}

// Radii 1 and 2 in equal numbers have the mean 1.5.
TEST(WarningsBeforeRun, AFirstRadiusFarFromTheMeanIsSaid) {
  const auto codes = [](const Json& radii, const Json& reference) {
    Json scene = small_scene({{"particles", {{"reference_radius", reference}}}});
    const Json distribution = {{"form", "histogram"}, {"by", "number"}, {"radii", radii}, {"shares", {1, 1}}};
    scene["particles"]["species"] = {{{"distribution", distribution}}};
    scene["integrator"] = {{"method", "implicit"}};  // any sizes
    return codes_of(warnings_before_run(read_scene(scene, "scene.json")));
  };
  EXPECT_EQ(codes({1, 2}, nullptr), Codes{"radius"});
  EXPECT_EQ(codes({1, 2}, 1.5), Codes{});
  EXPECT_EQ(codes({1, 1.15}, nullptr), Codes{});
}

TEST(SceneWarnings, MessagesGiveTheNumbers) {
  EXPECT_TRUE(contains(scene_warnings(scene_of(0.25, 0)).at(0).message,
                       "tau_I / tau_S = 0.25 (tau_I = 1, tau_S = 4)"));
}

}  // namespace
}  // namespace peclet::engine
