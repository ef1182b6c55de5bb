#include "engine/scene/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "engine/observables/scene_reading.h"
#include "tests/contract/refusal.h"

namespace peclet::engine {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

Json smallest_scene() {
  return Json::parse(R"({
    "particles": {"count": 100, "density": 0.1, "species": [{"radius": 2}]},
    "volume_fraction": 0.45,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.009},
    "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})");
}

Scene scene_with(const Json& patch) {
  Json document = smallest_scene();
  document.merge_patch(patch);
  return read_scene(document, "scene.json");
}

TEST(Scene, WhatIsAbsentIsNotComputed) {
  const Scene scene = read_scene(smallest_scene(), "scene.json");
  EXPECT_EQ(scene.physics.thermal_energy, 0);
  EXPECT_FALSE(scene.physics.contact);
  EXPECT_FALSE(scene.physics.lubrication);
  EXPECT_FALSE(scene.physics.repulsion);
  EXPECT_FALSE(scene.timestep);
  EXPECT_FALSE(scene.document.contains("contact"));
  EXPECT_EQ(scene.document["observables"], Json::array({"stress"}));
  EXPECT_EQ(scene.guard.largest_overlap, 0.05);
  EXPECT_EQ(scene.guard.largest_displacement, 0.05);
  EXPECT_EQ(scene.guard.energy_imbalance, 0.3);
  EXPECT_EQ(scene.guard.half_step_difference, 0.03);
}

// Lubrication selects implicit steps and their wider guard.
TEST(Scene, LubricationDecidesTheMethod) {
  const Json lubrication = {{"form", "kim-karrila"}};
  const Scene without = scene_with(Json::object());
  EXPECT_EQ(without.method, Method::explicit_steps);
  EXPECT_EQ(without.document["integrator"]["method"], "explicit");
  const Scene with = scene_with({{"lubrication", lubrication}});
  EXPECT_EQ(with.method, Method::implicit_steps);
  EXPECT_EQ(with.document["integrator"]["method"], "implicit");
  EXPECT_EQ(with.guard.largest_displacement, 0.3);
  EXPECT_EQ(scene_with({{"integrator", {{"method", "implicit"}}}}).method, Method::implicit_steps);
  const Scene given = scene_with({{"lubrication", lubrication},
                                  {"integrator", {{"method", "explicit"}}},
                                  {"guard", {{"largest_displacement", 0.1}}}});
  EXPECT_EQ(given.method, Method::explicit_steps);
  EXPECT_EQ(given.guard.largest_displacement, 0.1);
  EXPECT_EQ(scene_with({{"integrator", {{"method", "explicit"}}}}).guard.largest_displacement, 0.05);
}

TEST(Scene, DefaultsThatFollowFromOtherKeys) {
  const Scene scene =
      scene_with({{"contact", {{"normal_stiffness", 7e3}, {"friction", 0.4}, {"rolling_stiffness", 10}}}});
  EXPECT_EQ(scene.particles.reference_radius, 2);
  EXPECT_DOUBLE_EQ(scene.physics.contact->tangential_stiffness, 2e3);
  EXPECT_EQ(scene.physics.contact->rolling_friction, 0.4);
  EXPECT_EQ(scene.physics.contact->normal_damping, 0);
  EXPECT_EQ(scene.physics.contact->tangential_damping, 0);
  EXPECT_FALSE(remembers_sliding(*scene.physics.contact));
  EXPECT_EQ(scene.physics.contact->critical_load, 0);
  EXPECT_EQ(scene.physics.contact->largest_load, std::numeric_limits<double>::infinity());
}

