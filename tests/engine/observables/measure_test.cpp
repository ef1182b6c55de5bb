// Scripts of measurements: frames of known configurations, agreement with the engine's own observables,
// resumed runs, and every way in which a script can fail.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "contract/scene_script.h"
#include "tests/contract/python_of_debian.h"
#include "tests/contract/refusal.h"
#include "tests/engine/observables/loose_spheres.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Expects that no process is left.
class Measure : public PythonOfDebian {
 protected:
  ~Measure() override {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
};

// Returns the settings for a script of docs/measure.
Json example(const std::string& name) {
  Json scene = {{"measure", {{"script", "docs/measure/" + name}}}};
  add_script(scene, PECLET_SOURCE_DIR, "scene.json", "");
  return scene["measure"];
}

Json script(const std::string& text) { return {{"script", "mine.py"}, {"text", text}}; }

// Returns a patch for a scene that measures every `steps` steps of the small scene.
Json measuring(const Json& settings, int steps = 16) {
  Json patch = {{"observables", {"measure"}}, {"measure", settings}};
  patch["measure"]["interval"] = 0.002 * steps;
  return patch;
}

// Measures one configuration, which no force acts in.
Json measured(const Json& settings, System system) {
  const Scene scene = scene_with("measure", settings);
  system.list = NeighbourList(range_table(make_pair_kinds(scene.physics, {1}), 1), 0.1);
  system.list.build(system.particles, system.box);
  system.springs = SpringField(spring_kinds(required_terms(scene.physics)), system.list.pairs().size());
  const auto observable = observable_of(scene, system, 256);
  observable->watcher()->begin(system, 1);
  observable->sample(system, 0);
  return mean_of(*observable).at("measure");
}

System spheres_at(const std::vector<Vector3>& places) {
  System system = equal_spheres(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) system.particles.position.set(i, places[i]);
  return system;
}

// A chain of three through a face of the box, a pair, and one alone.
TEST_F(Measure, FindsClusters) {
  const Json found =
      measured(example("clusters.py"),
               spheres_at({{9.5, 2, 2}, {1.49, 2, 2}, {3.48, 2, 2}, {5, 6, 5}, {5, 6, 6.99}, {8, 8, 1}}));
  EXPECT_DOUBLE_EQ(found.at("largest_cluster").get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(found.at("clusters").get<double>(), 0.5);
}

// A triangle, a tail of one sphere at it, and one alone.
TEST_F(Measure, FindsTheKCore) {
  const double height = 1.99 * std::sqrt(0.75);
  const Json found =
      measured(example("k_core.py"),
               spheres_at({{2, 2, 2}, {3.99, 2, 2}, {2.995, 2 + height, 2}, {5.98, 2, 2}, {8, 8, 8}}));
  EXPECT_EQ(found.at("k_core"), Json({0.8, 0.6, 0.0, 0.0, 0.0, 0.0}));
}

// Two overlapping spheres along (2, 1, 0) push each other with k_n delta.
TEST_F(Measure, SeesTheForcesOfAStep) {
  const Vector3 n = (1 / std::sqrt(5.0)) * Vector3{2, 1, 0};
  Json settings = example("force_order.py");
  for (const bool is_implicit : {false, true}) {
    Json patch = measuring(settings, 1000);
    const double overlap = 1e-4, stiffness = 1e4;
    patch.update(Json::parse(R"({
      "particles": {"count": 2, "species": [{"radius": 1}]}, "volume_fraction": 0.01, "flow": {"shear_rate": 0},
      "fluid": {"viscosity": 0.1}, "contact": {"normal_stiffness": 1e4},
      "integrator": {"timestep": 1e-7}, "duration": {"equilibration": {"time": 0}, "production": {"time": 4e-6}}})"));
    patch["integrator"]["method"] = is_implicit ? "implicit" : "explicit";
    Json document = small_scene();
    for (const char* key : {"lubrication", "repulsion", "contact", "fluid"}) document.erase(key);
    document.update(patch, /*merge_objects=*/true);
    document["particles"]["species"] = patch["particles"]["species"];
    document["measure"]["text"] = settings["text"].get<std::string>() +
                                  "\nquantities['push'] = {}\nangles = measure\n"
                                  "def measure(frame):\n"
                                  "    pair, = [frame.pairs[[0]]]\n"
                                  "    assert len(frame.pairs) == 1 and len(frame.contacts) == 1 and "
                                  "(pair.first, pair.second) == (0, 1)\n"
                                  "    return angles(frame) | {'push': -pair.force[0] @ pair.normal[0]}\n";
    const Scene scene = read_scene(document, "scene.json");
    Simulation simulation = simulation_of(scene, usual_seed);
    System placed = simulation.system();
    placed.particles.position.set(0, {1, 1, 1});
    placed.particles.position.set(1, Vector3{1, 1, 1} + (2 - overlap) * n);
    simulation.start(placed, true);
    const std::optional<Ending> ending = simulation.advance(40);
    ASSERT_EQ(ending->cause, Ending::Cause::completed) << ending->message;
    const Json found = mean_of(*simulation.observables().front()).at("measure");
    EXPECT_NEAR(found.at("push").get<double>(), stiffness * overlap, 1e-3 * stiffness * overlap);
    EXPECT_NEAR(found.at("force_order").get<double>(), 1, 1e-9);
    EXPECT_NEAR(found.at("force_angle").get<double>(), std::atan(0.5) * 180 / std::numbers::pi, 1e-6);
  }
}

// A way to step and a flow.
struct MeasuredWay {
  const char* name;
  Json patch;
};
const MeasuredWay measured_ways[] = {
    {"explicit", Json::object()},
    {"implicit", implicit_and_light},
    {"implicit_with_divided_steps",
     together({implicit_and_light, {{"guard", {{"largest_displacement", 0.01}}}}})},
    {"at_rest", together({at_rest, Json::parse(R"({"fluid": {"thermal_energy": 1}})")})},
    {"in_extension",
     together({implicit_and_light, Json::parse(R"({"flow": {"shear_rate": null, "extension_rate": 1}})")})},
    {"in_oscillation",
     Json::parse(R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 0.2, "frequency": 20}}})")},
    {"at_a_given_stress",
     together(
         {implicit_and_light, without_noise,
          Json::parse(R"({"flow": {"shear_rate": null, "stress": 3}, "integrator": {"timestep": 5e-4}})")})},
};
class MeasureInEveryWay : public Measure, public testing::WithParamInterface<MeasuredWay> {};
INSTANTIATE_TEST_SUITE_P(Flows, MeasureInEveryWay, testing::ValuesIn(measured_ways),
                         [](const auto& way) { return std::string(way.param.name); });

