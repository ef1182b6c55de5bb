// Sizes that do not fit together are refused by name.
#include <gtest/gtest.h>

#include "contract/errors.h"
#include "engine/observables/scene_reading.h"
#include "engine/scene/scene.h"

namespace peclet::engine {
namespace {

const char* const mixed = R"({
  "particles": {"count": 4000, "density": 0.1, "mixture": {
    "colloids": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}],
    "grains": [{"radius": 5}], "alpha": 0.4}},
  "addition": {"added": "grains", "base_volume_fraction": 0.55},
  "fluid": {"viscosity": 0.1},
  "flow": {"shear_rate": 0.009},
  "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})";

struct CompositionFault {
  const char *edit, *pointer, *value, *allowed;
};

// Each edit of the mixture is a merge patch; null removes a key.
const CompositionFault mixture_faults[] = {
    {R"({"volume_fraction": 0.5})", "/addition", "{\"added\":\"grains\",\"base_volume_fraction\":0.55}",
     "must not be given beside volume_fraction"},
    {R"({"addition": null})", "/volume_fraction", "missing", "must be a number > 0 and < 0.93"},
    {R"({"addition": {"added": "sand"}})", "/addition/added", "\"sand\"", "colloids, grains"},
    {R"({"addition": {"added": null}})", "/addition/added", "missing", "colloids, grains"},
    {R"({"addition": {"base_volume_fraction": 0.74}})", "/addition/base_volume_fraction", "0.74", "< 0.74"},
    {R"({"particles": {"mixture": {"alpha": 1}}})", "/particles/mixture/alpha", "1",
     "must leave a volume fraction < 0.93; with grains added to 0.55 it is 1"},
    {R"({"particles": {"mixture": {"alpha": 0}}, "addition": {"added": "colloids"}})",
     "/particles/mixture/alpha", "0", "with colloids added to 0.55 it is 1"},
    {R"({"particles": {"mixture": {"alpha": 1.01}}})", "/particles/mixture/alpha", "1.01", ">= 0 and <= 1"},
    {R"({"particles": {"mixture": {"alpha": null}}})", "/particles/mixture/alpha", "missing",
     ">= 0 and <= 1"},
    {R"({"particles": {"mixture": {"grains": null}}})", "/particles/mixture/grains", "missing",
     "array of 1 to"},
    {R"({"particles": {"mixture": {"colloids": []}}})", "/particles/mixture/colloids", "[]", "array of 1 to"},
    {R"({"particles": {"mixture": {"colloids": [{"radius": 1, "volume_share": 1}, {"radius": 2}]}}})",
     "/particles/mixture/colloids/1/volume_share", "missing", "each species must have"},
    {R"({"particles": {"mixture": {"grains": [{"radius": 1e90}]}}})", "/particles/mixture/grains/0/radius",
     "1e+90", "choose other units"},
    {R"({"particles": {"mixture": {"reference": "mean"}, "reference_radius": 1}})",
     "/particles/reference_radius", "1", "must be left out together with /particles/mixture/reference"},
    {R"({"particles": {"mixture": {"reference": "largest"}}})", "/particles/mixture/reference", "\"largest\"",
     "colloids, grains, mean"},
    {R"({"particles": {"mixture": {"grains": [{"radius": 1.4, "density": 2}]}}})",
     "/particles/mixture/grains/0/density", "2",
     "must be 0.1, the density of the other spheres of radius 1.4"},
    {R"({"particles": {"species": [{"radius": 1}]}})", "/particles/mixture", nullptr,
     "must not be given beside species"},
    {R"({"particles": {"mixture": null, "species": [{"radius": 1}]}})", "/addition", nullptr,
     "must be left out without /particles/mixture"},
    {R"({"particles": {"mixture": null}})", "/particles/species", "missing", "array of 1 to 256"},
    {R"({"particles": {"density_rule": "equal"}})", "/particles/density_rule", "\"equal\"", "equal-inertia"},
    {R"({"particles": {"density_rule": "equal-inertia", "mixture": {"grains": [{"radius": 5, "density": 1}]}}})",
     "/particles/mixture/grains/0/density", "1", "must be left out with /particles/density_rule"},
    {R"({"particles": {"mixture": {"grains": [{"radius": 5, "density": 0}]}}})",
     "/particles/mixture/grains/0/density", "0", "must be a number > 0"},
};

// A scene with a size distribution, which the edits below change.
const char* const distributed = R"({
  "particles": {"count": 4000, "density": 0.1, "species": [{"distribution":
    {"form": "lognormal", "by": "number", "mean_radius": 1, "relative_width": 0.2}}]},
  "volume_fraction": 0.5,
  "fluid": {"viscosity": 0.1},
  "flow": {"shear_rate": 0.009},
  "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})";