TEST(Scene, GivenValuesAreKept) {
  const Scene scene = scene_with(Json::parse(R"({
    "particles": {"reference_radius": 1.5},
    "fluid": {"thermal_energy": 0.017},
    "contact": {"normal_stiffness": 1e4, "normal_damping": 0.04, "friction": 0.5, "tangential_stiffness": 2857,
                "rolling_stiffness": 3, "rolling_friction": 0.3, "critical_load": 0.6, "largest_load": 50,
                "kinetic_friction": 0.4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-4, "outer_gap": 0.2},
    "repulsion": {"form": "exponential", "strength": 1.7, "relative_length": 0.02, "cutoff_lengths": 10},
    "integrator": {"timestep": 1e-4},
    "guard": {"largest_overlap": 0.1, "largest_displacement": 0.02, "energy_imbalance": 0.01,
              "half_step_difference": 0.002}})"));
  EXPECT_EQ(scene.particles.reference_radius, 1.5);
  EXPECT_EQ(scene.physics.viscosity, 0.1);
  EXPECT_EQ(scene.physics.thermal_energy, 0.017);
  EXPECT_EQ(scene.physics.flow.rate(), 0.009);
  EXPECT_EQ(scene.physics.contact->normal_stiffness, 1e4);
  EXPECT_EQ(scene.physics.contact->normal_damping, 0.04);
  EXPECT_EQ(scene.physics.contact->tangential_stiffness, 2857);
  EXPECT_EQ(scene.physics.contact->rolling_friction, 0.3);
  EXPECT_EQ(scene.physics.contact->kinetic_friction, 0.4);
  EXPECT_EQ(scene.physics.contact->critical_load, 0.6);
  EXPECT_EQ(scene.physics.contact->largest_load, 50);
  EXPECT_EQ(scene.physics.lubrication->inner_gap, 1e-4);
  EXPECT_EQ(scene.physics.lubrication->outer_gap, 0.2);
  EXPECT_EQ(scene.physics.repulsion->strength, 1.7);
  EXPECT_EQ(scene.physics.repulsion->relative_length, 0.02);
  EXPECT_EQ(scene.physics.repulsion->cutoff_lengths, 10);
  EXPECT_EQ(scene.timestep, 1e-4);
  EXPECT_EQ(scene.guard.largest_overlap, 0.1);
  EXPECT_EQ(scene.guard.largest_displacement, 0.02);
  EXPECT_EQ(scene.guard.energy_imbalance, 0.01);
  EXPECT_EQ(scene.guard.half_step_difference, 0.002);
}

TEST(Scene, SharesAreDividedByTheirSum) {
  const Scene by_number = scene_with(Json::parse(
      R"({"particles": {"species": [{"radius": 1, "number_share": 3}, {"radius": 2, "number_share": 1}]}})"));
  EXPECT_EQ(by_number.particles.shares, Particles::Shares::number);
  EXPECT_EQ(by_number.particles.species[0].share, 0.75);
  EXPECT_EQ(by_number.particles.species[1].share, 0.25);
  const Scene by_volume = scene_with(Json::parse(
      R"({"particles": {"species": [{"radius": 1, "volume_share": 0.2}, {"radius": 2, "volume_share": 0.2}]}})"));
  EXPECT_EQ(by_volume.particles.shares, Particles::Shares::volume);
  EXPECT_EQ(by_volume.particles.species[1].share, 0.5);
  EXPECT_EQ(read_scene(smallest_scene(), "").particles.species[0].share, 1);
}

TEST(Scene, WhatCanNeverBeReachedIsNoLimit) {
  const Scene sheared =
      scene_with(Json::parse(R"({"duration": {"production": {"brownian_times": 4, "time": 9}}})"));
  EXPECT_EQ(sheared.equilibration.strain, 2);
  EXPECT_EQ(sheared.production.strain, 5);
  EXPECT_EQ(sheared.production.brownian_times, unlimited);  // no temperature
  EXPECT_EQ(sheared.production.time, 9);

  const Scene at_rest = scene_with(Json::parse(R"({"flow": {"shear_rate": 0}, "fluid": {"thermal_energy": 1},
      "duration": {"equilibration": {"brownian_times": 4}, "production": {"brownian_times": 8}}})"));
  EXPECT_EQ(at_rest.equilibration.strain, unlimited);
  EXPECT_EQ(at_rest.equilibration.brownian_times, 4);
  EXPECT_EQ(at_rest.production.brownian_times, 8);
}

