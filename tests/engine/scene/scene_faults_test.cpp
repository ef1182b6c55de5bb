// Every fault of a scene, of its flow and of its sizes has one message: place, value, allowed values.
#include <gtest/gtest.h>

#include <set>

#include "contract/errors.h"
#include "engine/flow/flow_kind.h"
#include "engine/observables/scene_reading.h"
#include "engine/scene/scene.h"
#include "tests/contract/refusal.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

// An edit (RFC 7396: null removes) and its complaint.
struct SceneFault {
  const char* edit;
  const char* pointer;
  const char* value;    // null: any; "X...": begins with X
  const char* allowed;  // a part of it
};

Json patched(Json document, const char* edit) {
  document.merge_patch(Json::parse(edit));
  return document;
}

void expect_fault(const Json& document, const SceneFault& fault) {
  try {
    read_scene(document, "scene.json");
    ADD_FAILURE() << "accepted: " << fault.edit;
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "scene.json") << fault.edit;
    EXPECT_EQ(error.pointer(), fault.pointer) << fault.edit;
    const std::string value = fault.value == nullptr ? error.value() : fault.value;
    if (value.ends_with("...")) {
      EXPECT_TRUE(error.value().starts_with(value.substr(0, value.size() - 3))) << error.value();
    } else {
      EXPECT_EQ(error.value(), value) << fault.edit;
    }
    EXPECT_NE(error.allowed().find(fault.allowed), std::string::npos)
        << fault.edit << ": " << error.allowed();
  }
}

