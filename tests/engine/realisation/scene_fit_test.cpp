// Checks before any sphere is placed, and the names promised before anything is measured.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <set>

#include "engine/realisation/packing.h"
#include "engine/realisation/schedule.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

std::string fault_of(const Json& patch) {
  return refusal_by([&] {
    const Scene scene = scene_from(patch);
    check_fit(scene, make_schedule(scene, "scene.json"), "scene.json");
  });
}

Json with_species(std::size_t count, const Json& species) {
  return {{"particles", {{"count", count}, {"species", species}}}};
}

TEST(SceneFit, IsRefusedWithTheReason) {
  EXPECT_EQ(fault_of(Json::object()), "");
  for (const auto& [patch, fault] : std::vector<std::pair<Json, std::string>>{
           {{{"particles", {{"count", 1}}}}, "/particles/count: 1: must be large enough for one sphere"},
           {{{"volume_fraction", 0.6}, {"particles", {{"count", 1}, {"species", {{{"radius", 1}}}}}}},
            "/particles/count: 1: must fill a box larger than"},
           {{{"observables", {"pair_distribution"}}, {"particles", {{"count", 20}}}},
            "/pair_distribution/range: 4: must be at most"},
           {{{"observables", {"mean_squared_displacement"}},
             {"mean_squared_displacement", {{"interval", 1e300}}}},
            "/mean_squared_displacement/interval: 1 samples: must leave at least 10"}}) {
    EXPECT_TRUE(contains(fault_of(patch), fault));
  }
}

// Number shares of 1 to 999: the first size gets a sphere from 1000 spheres on.
TEST(SceneFit, OfASizeWithoutASphereSaysTheCountThatWouldDo) {
  const Json species = {{{"radius", 1}, {"number_share", 1}}, {{"radius", 1.4}, {"number_share", 999}}};
  const std::string fault = fault_of(with_species(60, species));
  EXPECT_TRUE(contains(fault, "; 1000 would do for all sizes"));
  EXPECT_EQ(fault_of(with_species(1000, species)), "");
  const Json rare = {{{"radius", 1}, {"number_share", 1}}, {{"radius", 1.4}, {"number_share", 1e9}}};
  EXPECT_TRUE(contains(fault_of(with_species(60, rare)), "not even 10000000 would do"));
}

TEST(SceneFit, OfSizesThatCannotBeComputedWithIsRefused) {
  for (const double radius : {1e-300, 1e-80, 1e80, 1e300}) {
    EXPECT_TRUE(contains(fault_of(with_species(60, {{{"radius", radius}}})), "/particles/species/0/radius"))
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
  EXPECT_TRUE(contains(fault_of(with_species(1000, species)), "/particles/species"));
  species.erase(0);
  EXPECT_EQ(fault_of(with_species(1000, species)), "");
}

TEST(SceneFit, ABoxHasItsHeightAndTheVolumeOfTheCube) {
  const Scene cube = scene_from(), tall = scene_from({{"box", {{"height", 20}}}});
  EXPECT_EQ(box_lengths(cube, 9), (Vector3{9, 9, 9}));
  const Vector3 box = box_lengths(tall, 9);
  EXPECT_EQ(box.y, 20);
  EXPECT_EQ(box.x, box.z);
  EXPECT_NEAR(box.x * box.y * box.z, 729, 1e-10);
}

TEST(SceneFit, ABoxNarrowerThanTheRangeOfTheForcesIsRefused) {
  const auto fault = [](double height) { return fault_of(Json{{"box", {{"height", height}}}}); };
  EXPECT_EQ(fault(40), "");
  EXPECT_TRUE(contains(fault(400), "must fill a box larger than the range of the forces"));
  EXPECT_TRUE(contains(fault(1), "must fill a box larger than the range of the forces"));
  EXPECT_TRUE(contains(fault(0), "/box/height"));
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
  EXPECT_TRUE(contains(fault(planar, 2.15), "(its nearest images would be 2.033 apart)"));
  EXPECT_EQ(fault(planar, 2.25), "");
  EXPECT_TRUE(contains(fault(uniaxial, 2.25), "(its nearest images would be 2.037 apart)"));
  EXPECT_EQ(fault(uniaxial, 2.35), "");
}

// The edge is part of the trajectory, so it must equal that for the list of all radii bit by bit.
TEST(SceneFit, TheBoxIsThatOfAllRadii) {
  for (const std::size_t count : {2U, 7U, 60U, 12345U}) {
    const Scene scene = scene_from(with_species(
        count, {{{"radius", 1.1}, {"number_share", 1}}, {{"radius", 0.7}, {"number_share", 2}}}));
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
  const Json hints = target_hints(scene_from());
  EXPECT_EQ(hints["N1"], "is called first_normal_difference");
  // In a flow it is measured; at rest, where the stress does not give it, an observable does.
  EXPECT_EQ(hints["eta_r"], "is called relative_viscosity");
  EXPECT_EQ(target_hints(scene_from(at_rest))["relative_viscosity"],
            "needs \"observables\": [\"linear_response\"] in the scene");
  EXPECT_EQ(hints["storage_modulus"], "needs \"observables\": [\"oscillation\"] in the scene");
  EXPECT_EQ(hints["G'"],
            "is called storage_modulus, which needs \"observables\": [\"oscillation\"] in the scene");
  const Json rest = {{"flow", {{"shear_rate", nullptr}, {"stress", 0.1}}},
                     {"integrator", {{"method", "implicit"}, {"timestep", nullptr}}}};
  for (const char* const name : {"relative_viscosity", "apparent_viscosity"}) {
    EXPECT_EQ(
        target_hints(scene_from(rest))[name],
        "follows from the mean rate at a given stress: name shear_rate, whose relative error is the same; "
        "`peclet plot --quantity apparent_viscosity` draws it");
  }
}

TEST(NamesOfTargets, AreThoseOfTheNumbersThatTheResultHas) {
  const Json patches[] = {
      Json::object(),
      together({without_noise, {{"observables", {"mean_squared_displacement", "contact_network"}}}}),
      {{"observables", {"fabric", "transient"}}, {"transient", {{"bins", 4}, {"fabric_gap", 0.1}}}},
      {{"observables", {"mean_squared_displacement", "pair_distribution", "contact_network", "profiles"}},
       {"pair_distribution", {{"range", 3}}}},
      together({without_friction, {{"observables", {"contact_network"}}}}),
      together({at_rest, {{"duration", {{"equilibration", {{"time", 0.02}}}}}}}),
      together({at_rest, {{"observables", {"mean_squared_displacement", "stress_correlation"}}}}),
      together({at_rest,
                elastic_contacts,
                {{"duration", {{"production", {{"time", 1.2}}}}}, {"observables", {"linear_response"}}}})};
  const Scene plain = scene_from();
  const std::vector<std::string> plain_names = names_of_targets(plain, make_schedule(plain, "scene.json"));
  const std::set<std::string> names_of_all(plain_names.begin(), plain_names.end());
  const Json hints = target_hints(plain);
  for (const Json& patch : patches) {
    const Json result = result_of(patch);
    ASSERT_EQ(result["ending"]["cause"], "completed") << patch;
    std::set<std::string> numbers;
    add_numbers(result["mean"], "", numbers);
    std::erase_if(numbers, is_no_target);
    const Scene scene = scene_from(patch);
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