TEST(Scene, AWaveOfAmplitudeZeroIsNone) {
  const auto varies = [](const char* sine) {
    return scene_with(Json::parse(fmt::format(
                          R"({{"flow": {{"waves": [{{"periods": 1, "sine": {}}}], "faxen": true}}}})", sine)))
        .physics.flow.varies();
  };
  EXPECT_FALSE(varies("0"));
  EXPECT_TRUE(varies("0.1"));
}

TEST(Scene, EquilibrationOfZeroIsOverBeforeItStarts) {
  const Scene scene = scene_with(Json::parse(R"({"duration": {"equilibration": {"strain": 0, "time": 3}}})"));
  EXPECT_EQ(scene.equilibration.time, 0);
}

// Table 4.1 of Li (2023): rate and k_B T at each Pe with eta = 0.1, a = 1, printed with two digits.
constexpr struct {
  double peclet, shear_rate, thermal_energy;
} table_4_1[] = {{0.01, 9e-5, 0.017},  {0.046, 4.2e-4, 0.017}, {0.22, 1.9e-3, 0.017}, {1, 9e-3, 0.017},
                 {4.6, 9e-3, 3.7e-3},  {22, 9e-3, 7.9e-4},     {100, 9e-3, 1.7e-4},   {460, 9e-3, 3.7e-5},
                 {2200, 9e-3, 7.9e-6}, {1e4, 9e-3, 1.7e-6}};
constexpr double rounding = 0.07;  // of two digits and of Pe: 1.9e-3 stands for 1.98e-3

TEST(Scene, PecletNumberWithinLimitsGivesThePublishedRatesAndTemperatures) {
  for (const auto& row : table_4_1) {
    const Scene scene = scene_with({{"particles", {{"reference_radius", 1}}},
                                    {"flow", nullptr},
                                    {"peclet", row.peclet},
                                    {"limits", {{"shear_rate", 0.009}, {"thermal_energy", 0.017}}}});
    const Physics& physics = scene.physics;
    EXPECT_NEAR(physics.flow.rate() / row.shear_rate, 1, rounding) << row.peclet;
    EXPECT_NEAR(physics.thermal_energy / row.thermal_energy, 1, rounding) << row.peclet;
    EXPECT_NEAR(6 * std::numbers::pi * 0.1 * physics.flow.rate() / physics.thermal_energy, row.peclet,
                1e-12 * row.peclet);
    EXPECT_LE(physics.flow.rate(), 0.009);
    EXPECT_LE(physics.thermal_energy, 0.017);
    EXPECT_TRUE(physics.flow.rate() == 0.009 || physics.thermal_energy == 0.017);  // at its limit
  }
}

Physics physics_of(const char* blocks) {
  Json scene = Json::parse(blocks);
  scene["fluid"] = {{"viscosity", 0.1}};
  return read_physics(scene, "c.json", "/scene");
}

TEST(Scene, AttractionHasItsDefaultsAndIsAbsentWithAConstantOfZero) {
  const Physics physics = physics_of(R"({"attraction": {"hamaker": 0.3, "cutoff": 4}})");
  EXPECT_EQ(physics.attraction->hamaker, 0.3);
  EXPECT_EQ(physics.attraction->regularisation, 0.01);
  EXPECT_EQ(physics.attraction->cutoff, 4);
  EXPECT_FALSE(physics_of(R"({"attraction": {"hamaker": 0, "cutoff": 4}})").attraction);
}

TEST(Scene, ScreenedRepulsionHasKeysOfItsOwn) {
  const Physics physics = physics_of(R"({"repulsion": {"form": "screened", "force": 1.3, "debye_length": 0.02,
      "reference_radius": 0.5}})");
  EXPECT_EQ(physics.repulsion->form, RepulsionParameters::Form::screened);
  EXPECT_EQ(physics.repulsion->force, 1.3);
  EXPECT_EQ(physics.repulsion->debye_length, 0.02);
  EXPECT_EQ(physics.repulsion->reference_radius, 0.5);
  EXPECT_EQ(physics.repulsion->cutoff_lengths, 20);
  EXPECT_FALSE(physics_of(R"({"repulsion": {"form": "screened", "force": 0, "debye_length": 0.02,
      "reference_radius": 0.5}})")
                   .repulsion);
}