const char* const whole_scene = R"({
  "particles": {"count": 100, "density": 0.1,
                "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
  "volume_fraction": 0.45,
  "fluid": {"viscosity": 0.1, "thermal_energy": 0.017},
  "flow": {"shear_rate": 0.009},
  "contact": {"normal_stiffness": 1e4, "friction": 0.5, "rolling_stiffness": 10},
  "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
  "repulsion": {"form": "exponential", "strength": 1.7},
  "integrator": {"timestep": 1e-4},
  "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})";

const SceneFault faults[] = {
    {R"({"particles": null})", "/particles", "missing", "must be an object"},
    {R"({"particles": {"count": 0}})", "/particles/count", "0", "integer >= 1 and <= 10000000"},
    {R"({"particles": {"count": 1.5}})", "/particles/count", "1.5", "must be an integer"},
    {R"({"particles": {"count": 20000000}})", "/particles/count", "20000000", "<= 10000000"},
    {R"({"particles": {"density": 0}})", "/particles/density", "0", "must be a number > 0"},
    {R"({"particles": {"reference_radius": -1}})", "/particles/reference_radius", "-1", "> 0"},
    {R"({"particles": {"species": []}})", "/particles/species", "[]", "array of 1 to 256"},
    {R"({"particles": {"species": [{"radius": 1, "volume_share": 1}, {"radius": 0, "volume_share": 1}]}})",
     "/particles/species/1/radius", "0", "must be a number > 0"},
    {R"({"particles": {"species": [{"radius": 1, "volume_share": 1}, {"radius": 2, "number_share": 1}]}})",
     "/particles/species/1/number_share", "1", "all must have the same"},
    {R"({"particles": {"species": [{"radius": 1, "number_share": 1}, {"radius": 2, "volume_share": 1}]}})",
     "/particles/species/1/volume_share", "1", "all must have the same"},
    {R"({"particles": {"species": [{"radius": 1, "volume_share": 1, "number_share": 1}]}})",
     "/particles/species/0/volume_share", "1", "must be left out"},
    {R"({"particles": {"species": [{"radius": 1, "volume_share": 1}, {"radius": 2}]}})",
     "/particles/species/1/volume_share", "missing", "each species must have"},
    {R"({"volume_fraction": 0.74})", "/volume_fraction", "0.74", "must be a number > 0 and < 0.74"},
    {R"({"volume_fraction": "dense"})", "/volume_fraction", "\"dense\"", "must be a number"},
    {R"({"fluid": null})", "/fluid", "missing", "must be an object"},
    {R"({"fluid": {"viscosity": -1}})", "/fluid/viscosity", "-1", "must be a number > 0"},
    {R"({"fluid": {"viscosity": null}})", "/fluid/viscosity", "missing", "must be a number > 0"},
    {R"({"fluid": {"thermal_energy": -0.1}})", "/fluid/thermal_energy", "-0.1", ">= 0"},
    {R"({"fluid": {"temperature": 1}})", "/fluid/temperature", "unknown key", "viscosity, thermal_energy"},
    {R"({"flow": {"shear_rate": -1}})", "/flow/shear_rate", "-1", "must be a number >= 0"},
    {R"({"flow": null})", "/flow/shear_rate", "missing", "or /peclet with /limits"},
    {R"({"flow": {"waves": [], "faxen": true}})", "/flow/waves", "[]", "array of 1 to 64"},
    {R"({"flow": {"waves": [{"sine": 1}], "faxen": true}})", "/flow/waves/0/periods", "missing",
     "must be an integer >= 1"},
    {R"({"flow": {"waves": [{"periods": 0.5}], "faxen": true}})", "/flow/waves/0/periods", "0.5",
     "must be an integer"},
    {R"({"flow": {"waves": [{"periods": 1, "sine": "large"}], "faxen": true}})", "/flow/waves/0/sine",
     "\"large\"", "must be a number"},
    {R"({"flow": {"waves": [{"periods": 1, "sine": 1}]}})", "/flow/faxen", "missing",
     "must be true or false where there are /flow/waves"},
    {R"({"peclet": 1, "limits": {"shear_rate": 1, "thermal_energy": 2}})", "/flow/shear_rate", "0.009",
     "left out, because /peclet sets it"},
    {R"({"flow": null, "peclet": 1, "limits": {"shear_rate": 1, "thermal_energy": 2}})",
     "/fluid/thermal_energy", "0.017", "left out, because /peclet sets it"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1})", "/limits", "missing",
     "must be an object with shear_rate, thermal_energy, because peclet is given"},
    {R"({"limits": {"shear_rate": 1, "thermal_energy": 2}})", "/limits",
     R"({"shear_rate":1,"thermal_energy":2})", "must be left out without peclet"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1, "limits": {"shear_rate": 1}})",
     "/limits/thermal_energy", "missing", "must be a number > 0"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1e308,
         "limits": {"shear_rate": 1e-300, "thermal_energy": 1}})",
     "/peclet", "1e+308", "leaves no shear rate and thermal energy"},
    {R"({"flow": null, "peclet": -1})", "/peclet", "-1", "must be a number >= 0"},
    {R"({"contact": {"normal_stiffness": 0}})", "/contact/normal_stiffness", "0", "must be a number > 0"},
    {R"({"contact": {"normal_damping": -1}})", "/contact/normal_damping", "-1", "must be a number >= 0"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "tangential_stiffness": 3}})",
     "/contact/tangential_stiffness", "3", "must be left out without friction"},
    {R"({"contact": {"critical_load": -1}})", "/contact/critical_load", "-1", "must be a number >= 0"},
    {R"({"contact": {"largest_load": 0}})", "/contact/largest_load", "0", "must be a number > 0"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "critical_load": 3}})",
     "/contact/critical_load", "3", "must be left out without friction"},
    {R"({"contact": {"tangential_damping": -1}})", "/contact/tangential_damping", "-1",
     "must be a number >= 0"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "tangential_damping": 3}})",
     "/contact/tangential_damping", "3", "must be left out without friction"},
    {R"({"contact": {"kinetic_friction": -0.1}})", "/contact/kinetic_friction", "-0.1",
     "must be a number >= 0"},
    {R"({"contact": {"kinetic_friction": 0.6}})", "/contact/kinetic_friction", "0.6",
     "must be a number >= 0 and <= /contact/friction, which is 0.5"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "kinetic_friction": 0}})",
     "/contact/kinetic_friction", "0", "must be left out without friction"},
    {R"({"contact": {"friction": 0}})", "/contact/rolling_stiffness", "10",
     "unless /contact/friction is > 0"},
    {R"({"contact": {"rolling_stiffness": null, "rolling_friction": 1}})", "/contact/rolling_friction", "1",
     "must be left out without rolling_stiffness"},
    {R"({"lubrication": {"form": "mari"}})", "/lubrication/inner_gap", "0.001",
     "must be left out unless form is kim-karrila"},
    {R"({"lubrication": {"form": "mari", "inner_gap": null}})", "/lubrication/outer_gap", "0.05",
     "must be left out unless form is kim-karrila"},
    {R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null}})",
     "/lubrication/outer_distance", "missing", "must be a number > 0, because form is mari"},
    {R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "outer_distance": 0}})",
     "/lubrication/outer_distance", "0", "must be a number > 0"},
    {R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "outer_distance": 0.2,
                         "regularisation": 1}})",
     "/lubrication/regularisation", "1", "must be a number > 0 and < 1"},
    {R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "outer_distance": 0.99,
                         "regularisation": 0.01}})",
     "/lubrication/outer_distance", "0.99",
     "< 0.99, which is (1 - /lubrication/regularisation) times the smallest"},
    {R"({"lubrication": {"regularisation": 1e-3}})", "/lubrication/regularisation", "0.001",
     "must be left out unless form is mari"},
    {R"({"lubrication": {"outer_distance": 0.2}})", "/lubrication/outer_distance", "0.2",
     "must be left out unless form is mari"},
    {R"({"lubrication": {"form": "jeffrey"}})", "/lubrication/form", "\"jeffrey\"",
     "must be one of: kim-karrila, mari"},
    {R"({"lubrication": {"inner_gap": 0}})", "/lubrication/inner_gap", "0", "must be a number > 0"},
    {R"({"lubrication": {"inner_gap": 0.05}})", "/lubrication/inner_gap", "0.05", "< /lubrication/outer_gap"},
    {R"({"lubrication": {"outer_gap": 1}})", "/lubrication/outer_gap", "1", "< 1"},
    {R"({"repulsion": {"strength": -1}})", "/repulsion/strength", "-1", "must be a number >= 0"},
    {R"({"repulsion": {"relative_length": 0}})", "/repulsion/relative_length", "0", "must be a number > 0"},
    {R"({"attraction": {"hamaker": 1}})", "/attraction/cutoff", "missing", "must be a number > 0"},
    {R"({"attraction": {"hamaker": -1, "cutoff": 4}})", "/attraction/hamaker", "-1", "must be a number >= 0"},
    {R"({"attraction": {"hamaker": 1, "cutoff": 4, "regularisation": 0}})", "/attraction/regularisation", "0",
     "must be a number > 0"},
    {R"({"repulsion": {"form": "screened"}})", "/repulsion/strength", "1.7",
     "must be left out unless form is exponential"},
    {R"({"repulsion": {"form": "screened", "strength": null, "force": 1, "debye_length": 1}})",
     "/repulsion/reference_radius", "missing", "must be a number > 0, because form is screened"},
    {R"({"repulsion": {"force": 1}})", "/repulsion/force", "1", "must be left out unless form is screened"},
    {R"({"repulsion": {"strength": null, "force": 1}})", "/repulsion/force", "1", "unless form is screened"},
    {R"({"repulsion": {"debye_length": 1}})", "/repulsion/debye_length", "1", "unless form is screened"},
    {R"({"integrator": {"method": "leapfrog"}})", "/integrator/method", "\"leapfrog\"",
     "one of: explicit, implicit"},
    {R"({"integrator": {"method": "explicit", "tolerance": 1e-4}})", "/integrator/tolerance", "0.0001",
     "must be left out"},
    {R"({"integrator": {"method": "implicit", "tolerance": 0.01}})", "/integrator/tolerance", "0.01",
     "<= 0.005"},
    {R"({"integrator": {"timestep": "fast"}})", "/integrator/timestep", "\"fast\"",
     "number > 0, or \"auto\""},
    {R"({"duration": null})", "/duration", "missing", "must be an object"},
    {R"({"duration": {"equilibration": null}})", "/duration/equilibration", "missing", "must be an object"},
    {R"({"duration": {"production": {"strain": null}}})", "/duration/production", "{}",
     "at least one of strain, brownian_times, time"},
    {R"({"duration": {"production": {"strain": 0}}})", "/duration/production/strain", "0",
     "must be a number > 0"},
    {R"({"flow": {"shear_rate": 0}})", "/duration/equilibration", R"({"strain":2})",
     "strain needs a shear rate > 0"},
    {R"({"fluid": {"thermal_energy": null}, "duration": {"production": {"strain": null, "brownian_times": 4}}})",
     "/duration/production", R"({"brownian_times":4})", "brownian_times a thermal energy > 0"},
    {R"({"observables": []})", "/observables", "[]", "array of 1 or more"},
    {R"({"observables": ["stress", "colour"]})", "/observables/1", "\"colour\"", "must be one of: stress"},
    {R"({"contact_network": {}})", "/contact_network", "{}", "must be left out unless /observables lists it"},
    {R"({"observables": ["pair_distribution"], "pair_distribution": {"bin": 0.3}})", "/pair_distribution/bin",
     "0.3", "must divide /pair_distribution/range, which is 4"},
    {R"({"observables": ["fabric"], "fabric": {"gap": 1.5}})", "/fabric/gap", "1.5",
     "must be a number > 0 and <= 1"},
    {R"({"observables": ["transient"], "transient": {"fabric_gap": 0}})", "/transient/fabric_gap", "0",
     "must be a number > 0 and <= 1"},
    {R"({"observables": ["mean_squared_displacement"], "mean_squared_displacement": {"interval": 0}})",
     "/mean_squared_displacement/interval", "0", "must be a number > 0"},
    {R"({"observables": ["stress_correlation"]})", "/observables", R"(["stress_correlation"])",
     "unless the thermal energy is > 0 and the fluid at rest"},
    {R"({"observables": ["linear_response"]})", "/observables", R"(["linear_response"])",
     "must not list linear_response unless the thermal energy is > 0 and the fluid at rest"},
    {R"({"observables": ["linear_response"], "flow": {"shear_rate": 0}, "fluid": {"thermal_energy": 1},
         "duration": {"equilibration": {"strain": null, "time": 1}, "production": {"strain": null, "time": 1}},
         "contact": {"friction": 0.5}})",
     "/observables", R"(["linear_response"])", "with /contact/friction > 0"},
    {R"({"observables": ["linear_response"], "flow": {"shear_rate": 0}, "fluid": {"thermal_energy": 1},
         "duration": {"equilibration": {"strain": null, "time": 1}, "production": {"strain": null, "time": 1}},
         "contact": {"friction": 0, "rolling_stiffness": null, "rolling_friction": null, "normal_damping": 1}})",
     "/observables", R"(["linear_response"])", "with /contact/normal_damping > 0"},
    {R"({"observables": ["linear_response"], "flow": {"shear_rate": 0}, "fluid": {"thermal_energy": 1},
         "duration": {"equilibration": {"strain": null, "time": 1}, "production": {"strain": null, "time": 1}},
         "contact": {"friction": 0, "rolling_stiffness": null, "rolling_friction": null},
         "lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "outer_distance": 0.2}})",
     "/observables", R"(["linear_response"])", "with /lubrication/form mari"},
    {R"({"flow": {"oscillation": {"amplitude": 0.1, "frequency": 1}}})", "/flow/shear_rate", "0.009",
     "must be left out, because /flow/oscillation is given"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1, "frequency": 1},
                  "waves": [{"periods": 1, "sine": 1}], "faxen": false}})",
     "/flow/waves", R"([{"cosine":0,"periods":1,"sine":1}])",
     "must be left out, because /flow/oscillation is given"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0, "frequency": 1}}})",
     "/flow/oscillation/amplitude", "0", "must be a number > 0"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1}}})", "/flow/oscillation/frequency",
     "missing", "must be a number > 0"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1, "frequency": 1}},
         "duration": {"equilibration": {"strain": null, "cycles": 1}, "production": {"strain": null, "cycles": 1.5}}})",
     "/duration/production/cycles", "1.5", "must be a whole number with /flow/oscillation"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1, "frequency": 1}}})",
     "/duration/equilibration/strain", "2", "must be left out with /flow/oscillation"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1, "frequency": 1}},
         "duration": {"equilibration": {"strain": null, "cycles": 1}, "production": {"strain": null, "cycles": 2}},
         "observables": ["trajectory"], "trajectory": {"interval": {"strain": 0.1}}})",
     "/trajectory/interval/strain", "0.1", "must be left out with /flow/oscillation"},
    {R"({"duration": {"production": {"cycles": 3}}})", "/duration/production/cycles", "3",
     "must be left out without /flow/oscillation"},
    {R"({"observables": ["oscillation"]})", "/observables", R"(["oscillation"])",
     "must not list oscillation without /flow/oscillation"},
    {R"({"contact": null, "observables": ["contact_network"]})", "/observables", R"(["contact_network"])",
     "without /contact"},
    {R"({"guard": {"largest_overlap": 0}})", "/guard/largest_overlap", "0", "must be a number > 0"},
    {R"({"guard": {"energy_imbalance": 0}})", "/guard/energy_imbalance", "0", "must be a number > 0"},
    {R"({"guard": {"half_step_difference": -1}})", "/guard/half_step_difference", "-1",
     "must be a number > 0"},
    {R"({"observable": ["stress"]})", "/observable", "unknown key",
     "allowed keys: particles, volume_fraction"},
};