const CompositionFault distribution_faults[] = {
    {R"({"form": "weibull"})", "/form", "\"weibull\"", "lognormal, uniform, gaussian, histogram"},
    {R"({"form": null})", "/form", "missing", "lognormal"},
    {R"({"by": null})", "/by", "missing", "number, volume"},
    {R"({"mean_radius": null})", "/mean_radius", "missing", "must be a number > 0"},
    {R"({"relative_width": null})", "/relative_width", "missing", "must be a number > 0"},
    {R"({"relative_width": 0})", "/relative_width", "0", "must be a number > 0"},
    {R"({"relative_width": 1.1})", "/relative_width", "1.1", "<= 1"},
    {R"({"form": "uniform", "relative_width": 0.56})", "/relative_width", "0.56", "must be at most 0.55"},
    {R"({"form": "gaussian", "relative_width": 0.33})", "/relative_width", "0.33", "must be at most 0.32"},
    {R"({"classes": 0})", "/classes", "0", "must be an integer >= 1 and <= 256"},
    {R"({"classes": 257})", "/classes", "257", "<= 256"},
    {R"({"radii": [1]})", "/radii", "[1]", "must be left out unless form is histogram"},
    {R"({"form": "histogram", "radii": [1], "shares": [1]})", "/mean_radius", "1",
     "must be left out unless form is lognormal or uniform or gaussian"},
    {R"({"form": "histogram", "mean_radius": null, "relative_width": null})", "/radii", "missing",
     "must be an array of 1 to 256, because form is histogram"},
    {R"({"form": "histogram", "mean_radius": null, "relative_width": null, "radii": [1, 2], "shares": [1]})",
     "/shares", "[1]", "must have a share for each of the 2 radii"},
    {R"({"form": "histogram", "mean_radius": null, "relative_width": null, "radii": [1, 2], "shares": [0, 0]})",
     "/shares", "[0,0]", "must have a share > 0"},
    {R"({"form": "histogram", "mean_radius": null, "relative_width": null, "radii": [1, -2], "shares": [1, 1]})",
     "/radii/1", "-2", "must be a number > 0"},
};

void expect_fault(const Json& document, const CompositionFault& fault, const std::string& pointer) {
  try {
    read_scene(document, "scene.json");
    ADD_FAILURE() << "accepted: " << fault.edit;
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), pointer) << fault.edit;
    if (fault.value != nullptr) {
      EXPECT_EQ(error.value(), fault.value) << fault.edit;
    }
    EXPECT_NE(error.allowed().find(fault.allowed), std::string::npos)
        << fault.edit << ": " << error.allowed();
  }
}

TEST(CompositionFaults, OfAMixtureAreNamed) {
  EXPECT_NO_THROW(read_scene(Json::parse(mixed), "scene.json"));
  for (const CompositionFault& fault : mixture_faults) {
    Json document = Json::parse(mixed);
    document.merge_patch(Json::parse(fault.edit));
    expect_fault(document, fault, fault.pointer);
  }
}

TEST(CompositionFaults, OfADistributionAreNamed) {
  EXPECT_NO_THROW(read_scene(Json::parse(distributed), "scene.json"));
  const Json::json_pointer place("/particles/species/0/distribution");
  for (const CompositionFault& fault : distribution_faults) {
    Json document = Json::parse(distributed);
    document.at(place).merge_patch(Json::parse(fault.edit));
    expect_fault(document, fault, place.to_string() + fault.pointer);
  }
}

TEST(CompositionFaults, ASizeIsARadiusOrADistribution) {
  Json document = Json::parse(distributed);
  document["particles"]["species"][0]["radius"] = 1;
  expect_fault(document, {"a radius, too", "", nullptr, "must not be given beside radius"},
               "/particles/species/0/distribution");
  document["particles"]["species"][0].erase("radius");
  document["particles"]["species"][0].erase("distribution");
  expect_fault(document, {"neither", "", "missing", "must be a number > 0"}, "/particles/species/0/radius");
}

TEST(CompositionFaults, SizesOfDistributionsCount) {
  Json document = Json::parse(distributed);
  Json& species = document["particles"]["species"];
  species[0]["distribution"]["classes"] = 128;
  species[0]["volume_share"] = 1;
  species.push_back(species[0]);
  species[1]["distribution"]["mean_radius"] = 2;
  EXPECT_NO_THROW(read_scene(document, "scene.json"));
  species.push_back(Json{{"radius", 9}, {"volume_share", 1}});
  expect_fault(document, {"257 sizes", "", nullptr, "must be at most 256 sizes"}, "/particles/species");
}

TEST(CompositionFaults, SpheresOfOneGroupCannotBeDenserThanTheyCanBe) {
  Json document = Json::parse(distributed);
  document["volume_fraction"] = 0.75;
  expect_fault(document,
               {"dense", "", "0.75", "must be a number > 0 and < 0.74, with /particles/mixture < 0.93"},
               "/volume_fraction");
}

}  // namespace
}  // namespace peclet::engine