TEST(Scene, EachFormOfLubricationHasKeysAndDefaultsOfItsOwn) {
  const auto scene_of = [](const char* lubrication) {
    return scene_with({{"lubrication", Json::parse(lubrication)}});
  };
  const Scene plain = scene_of(R"({"form": "kim-karrila"})");
  EXPECT_EQ(plain.physics.lubrication->inner_gap, 1e-3);
  EXPECT_EQ(plain.physics.lubrication->outer_gap, 0.05);
  EXPECT_EQ(plain.document["lubrication"],
            Json::parse(R"({"form": "kim-karrila", "inner_gap": 0.001, "outer_gap": 0.05})"));
  const Scene strained = scene_of(R"({"form": "mari", "outer_distance": 0.2})");
  EXPECT_EQ(strained.physics.lubrication->form, LubricationParameters::Form::mari);
  EXPECT_EQ(strained.physics.lubrication->inner_gap, 1e-3);
  EXPECT_EQ(strained.physics.lubrication->outer_distance, 0.2);
  EXPECT_EQ(strained.document["lubrication"],
            Json::parse(R"({"form": "mari", "regularisation": 0.001, "outer_distance": 0.2})"));
}

// The bound is 1 - regularisation times the smallest radius, where ln(1/d) becomes negative. For a
// configuration it uses the radii of its state.
TEST(Scene, TheOuterDistanceOfLubricationIsBoundByTheSmallestSphere) {
  const auto scene_of = [](double smallest, double distance) {
    return scene_with(
        {{"particles",
          {{"species", {{{"radius", 3}, {"volume_share", 1}}, {{"radius", smallest}, {"volume_share", 1}}}}}},
         {"lubrication", {{"form", "mari"}, {"regularisation", 0.5}, {"outer_distance", distance}}}});
  };
  EXPECT_EQ(scene_of(0.4, 0.1999).physics.lubrication->outer_distance, 0.1999);
  EXPECT_THROW(scene_of(0.4, 0.2001), InputError);
  EXPECT_THROW(scene_of(0.3, 0.1999), InputError);
}

TEST(Scene, AConfigurationsBlocksAreReadByTheSameKeys) {
  const Json blocks = Json::parse(R"({"fluid": {"viscosity": 0.1, "thermal_energy": 0.017},
      "contact": {"normal_stiffness": 7, "friction": 0.5}, "lubrication": {"form": "kim-karrila"},
      "repulsion": {"form": "exponential", "strength": 1.7}})");
  const Physics physics = read_physics(blocks, "c.json", "/scene");
  EXPECT_EQ(physics.thermal_energy, 0.017);
  EXPECT_EQ(physics.flow.rate(), 0);
  EXPECT_EQ(physics.contact->tangential_stiffness, 2);
  EXPECT_EQ(physics.lubrication->outer_gap, 0.05);
  EXPECT_EQ(physics.repulsion->cutoff_lengths, 20);

  const auto expect_refusal = [&](const Json& patch, const std::string& pointer) {
    Json document = blocks;
    document.merge_patch(patch);
    const std::string refusal = refusal_by([&] { read_physics(document, "c.json", "/scene"); });
    EXPECT_TRUE(refusal.starts_with("c.json: " + pointer + ": ")) << refusal;
  };
  expect_refusal({{"particles", 1}}, "/scene/particles");
  expect_refusal({{"fluid", nullptr}}, "/scene/fluid");
  expect_refusal({{"fluid", {{"viscosity", -1}}}}, "/scene/fluid/viscosity");
  expect_refusal({{"contact", {{"normal_stifness", 1}}}}, "/scene/contact/normal_stifness");
  expect_refusal({{"lubrication", {{"inner_gap", 0.1}}}}, "/scene/lubrication/inner_gap");
}

}  // namespace
}  // namespace peclet::engine