// Whatever the flow: the observables fabric and contact_network, in the one frame that both sample, and the
// stress of that step; nearest images; the motion of images.
TEST_P(MeasureInEveryWay, AgreesWithTheEngine) {
  Json patch =
      together({GetParam().patch, measuring(example("fabric.py"), 1000),
                Json::parse(R"({"observables": ["measure", "fabric", "contact_network", "trajectory"],
                           "fabric": {"interval": 2}, "contact_network": {"interval": 2},
                           "trajectory": {"interval": {"time": 2}}})")});
  patch["measure"]["text"] = patch["measure"]["text"].get<std::string>() + R"(
quantities |= {"contacts": {"axes": [{"name": "contacts", "values": range(13)}]},
               "sliding": {}, "fault": {}, "stress": {"axes": [{"name": "component", "values": [0, 1, 2, 3, 4, 5]}]}}
fabric = measure

def measure(frame):
    pairs, touch = frame.pairs, frame.contacts
    apart = frame.positions[pairs.second] - frame.positions[pairs.first]
    stress = frame.stress.sum(0) / abs(np.linalg.det(frame.box))
    number = np.bincount(np.append(touch.first, touch.second), minlength=frame.count)
    faults = [frame.nearest(apart) - pairs.separation,
              np.linalg.norm(pairs.separation, axis=1) - (1 + pairs.gap / 2) * (frame.radii[pairs.first] + frame.radii[pairs.second]),
              pairs.normal * np.linalg.norm(pairs.separation, axis=1)[:, None] - pairs.separation,
              frame.radii - np.where(frame.species == 0, 1, 1.4),
              touch.normal_force + 1e4 * touch.gap * (frame.radii[touch.first] + frame.radii[touch.second]) / 2]
    return fabric(frame) | {"contacts": np.bincount(np.minimum(number, 12), minlength=13) / frame.count,
                            "sliding": touch.sliding.mean() if len(touch) else None,
                            "fault": max(abs(fault).max(initial=0) for fault in faults),
                            "stress": stress[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]}
)";
  Simulation simulation = started(scene_from(patch), usual_seed);
  const std::optional<Ending> ending = simulation.advance(simulation.schedule().total());
  ASSERT_EQ(ending->cause, Ending::Cause::completed) << ending->message;
  Json mean = Json::object();
  for (const auto& observable : simulation.observables()) observable->add_to(mean);
  const Json& found = mean.at("measure");
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(found["fabric"][k].get<double>(), mean["fabric"]["contacts"][k].get<double>(), 1e-12);
  }
  for (std::size_t k = 0; k < 13; ++k) {
    EXPECT_NEAR(found["contacts"][k].get<double>(), mean["contact_network"]["contacts"][k].get<double>(),
                1e-12);
  }
  EXPECT_LT(found["contacts"][0].get<double>(), 1);
  EXPECT_NEAR(found["sliding"].get<double>(), mean["sliding_contacts"].get<double>(), 1e-12);
  EXPECT_LT(found["fault"].get<double>(), 1e-9);
}

