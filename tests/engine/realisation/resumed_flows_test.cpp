// Runs in time-dependent flows end in the same bits if cut and resumed, on any number of threads.
#include <gtest/gtest.h>

#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

struct FlowCase {
  const char *name, *flow, *observable, *method;
};

const char* const reversal =
    R"({"segments": [{"shear_rate": 2, "time": 0.2013}, {"shear_rate": -2, "final_rate": 1, "time": 0.2},
                     {"shear_rate": 0}]})";
const char* const across = R"({"shear_rate": 2, "cross_shear": {"amplitude": 0.05, "frequency": 20}})";

const FlowCase flow_cases[] = {{"reversal", reversal, "transient", "explicit"},
                               {"reversal_implicit", reversal, "transient", "implicit"},
                               {"across", across, "contact_network", "explicit"},
                               {"across_implicit", across, "contact_network", "implicit"},
                               {"extension", R"({"extension_rate": 1})", "transient", "explicit"},
                               {"extension_implicit", R"({"extension_rate": 1})", "transient", "implicit"},
                               {"uniaxial", R"({"uniaxial_rate": 1})", "transient", "explicit"},
                               {"biaxial_implicit", R"({"uniaxial_rate": -1})", "transient", "implicit"}};

class ResumedFlow : public testing::TestWithParam<FlowCase> {};
INSTANTIATE_TEST_SUITE_P(OfEachKind, ResumedFlow, testing::ValuesIn(flow_cases),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(ResumedFlow, EndsAsTheUncutOneWhereverItWasCut) {
  Json document = small_scene({{"particles", {{"density", 0.05}}}});
  document["flow"] = Json::parse(GetParam().flow);
  document["duration"]["production"]["time"] = 0.24;
  document["observables"] = {GetParam().observable};
  document["integrator"] = {{"method", GetParam().method}, {"timestep", 0.0008}};
  expect_the_end_of_the_uncut(read_scene(document, "scene.json"), 3,
                              {{0, 1}, {157, 1}, {251, 1}, {252, 1}, {450, 2}});
}

constexpr std::uint64_t three_cycles = std::uint64_t{3} * 128;

class ResumedOscillation : public testing::TestWithParam<const char*> {
 protected:
  // Strain 0.04 sin(50 t): a cycle has 128 steps, the minimum.
  static Scene scene() {
    return scene_from(
        {{"flow", {{"shear_rate", nullptr}, {"oscillation", {{"amplitude", 0.04}, {"frequency", 50}}}}},
         {"integrator", {{"method", GetParam()}, {"timestep", 0.001}}},
         {"particles", {{"density", 0.05}}},
         {"duration", Json::parse(R"({"equilibration": {"time": null, "cycles": 1},
                                                  "production": {"time": null, "cycles": 2}})")},
         {"observables", {"oscillation"}}});
  }
};
INSTANTIATE_TEST_SUITE_P(EitherMethod, ResumedOscillation, testing::Values("explicit", "implicit"),
                         [](const auto& method) { return std::string(method.param); });

// Cuts before, within and between cycles.
TEST_P(ResumedOscillation, EndsAsTheUncutOneWhereverItWasCut) {
  EXPECT_EQ(make_schedule(scene(), "scene.json").total(), three_cycles);
  expect_the_end_of_the_uncut(scene(), 3, {{0, 2}, {57, 2}, {128, 2}, {129, 2}, {300, 2}, {383, 2}});
}

// A whole cycle restores the cell.
TEST_P(ResumedOscillation, EndsInTheCellThatItBeganIn) {
  Simulation run = started(scene(), 3);
  run.advance(128 / 4);
  EXPECT_NEAR(run.system().box.displacement_gradient().column[1].x, 0.04, 1e-12);
  run.advance(three_cycles);
  EXPECT_NEAR(run.system().box.displacement_gradient().column[1].x, 0, 1e-12);
}

}  // namespace
}  // namespace peclet::engine