TEST(SceneFaults, TheUneditedSceneIsAccepted) {
  EXPECT_NO_THROW(read_scene(Json::parse(whole_scene), "scene.json"));
}

TEST(SceneFaults, EachIsNamedWithFilePointerValueAndWhatIsAllowed) {
  for (const SceneFault& fault : faults) expect_fault(patched(Json::parse(whole_scene), fault.edit), fault);
}

// The flow, a patch of the rest, and the complaint.
struct FlowFault {
  const char *flow, *patch, *pointer, *value, *allowed;
};

const char* const strains = R"({"duration": {"equilibration": {"time": null, "strain": 1},
                                             "production": {"time": null, "strain": 2}}})";
const char* const stress_times = R"({"duration": {"equilibration": {"time": null, "stress_times": 1},
                                                  "production": {"time": null, "stress_times": 2}}})";

const FlowFault flow_faults[] = {
    {R"({"shear_rate": 1, "extension_rate": 1})", "{}", "/flow/shear_rate", "1",
     "must be left out, because /flow/extension_rate is given"},
    {R"({"segments": [{"shear_rate": 1}], "stress": 2})", "{}", "/flow/stress", "2",
     "must be left out, because /flow/segments is given"},
    {R"({"extension_rate": 0})", "{}", "/flow/extension_rate", "0", "must be a number > 0"},
    {R"({"extension_rate": 1})", R"({"box": {"height": 9}})", "/box", R"({"height":9})",
     "must be left out with /flow/extension_rate"},
    {R"({"extension_rate": 20})", "{}", "/duration", R"({"equilibration":{"time":0.2...)",
     "must have a Hencky strain of at most 10 in all with /flow/extension_rate; it has 16.8"},
    {R"({"extension_rate": 1})", R"({"observables": ["profiles"]})", "/observables", R"(["profiles"])",
     "must not list profiles with /flow/extension_rate"},
    {R"({"uniaxial_rate": 0})", "{}", "/flow/uniaxial_rate", "0", "must be a number other than 0"},
    {R"({"uniaxial_rate": "fast"})", "{}", "/flow/uniaxial_rate", "\"fast\"", "must be a number"},
    {R"({"extension_rate": 1, "uniaxial_rate": 1})", "{}", "/flow/uniaxial_rate", "1",
     "must be left out, because /flow/extension_rate is given"},
    {R"({"uniaxial_rate": -20})", "{}", "/duration", R"({"equilibration":{"time":0.2...)",
     "must have a Hencky strain of at most 10 in all with /flow/uniaxial_rate; it has 16.8"},
    {R"({"uniaxial_rate": 1})", R"({"box": {"height": 9}})", "/box", R"({"height":9})",
     "must be left out with /flow/uniaxial_rate, whose cell is a turned cube"},
    {R"({"uniaxial_rate": 1})", R"({"observables": ["pair_distribution"]})", "/observables",
     R"(["pair_distribution"])", "must not list pair_distribution with /flow/uniaxial_rate"},
    {R"({"uniaxial_rate": 1})", R"({"duration": {"production": {"cycles": 2}}})",
     "/duration/production/cycles", "2", "must be left out without /flow/oscillation or /flow/cross_shear"},
    {R"({"segments": []})", "{}", "/flow/segments", "[]", "array of 1 to 64"},
    {R"({"segments": [{"strain": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0/shear_rate", "missing",
     "must be a number"},
    {R"({"segments": [{"shear_rate": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0",
     R"({"shear_rate":1})", "must have either strain or time"},
    {R"({"segments": [{"shear_rate": 1, "strain": 1, "time": 1}, {"shear_rate": 1}]})", "{}",
     "/flow/segments/0", R"({"shear_rate":1,"strain":1,"time":1})", "must have either strain or time"},
    {R"({"segments": [{"shear_rate": 0, "strain": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0/strain",
     "1", "must be left out where the shear rate is 0"},
    {R"({"segments": [{"shear_rate": 1, "strain": 2}]})", "{}", "/flow/segments/0/strain", "2",
     "must be left out of the last segment, which does not end"},
    {R"({"segments": [{"shear_rate": 1, "strain": 1.5}, {"shear_rate": 0}]})", strains, "/duration",
     R"({"equilibration":{"strain":1...)", "would never end: the flow of /flow/segments"},
    {R"({"shear_rate": 0, "cross_shear": {"amplitude": 0.1, "frequency": 1}})", "{}", "/flow/cross_shear",
     R"({"amplitude":0.1,"frequency":1})", "must be left out unless the shear rate is > 0"},
    {R"({"shear_rate": 1, "cross_shear": {"amplitude": 0.1}})", "{}", "/flow/cross_shear/frequency",
     "missing", "must be a number > 0"},
    {R"({"shear_rate": 1, "cross_shear": {"amplitude": 0.1, "frequency": 1}})",
     R"({"observables": ["oscillation"], "duration": {"equilibration": {"cycles": 1.5}}})",
     "/duration/equilibration/cycles", "1.5", "must be a whole number with the observable oscillation"},
    {R"({"shear_rate": 1, "cross_shear": {"amplitude": 0.1, "frequency": 1}})",
     R"({"observables": ["mean_squared_displacement"]})", "/observables", R"(["mean_squared_displacement"])",
     "with /flow/cross_shear"},
    {R"({"stress": 0})", "{}", "/flow/stress", "0", "must be a number > 0"},
    {R"({"stress": 1})", strains, "/duration/equilibration/strain", "1",
     "must be left out with /flow/stress, whose strain is not known beforehand"},
    {R"({"shear_rate": 1})", stress_times, "/duration/equilibration/stress_times", "1",
     "must be left out without /flow/stress"},
    {R"({"shear_rate": 1, "jammed_viscosity": 100})", "{}", "/flow/jammed_viscosity", "100",
     "must be left out without stress"},
    {R"({"stress": 1})", R"({"observables": ["transient"]})", "/observables", R"(["transient"])",
     "must not list transient with /flow/stress"},
    {R"({"stress": 1})",
     R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "regularisation": 0.001,
                         "outer_distance": 0.2}})",
     "/lubrication/form", "\"mari\"", "must be kim-karrila with /flow/stress and noise"},
    {R"({"shear_rate": 1})", R"({"observables": ["transient"], "transient": {"bins": 0}})", "/transient/bins",
     "0", "must be an integer >= 1"},
    {R"({"oscillation": {"amplitude": 1, "frequency": 1}})",
     R"({"observables": ["transient"], "duration": {"equilibration": {"time": null, "cycles": 1},
                                                    "production": {"time": null, "cycles": 1}}})",
     "/observables", R"(["transient"])", "must not list transient with /flow/oscillation"},
};

