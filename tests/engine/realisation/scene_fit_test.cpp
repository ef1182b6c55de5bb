// Checks before any sphere is placed, and the names promised before anything is measured.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/job.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/schedule.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

std::string fault_of(const Json& patch) {
  try {
    const Scene scene = read_scene(small_scene(patch), "scene.json");
    check_fit(scene, make_schedule(scene, "scene.json"), "scene.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Json with_species(std::size_t count, const Json& species) {
  return {{"particles", {{"count", count}, {"species", species}}}};
}

TEST(SceneFit, IsRefusedWithTheReason) {
  EXPECT_EQ(fault_of(Json::object()), "");
  EXPECT_NE(fault_of({{"particles", {{"count", 1}}}})
                .find("/particles/count: 1: must be large enough for one sphere"),
            std::string::npos);
  EXPECT_NE(
      fault_of({{"volume_fraction", 0.6}, {"particles", {{"count", 1}, {"species", {{{"radius", 1}}}}}}})
          .find("/particles/count: 1: must fill a box larger than"),
      std::string::npos);
  EXPECT_NE(fault_of({{"observables", {"pair_distribution"}}, {"particles", {{"count", 20}}}})
                .find("/pair_distribution/range: 4: must be at most"),
            std::string::npos);
  EXPECT_NE(fault_of({{"observables", {"mean_squared_displacement"}},
                      {"mean_squared_displacement", {{"interval", 1e300}}}})
                .find("/mean_squared_displacement/interval: 1 samples: must leave at least 8"),
            std::string::npos);
}

// Number shares of 1 to 999: the first size gets a sphere from 1000 spheres on.
TEST(SceneFit, OfASizeWithoutASphereSaysTheCountThatWouldDo) {
  const Json species = {{{"radius", 1}, {"number_share", 1}}, {{"radius", 1.4}, {"number_share", 999}}};
  const std::string fault = fault_of(with_species(60, species));
  EXPECT_NE(fault.find("; 1000 would do for all sizes"), std::string::npos) << fault;
  EXPECT_EQ(fault_of(with_species(1000, species)), "");
  const Json rare = {{{"radius", 1}, {"number_share", 1}}, {{"radius", 1.4}, {"number_share", 1e9}}};
  EXPECT_NE(fault_of(with_species(60, rare)).find("not even 10000000 would do"), std::string::npos);
}

TEST(SceneFit, OfSizesThatCannotBeComputedWithIsRefused) {
  for (const double radius : {1e-300, 1e-80, 1e80, 1e300}) {
    EXPECT_NE(fault_of(with_species(60, {{{"radius", radius}}})).find("/particles/species/0/radius"),
              std::string::npos)
        << radius;
  }
  EXPECT_EQ(fault_of(with_species(
                60, {{{"radius", 1}, {"volume_share", 1}}, {{"radius", 1}, {"volume_share", 1}}})),
            "")
      << "two species of one size";
}

TEST(SceneFit, ASpeciesMoreThanThereMayBeIsRefused) {
  Json species = Json::array();
  for (int i = 0; i < 257; ++i) species.push_back({{"radius", 1 + 1e-3 * i}, {"number_share", 1}});
  EXPECT_NE(fault_of(with_species(1000, species)).find("/particles/species"), std::string::npos);
  species.erase(0);
  EXPECT_EQ(fault_of(with_species(1000, species)), "");
}

TEST(SceneFit, ABoxHasItsHeightAndTheVolumeOfTheCube) {
  const Scene cube = read_scene(small_scene(), "scene.json");
  const Scene tall = read_scene(small_scene({{"box", {{"height", 20}}}}), "scene.json");
  EXPECT_EQ(box_lengths(cube, 9), (Vector3{9, 9, 9}));
  const Vector3 box = box_lengths(tall, 9);
  EXPECT_EQ(box.y, 20);
  EXPECT_EQ(box.x, box.z);
  EXPECT_NEAR(box.x * box.y * box.z, 729, 1e-10);
}

TEST(SceneFit, ABoxNarrowerThanTheRangeOfTheForcesIsRefused) {
  const auto fault = [](double height) { return fault_of(Json{{"box", {{"height", height}}}}); };
  EXPECT_EQ(fault(40), "");
  EXPECT_NE(fault(400).find("must fill a box larger than the range of the forces"), std::string::npos);
  EXPECT_NE(fault(1).find("must fill a box larger than the range of the forces"), std::string::npos);
  EXPECT_NE(fault(0).find("/box/height"), std::string::npos);
}

// Forces of spheres of radius 1 reach 2.1. A cube of edge 2.15 is wide enough in shear; in extension its
// images come as near as 0.946 or 0.905 of that.
TEST(SceneFit, ACubeWhoseImagesExtensionBringsWithinTheRangeOfTheForcesIsRefused) {
  const auto fault = [](const Json& flow, double edge) {
    Json patch = with_species(1, {{{"radius", 1}}});
    patch["volume_fraction"] = 4 * M_PI / 3 / (edge * edge * edge);
    patch["flow"] = flow;
    return fault_of(patch);
  };
  const Json planar = {{"shear_rate", nullptr}, {"extension_rate", 1}},
             uniaxial = {{"shear_rate", nullptr}, {"uniaxial_rate", 1}};
  EXPECT_EQ(fault({{"shear_rate", 2}}, 2.15), "");
  EXPECT_NE(fault(planar, 2.15).find("(its nearest images would be 2.033 apart)"), std::string::npos);
  EXPECT_EQ(fault(planar, 2.25), "");
  EXPECT_NE(fault(uniaxial, 2.25).find("(its nearest images would be 2.037 apart)"), std::string::npos);
  EXPECT_EQ(fault(uniaxial, 2.35), "");
}

// The edge is part of the trajectory, so it must equal that for the list of all radii bit by bit.
TEST(SceneFit, TheBoxIsThatOfAllRadii) {
  for (const std::size_t count : {2U, 7U, 60U, 12345U}) {
    const Scene scene = read_scene(small_scene(with_species(count, {{{"radius", 1.1}, {"number_share", 1}},
                                                                    {{"radius", 0.7}, {"number_share", 2}}})),
                                   "scene.json");
    EXPECT_EQ(cube_edge(scene.particles, 0.3), cube_edge(species_radii(scene.particles), 0.3)) << count;
  }
}

TEST(SceneFit, OfTheLargestSceneTakesNoMemory) {
  const auto high_water = [] {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;  // [kB]
  };
  const long before = high_water();
  EXPECT_EQ(fault_of({{"particles", {{"count", 10'000'000}}}}), "");
  EXPECT_LT(high_water() - before, 20'000);  // a list of radii alone takes 80 000
}

// Adds the paths of all numbers of a result's mean, with "*" for the indices of a list.
void add_numbers(const Json& value, const std::string& path, std::set<std::string>& names) {
  if (value.is_number()) names.insert(path);
  if (value.is_array() && !value.empty() && !value.front().is_object()) {
    add_numbers(value.front(), path + "/*", names);
  } else if (value.is_structured()) {
    const Json members = value.is_object() ? value : Json(value);
    for (const auto& [key, member] : members.items()) {
      add_numbers(member, path.empty() ? key : path + '/' + key, names);
    }
  }
}

// True for values of axes and parts of ratios.
bool is_no_target(const std::string& name) {
  const std::string last = name.substr(name.rfind('/') + 1);
  return name.starts_with("pair_distribution/") || name.starts_with("profiles/velocity/") ||
         name == "mean_squared_displacement/time/*" || name == "stress_correlation/time/*" ||
         name == "linear_response/time/*" || name == "linear_response/lag/*" ||
         name == "linear_response/frequency/*" || last == "radius";
}

TEST(TargetHints, SayWhatPeopleMayMean) {
  const Json hints = target_hints(read_scene(small_scene(), "scene.json"));
  EXPECT_EQ(hints["N1"], "is called first_normal_difference");
  EXPECT_EQ(hints["storage_modulus"], "needs \"observables\": [\"oscillation\"] in the scene");
  EXPECT_EQ(hints["G'"],
            "is called storage_modulus, which needs \"observables\": [\"oscillation\"] in the scene");
  const Json rest = {{"flow", {{"shear_rate", nullptr}, {"stress", 0.1}}},
                     {"integrator", {{"method", "implicit"}, {"timestep", nullptr}}}};
  EXPECT_EQ(target_hints(read_scene(small_scene(rest), "scene.json"))["relative_viscosity"],
            "follows from the mean rate at a given stress: aim at shear_rate");
}

TEST(NamesOfTargets, AreThoseOfTheNumbersThatTheResultHas) {
  const Json rest = {{"flow", {{"shear_rate", 0}}}, {"duration", {{"equilibration", {{"time", 0.02}}}}}};
  const Json patches[] = {
      Json::object(),
      {{"fluid", {{"thermal_energy", nullptr}}},
       {"observables", {"mean_squared_displacement", "contact_network"}}},
      {{"observables", {"fabric", "transient"}}, {"transient", {{"bins", 4}, {"fabric_gap", 0.1}}}},
      {{"observables", {"mean_squared_displacement", "pair_distribution", "contact_network", "profiles"}},
       {"pair_distribution", {{"range", 3}}}},
      {{"contact", {{"friction", nullptr}, {"rolling_stiffness", nullptr}, {"rolling_friction", nullptr}}},
       {"observables", {"contact_network"}}},
      rest,
      {{"flow", {{"shear_rate", 0}}}, {"observables", {"mean_squared_displacement", "stress_correlation"}}},
      {{"flow", {{"shear_rate", 0}}},
       {"contact",
        {{"friction", nullptr},
         {"normal_damping", nullptr},
         {"rolling_stiffness", nullptr},
         {"rolling_friction", nullptr}}},
       {"duration", {{"production", {{"time", 1.2}}}}},
       {"observables", {"linear_response"}}}};
  const Scene plain = read_scene(small_scene(), "scene.json");
  const std::vector<std::string> plain_names = names_of_targets(plain, make_schedule(plain, "scene.json"));
  const std::set<std::string> names_of_all(plain_names.begin(), plain_names.end());
  const Json hints = target_hints(plain);
  for (const Json& patch : patches) {
    JobSpecification job;
    job.scene = small_scene(patch);
    job.scene_name = "scene.json";
    const Json result = run_job(job, {}).value();
    ASSERT_EQ(result["ending"]["cause"], "completed") << patch;
    std::set<std::string> numbers;
    add_numbers(result["mean"], "", numbers);
    std::erase_if(numbers, is_no_target);
    const Scene scene = read_scene(job.scene, "scene.json");
    const std::vector<std::string> names = names_of_targets(scene, make_schedule(scene, "scene.json"));
    EXPECT_EQ(names, std::vector<std::string>(numbers.begin(), numbers.end())) << patch;
    // Quantities of other observables are in the hints of a scene that does not ask for them.
    for (const std::string& name : names) {
      const bool is_of_all = names_of_all.contains(name) || name.starts_with("stress/");
      EXPECT_TRUE(is_of_all || hints.contains(name) || hints.contains(name.substr(0, name.find('/'))))
          << name;
    }
  }
}

}  // namespace
}  // namespace peclet::engine
