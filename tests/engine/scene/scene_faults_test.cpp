// Every fault of a scene has one message: where, what, and what is allowed.
#include <gtest/gtest.h>

#include "contract/errors.h"
#include "engine/observables/observable.h"
#include "engine/scene/scene.h"

namespace peclet::engine {
namespace {

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

// One edit of the scene (RFC 7396: null removes), and the complaint about it.
struct Fault {
  const char* edit;
  const char* pointer;
  const char* value;
  const char* allowed;  // a part of it
};

const Fault faults[] = {
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
     "left out together with /peclet"},
    {R"({"flow": null, "peclet": 1, "limits": {"shear_rate": 1, "thermal_energy": 2}})",
     "/fluid/thermal_energy", "0.017", "left out together with /peclet"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1})", "/limits", "missing",
     "must be an object with shear_rate, thermal_energy, because peclet is given"},
    {R"({"limits": {"shear_rate": 1, "thermal_energy": 2}})", "/limits",
     R"({"shear_rate":1,"thermal_energy":2})", "must be left out without peclet"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1, "limits": {"shear_rate": 1}})",
     "/limits/thermal_energy", "missing", "must be a number > 0"},
    {R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 1e308,
         "limits": {"shear_rate": 1e-300, "thermal_energy": 1}})",
     "/peclet", "1e+308", "leaves no shear rate and thermal energy"},
    {R"({"flow": null, "peclet": 0})", "/peclet", "0", "must be a number > 0"},
    {R"({"contact": {"normal_stiffness": 0}})", "/contact/normal_stiffness", "0", "must be a number > 0"},
    {R"({"contact": {"normal_damping": -1}})", "/contact/normal_damping", "-1", "must be a number >= 0"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "tangential_stiffness": 3}})",
     "/contact/tangential_stiffness", "3", "must be left out without friction"},
    {R"({"contact": {"critical_load": -1}})", "/contact/critical_load", "-1", "must be a number >= 0"},
    {R"({"contact": {"largest_load": 0}})", "/contact/largest_load", "0", "must be a number > 0"},
    {R"({"contact": {"friction": null, "rolling_stiffness": null, "critical_load": 3}})",
     "/contact/critical_load", "3", "must be left out without friction"},
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
     "< 0.99, which is 1 - /lubrication/regularisation times the smallest"},
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
     "must be left out together with /flow/oscillation"},
    {R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.1, "frequency": 1},
                  "waves": [{"periods": 1, "sine": 1}], "faxen": false}})",
     "/flow/waves", R"([{"cosine":0,"periods":1,"sine":1}])",
     "must be left out together with /flow/oscillation"},
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
  for (const Fault& fault : faults) {
    Json document = Json::parse(whole_scene);
    document.merge_patch(Json::parse(fault.edit));
    try {
      read_scene(document, "scene.json");
      ADD_FAILURE() << "accepted: " << fault.edit;
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), "scene.json") << fault.edit;
      EXPECT_EQ(error.pointer(), fault.pointer) << fault.edit;
      EXPECT_EQ(error.value(), fault.value) << fault.edit;
      EXPECT_NE(error.allowed().find(fault.allowed), std::string::npos)
          << fault.edit << ": " << error.allowed();
    }
  }
}

}  // namespace
}  // namespace peclet::engine