TEST(FlowFaults, AreNamedWithWhatIsAllowed) {
  for (const auto& [flow, patch, pointer, value, allowed] : flow_faults) {
    Json document = small_scene(Json::parse(patch));
    document["flow"] = Json::parse(flow);
    SCOPED_TRACE(patch);
    expect_fault(document, {flow, pointer, value, allowed});
  }
}

// A shear rate goes with waves or with a cross shear; all other pairs of flows are refused.
TEST(FlowFaults, NameTheFlowBesideWhichAnotherIsGiven) {
  const Json flows = Json::parse(R"({
      "shear_rate": 1, "oscillation": {"amplitude": 1, "frequency": 1},
      "cross_shear": {"amplitude": 1, "frequency": 1}, "extension_rate": 1, "uniaxial_rate": 1,
      "segments": [{"shear_rate": 1}], "stress": 1, "waves": [{"periods": 1, "sine": 1}]})");
  for (const FlowKind& kind : flow_kinds()) EXPECT_TRUE(flows.contains(kind.key.substr(6))) << kind.key;
  for (const auto& [first, of_first] : flows.items()) {
    for (const auto& [second, of_second] : flows.items()) {
      const std::set<std::string> both = {first, second};
      if (both.size() == 1 || both == std::set<std::string>{"cross_shear", "shear_rate"} ||
          both == std::set<std::string>{"shear_rate", "waves"}) {
        continue;
      }
      Json document = small_scene();
      document["flow"] = {{first, of_first}, {second, of_second}};
      try {
        read_scene(document, "scene.json");
        ADD_FAILURE() << first << " and " << second << " are accepted";
      } catch (const InputError& error) {
        const std::string refused = error.pointer().substr(6), other = refused == first ? second : first;
        EXPECT_TRUE(both.contains(refused)) << error.what();
        EXPECT_EQ(error.allowed(), "must be left out, because /flow/" + other + " is given");
      }
    }
  }
}