// V times the total stress is that of the solvent and of the spheres; the result has it in units of eta rate.
TEST_F(Measure, HasSpheresWhoseStressesAddUpToThatOfTheResult) {
  const Json settings = script(R"(
import numpy as np
quantities = {"shear_stress": {"unit": "stress"}, "force_of_pairs": {"unit": "stress"}}
def measure(frame):
    volume, pairs = np.linalg.det(frame.box), frame.pairs
    return {"shear_stress": frame.stress[:, 0, 1].sum() / volume,
            "force_of_pairs": (pairs.separation[:, 0] * pairs.force[:, 1] + pairs.separation[:, 1] * pairs.force[:, 0]).sum() / 2 / volume}
)");
  const Json result = result_of(together({measuring(settings, 1), without_noise}));
  ASSERT_EQ(result["ending"]["cause"], "completed") << result["ending"];
  const double unit = 0.1 * 2;  // eta rate
  const Json &mean = result["mean"], &found = mean["measure"];
  EXPECT_NEAR(found["shear_stress"].get<double>() / unit, mean["stress"]["total"][3].get<double>() - 1, 1e-9);
  // Pairs are at the end of the step here, and where forces act in the result.
  const double of_pairs = unit * (mean["relative_viscosity_pair"].get<double>());
  EXPECT_NEAR(found["force_of_pairs"].get<double>(), of_pairs, 0.02 * std::abs(of_pairs));
  EXPECT_EQ(result["blocks"]["measure"]["shear_stress"].size(), 32u);
  EXPECT_EQ(result["quantities"]["measure/shear_stress"]["unit"], "stress");
  EXPECT_GT(result["cost"]["cpu_seconds"], 0);
}

// Each frame has a fresh copy of the script, because checkpoints do not hold what a script keeps.
const char* const forgetful = R"(
import numpy as np
calls = 0
quantities = {"calls": {}, "radius_of_gyration": {}, "seldom": {}}
def measure(frame):
    global calls
    calls += 1
    frame.scene["particles"] = None
    print("standard output is not that of the engine")
    return {"calls": calls, "radius_of_gyration": np.sqrt((frame.positions**2).sum() / frame.count),
            "seldom": frame.time if frame.step % 32 == 5 else None}
)";

TEST_P(MeasureInEveryWay, EndsAsTheUncutRunIfItIsResumed) {
  const Json patch = together({GetParam().patch, measuring(script(forgetful))});
  expect_the_end_of_the_uncut(scene_from(patch), usual_seed, {{117, 1}, {250, 1}});
}

TEST_F(Measure, KeepsNothingFromFrameToFrame) {
  const Json result = result_of(measuring(script(forgetful), 4));
  const Json& found = result["mean"]["measure"];
  EXPECT_EQ(found["calls"], 1);
  EXPECT_TRUE(found["seldom"].is_number());
  EXPECT_TRUE(result["blocks"]["measure"]["seldom"].is_array());
}

// Every 5th of 320 steps after 100: the steps 101 to 416.
TEST_F(Measure, HasSixtyFourFramesUnlessTold) {
  Json patch =
      measuring(script("quantities = {'step': {}}\ndef measure(frame): return {'step': frame.step}\n"));
  patch["measure"].erase("interval");
  EXPECT_EQ(result_of(patch)["mean"]["measure"]["step"], (101 + 416) / 2.0);
}

