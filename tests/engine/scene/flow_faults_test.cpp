// Every fault of a flow has one message: where, what, and what is allowed.
#include <gtest/gtest.h>

#include "contract/input_error.h"
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
    {R"({"segments": []})", "{}", "/flow/segments", "[]", "array of 1 to 64"},
    {R"({"segments": [{"strain": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0/shear_rate", "missing",
     "must be a number"},
    {R"({"segments": [{"shear_rate": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0",
     R"({"shear_rate":1})", "must have either strain or time"},
    {R"({"segments": [{"shear_rate": 1, "strain": 1, "time": 1}, {"shear_rate": 1}]})", "{}",
     "/flow/segments/0", R"({"shear_rate":1,"strain":1,"time":1})", "must have either strain or time"},
    {R"({"segments": [{"shear_rate": 0, "strain": 1}, {"shear_rate": 1}]})", "{}", "/flow/segments/0/strain",
     "1", "must be a time instead where the shear rate is 0"},
    {R"({"segments": [{"shear_rate": 1, "strain": 2}]})", "{}", "/flow/segments/0/strain", "2",
     "must be left out of the last segment, which goes on"},
    {R"({"segments": [{"shear_rate": 1, "strain": 1.5}, {"shear_rate": 0}]})", strains, "/duration",
     R"({"equilibration":{"strain":1)", "would never end: the last of /flow/segments"},
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
     "must be left out without /flow/stress"},
    {R"({"stress": 1})", R"({"observables": ["transient"]})", "/observables", R"(["transient"])",
     "must not list transient with /flow/stress"},
    {R"({"stress": 1})",
     R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "regularisation": 0.001,
                         "outer_distance": 0.2}})",
     "/lubrication/form", "\"mari\"", "must be another one where a stress acts with noise"},
    {R"({"shear_rate": 1})", R"({"observables": ["transient"], "transient": {"bins": 0}})", "/transient/bins",
     "0", "must be an integer >= 1"},
    {R"({"oscillation": {"amplitude": 1, "frequency": 1}})",
     R"({"observables": ["transient"], "duration": {"equilibration": {"time": null, "cycles": 1},
                                                    "production": {"time": null, "cycles": 1}}})",
     "/observables", R"(["transient"])", "must not list transient with a flow that comes and goes"},
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

}  // namespace
}  // namespace peclet::engine
