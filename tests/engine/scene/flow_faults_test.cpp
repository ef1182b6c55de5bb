// Every fault of a flow has one message: place, value, allowed values.
#include <gtest/gtest.h>

#include <set>

#include "contract/errors.h"
#include "engine/flow/flow_kind.h"
#include "engine/observables/scene_reading.h"
#include "engine/scene/scene.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

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
     "must be left out together with /flow/extension_rate"},
    {R"({"segments": [{"shear_rate": 1}], "stress": 2})", "{}", "/flow/stress", "2",
     "must be left out together with /flow/segments"},
    {R"({"extension_rate": 0})", "{}", "/flow/extension_rate", "0", "must be a number > 0"},
    {R"({"extension_rate": 1})", R"({"box": {"height": 9}})", "/box", R"({"height":9})",
     "must be left out with /flow/extension_rate"},
    {R"({"extension_rate": 20})", "{}", "/duration", R"({"equilibration":{"time":0.2)",
     "must have a Hencky strain of at most 10 in all with /flow/extension_rate; it has 16.8"},
    {R"({"extension_rate": 1})", R"({"observables": ["profiles"]})", "/observables", R"(["profiles"])",
     "must not list profiles with /flow/extension_rate"},
    {R"({"uniaxial_rate": 0})", "{}", "/flow/uniaxial_rate", "0", "must be a number other than 0"},
    {R"({"uniaxial_rate": "fast"})", "{}", "/flow/uniaxial_rate", "\"fast\"", "must be a number"},
    {R"({"extension_rate": 1, "uniaxial_rate": 1})", "{}", "/flow/uniaxial_rate", "1",
     "must be left out together with /flow/extension_rate"},
    {R"({"uniaxial_rate": -20})", "{}", "/duration", R"({"equilibration":{"time":0.2)",
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
     R"({"equilibration":{"strain":1)", "would never end: the flow of /flow/segments"},
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
    try {
      read_scene(document, "scene.json");
      ADD_FAILURE() << flow << ' ' << patch << " is accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), "scene.json") << flow;
      EXPECT_EQ(error.pointer(), pointer) << flow << ' ' << patch;
      EXPECT_TRUE(error.value().starts_with(value)) << flow << ": " << error.value();
      EXPECT_NE(error.allowed().find(allowed), std::string::npos) << flow << ": " << error.allowed();
    }
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
        EXPECT_EQ(error.allowed(), "must be left out together with /flow/" + other);
      }
    }
  }
}

}  // namespace
}  // namespace peclet::engine