const char* const mixed = R"({
  "particles": {"count": 4000, "density": 0.1, "mixture": {
    "colloids": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}],
    "grains": [{"radius": 5}], "alpha": 0.4}},
  "addition": {"added": "grains", "base_volume_fraction": 0.55},
  "fluid": {"viscosity": 0.1},
  "flow": {"shear_rate": 0.009},
  "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})";

const SceneFault mixture_faults[] = {
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
     "/particles/reference_radius", "1", "must be left out, because /particles/mixture/reference is given"},
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

const SceneFault distribution_faults[] = {
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

TEST(CompositionFaults, OfAMixtureAreNamed) {
  EXPECT_NO_THROW(read_scene(Json::parse(mixed), "scene.json"));
  for (const SceneFault& fault : mixture_faults) expect_fault(patched(Json::parse(mixed), fault.edit), fault);
}

TEST(CompositionFaults, OfADistributionAreNamed) {
  EXPECT_NO_THROW(read_scene(Json::parse(distributed), "scene.json"));
  const Json::json_pointer place("/particles/species/0/distribution");
  for (const auto& [edit, pointer, value, allowed] : distribution_faults) {
    Json document = Json::parse(distributed);
    document.at(place).merge_patch(Json::parse(edit));
    expect_fault(document, {edit, (place.to_string() + pointer).c_str(), value, allowed});
  }
}

TEST(CompositionFaults, ASizeIsARadiusOrADistribution) {
  Json document = Json::parse(distributed);
  document["particles"]["species"][0]["radius"] = 1;
  expect_fault(document, {"a radius, too", "/particles/species/0/distribution", nullptr,
                          "must not be given beside radius"});
  document["particles"]["species"][0].erase("radius");
  document["particles"]["species"][0].erase("distribution");
  expect_fault(document, {"neither", "/particles/species/0/radius", "missing", "must be a number > 0"});
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
  expect_fault(document, {"257 sizes", "/particles/species", nullptr, "must be at most 256 sizes"});
}

TEST(CompositionFaults, SpheresOfOneGroupCannotBeDenserThanTheyCanBe) {
  Json document = Json::parse(distributed);
  document["volume_fraction"] = 0.75;
  expect_fault(document, {"dense", "/volume_fraction", "0.75",
                          "must be a number > 0 and < 0.74, with /particles/mixture < 0.93"});
}

}  // namespace
}  // namespace peclet::engine