TEST_F(Measure, IsRefusedBeforeItRuns) {
  const std::string good = "quantities = {'x': {}}\ndef measure(frame): return {'x': 1}\n";
  for (const auto& [text, fault] : std::vector<std::pair<std::string, std::string>>{
           {good, ""},
           {"quantities = {'x': {}}\ndef measure(frame) return 1\n",
            "/measure/script: mine.py, line 2: SyntaxError: expected ':'"},
           {"\n\nimport no_such_module\n", "mine.py, line 3: ModuleNotFoundError: No module named "},
           {"def measure(frame): return {'x': 1}\n", "mine.py: must have quantities = "},
           {"quantities = {'x': {}}\nmeasure = 3\n", "mine.py: must have a function measure(frame)"},
           {"quantities = {'x y': {}}\n" + good.substr(23), "quantities has the name 'x y'"},
           {"quantities = {'x': {'units': 'm'}}\n" + good.substr(23),
            "quantities[\"x\"] has the unknown key 'units'; known are symbol, unit, axes"},
           {"quantities = {'x': {'axes': [{'name': 'k', 'values': []}]}}\n" + good.substr(23),
            "quantities[\"x\"]: axis 0 must have values"},
           {"import os\nos._exit(3)\n", "mine.py: ended its process with exit code 3"},
           {"raise SystemExit('no')\n", "mine.py, line 1: SystemExit: no"}}) {
    const std::string found = refusal_by([&text = text] { scene_from(measuring(script(text))); });
    EXPECT_TRUE(fault.empty() ? found.empty() : found.find(fault) != std::string::npos) << found;
  }
  Json impatient = script("while True: pass\n");
  impatient["patience"] = 0.3;
  EXPECT_NE(refusal_by([&] { scene_from(measuring(impatient)); }).find("gave no answer within 0.3 s"),
            std::string::npos);
  EXPECT_NE(refusal_by([&] {
              scene_from({{"observables", {"measure"}}});
            }).find("/measure/script: missing"),
            std::string::npos);
  EXPECT_NE(refusal_by([&] {
              scene_from(measuring({{"script", "mine.py"}}));
            }).find("/measure/text: missing"),
            std::string::npos);
}

TEST_F(Measure, NeedsPythonWithNumPy) {
  setenv("PATH", "/var/empty", 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_NE(refusal_by([&] {
              scene_from(measuring(script("x = 1")));
            }).find("scripts need python3 with NumPy in PATH, and python3 cannot be run"),
            std::string::npos);
}

// The message names the script and its line, and the result has no means.
TEST_F(Measure, EndsTheRealisationIfItFails) {
  for (const auto& [body, fault] : std::vector<std::pair<std::string, std::string>>{
           {"return {'x': 1 / (frame.count - 60), 'y': [1, 2]}",
            "mine.py, line 3: ZeroDivisionError: division"},
           {"return {'x': float('nan'), 'y': [1, 2]}", "mine.py: measure() returned \"x\" with nan"},
           {"return {'x': 1}", "must return all that quantities names and nothing else: see 'y'"},
           {"return {'x': 1, 'y': [1, 2], 'z': 0}", "nothing else: see 'z'"},
           {"return {'x': 1, 'y': [1, 2, 3]}", "returned \"y\" of shape (3,); its axes say (2,)"},
           {"return {'x': 'one', 'y': [1, 2]}",
            "returned \"x\" as str; must be a number or a list of numbers"},
           {"return None", "measure() must return a dict, not NoneType"},
           {"import sys; sys.exit('enough')", "mine.py, line 3: SystemExit: enough"},
           {"import os; os._exit(7)", "mine.py: ended its process with exit code 7"},
           {"import os; os.abort()", "mine.py: its process was ended by signal 6 (Aborted)"},
           {"while True: pass", "mine.py: gave no answer within 4 s, its /measure/patience"}}) {
    Json settings = script(
        "quantities = {'x': {}, 'y': {'axes': [{'name': 'k', 'values': [1, 2]}]}}\n"
        "def measure(frame):\n    " +
        body + "\n");
    if (body.starts_with("while"))
      settings["patience"] = 4;  // Python must have begun by then on a busy machine
    const Json result = result_of(measuring(settings));
    EXPECT_EQ(result["ending"]["cause"], "script");
    EXPECT_NE(result["ending"]["message"].get<std::string>().find(fault), std::string::npos)
        << result["ending"];
    EXPECT_TRUE(result["mean"].is_null());
  }
}

// This says nothing about the script; the runner tries the seed again.
TEST_F(Measure, IsAnErrorOfTheEngineIfItIsKilledFromOutside) {
  const Json settings = script(
      "import os, signal\nquantities = {'x': {}}\ndef measure(frame): os.kill(os.getpid(), "
      "signal.SIGKILL)\n");
  EXPECT_THROW(result_of(measuring(settings)), std::runtime_error);
}

TEST(SceneScript, IsReadBesideTheScene) {
  const auto refusal = [](const std::string& name) {
    return refusal_by([&] {
      Json scene = {{"measure", {{"script", name}}}};
      add_script(scene, PECLET_SOURCE_DIR "/docs", PECLET_SOURCE_DIR "/docs/flow.json", "/scene");
    });
  };
  EXPECT_EQ(refusal("measure/fabric.py"), "");
  EXPECT_NE(refusal("absent.py").find("/docs/flow.json: /scene/measure/script: \"absent.py\": "),
            std::string::npos)
      << refusal("absent.py");
  EXPECT_NE(refusal("measure"), "");
  EXPECT_NE(refusal("pictures/python.png"), "");
}

}  // namespace
}  // namespace peclet::engine
