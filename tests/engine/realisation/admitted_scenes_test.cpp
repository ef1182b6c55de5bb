// Combinations of flow, observable, method and start: a scene is refused with a reason, or completes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "contract/sha256.h"
#include "engine/observables/observable.h"
#include "engine/realisation/placed_spheres.h"
#include "engine/realisation/schedule.h"
#include "tests/contract/python_of_debian.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

struct NamedPatch {
  std::string name;
  Json patch;
};

// Returns a scene of 12 spheres and 40 steps.
Json tiny_scene() {
  return Json::parse(R"({
    "particles": {"count": 12, "density": 0.01, "species": [{"radius": 1}]},
    "volume_fraction": 0.1,
    "fluid": {"viscosity": 0.1, "thermal_energy": 0.02},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1000},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "integrator": {"method": "implicit", "timestep": 0.002},
    "guard": {"largest_overlap": 0.5, "largest_displacement": 0.5},
    "pair_distribution": {"range": 2},
    "transient": {"bins": 8},
    "measure": {"script": "one.py",
                "text": "quantities = {'one': {}}\ndef measure(frame):\n    return {'one': 1}\n"},
    "files": {"final_configuration": true, "final_checkpoint": true},
    "duration": {"equilibration": {"time": 0.01}, "production": {"time": 0.08}}})");
}

std::vector<NamedPatch> flows() {
  const char* const texts[][2] = {
      {"rest", R"({"shear_rate": 0})"},
      {"shear", R"({"shear_rate": 2})"},
      {"waves", R"({"shear_rate": 2, "waves": [{"periods": 1, "sine": 0.4}], "faxen": true})"},
      {"waves_alone", R"({"shear_rate": 0, "waves": [{"periods": 2, "cosine": 0.4}], "faxen": false})"},
      {"across", R"({"shear_rate": 2, "cross_shear": {"amplitude": 0.05, "frequency": 20}})"},
      {"oscillation", R"({"oscillation": {"amplitude": 0.1, "frequency": 20}})"},
      {"reversal", R"({"segments": [{"shear_rate": 2, "time": 0.05}, {"shear_rate": -2}]})"},
      {"ramp_and_stop",
       R"({"segments": [{"shear_rate": 0, "final_rate": 2, "time": 0.05}, {"shear_rate": 0}]})"},
      {"extension", R"({"extension_rate": 1.5})"},
      {"uniaxial", R"({"uniaxial_rate": 1.5})"},
      {"biaxial", R"({"uniaxial_rate": -1.5})"},
      {"stress", R"({"stress": 0.3})"}};
  std::vector<NamedPatch> all;
  for (const auto& [name, flow] : texts) {
    Json patch = {{"flow", Json::parse(flow)}};
    if (!patch["flow"].contains("shear_rate")) patch["flow"]["shear_rate"] = nullptr;
    all.push_back({name, patch});
  }
  all.push_back({"peclet", Json::parse(R"({"flow": null, "fluid": {"thermal_energy": null}, "peclet": 10,
                                           "limits": {"shear_rate": 2, "thermal_energy": 0.02}})")});
  return all;
}

// Patches of the scene, applied one at a time.
std::vector<NamedPatch> surroundings() {
  const char* const texts[][2] = {
      {"as it is", "{}"},
      {"explicit", R"({"integrator": {"method": "explicit", "timestep": 0.0004}})"},
      {"without noise", R"({"fluid": {"thermal_energy": null}})"},
      {"explicit without noise",
       R"({"integrator": {"method": "explicit", "timestep": 0.0004}, "fluid": {"thermal_energy": null}})"},
      {"friction", R"({"contact": {"friction": 0.5, "rolling_stiffness": 70, "rolling_friction": 0.2}})"},
      {"no contact", R"({"contact": null})"},
      {"no lubrication", R"({"lubrication": null, "integrator": {"method": "explicit"}})"},
      {"mari", R"({"lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null,
                                   "regularisation": 0.03, "outer_distance": 0.2}})"},
      {"mari without noise",
       R"({"fluid": {"thermal_energy": null},
           "lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null,
                                   "regularisation": 0.03, "outer_distance": 0.2}})"},
      {"attraction", R"({"attraction": {"hamaker": 0.01, "cutoff": 0.1}})"},
      {"height", R"({"box": {"height": 10}})"},
      {"automatic step", R"({"integrator": {"timestep": "auto"}})"}};
  std::vector<NamedPatch> all;
  for (const auto& [name, patch] : texts) all.push_back({name, Json::parse(patch)});
  return all;
}

// Observables that a flow excludes in any surroundings.
bool is_refused(const std::string& flow, const std::string& observable) {
  using Names = std::set<std::string>;
  const Names extensions = {"extension", "uniaxial", "biaxial"};
  // A fluid at rest, with noise.
  if (observable == "stress_correlation" || observable == "linear_response") return flow != "rest";
  // An oscillating flow.
  if (observable == "oscillation") return flow != "across" && flow != "oscillation";
  // A flow that neither oscillates nor has a given stress.
  if (observable == "transient") return Names{"across", "oscillation", "stress"}.contains(flow);
  // The axes of a steady shear.
  if (observable == "mean_squared_displacement")
    return extensions.contains(flow) || flow == "across" || flow == "stress";
  if (observable == "profiles") return extensions.contains(flow) || flow == "stress";
  return observable == "pair_distribution" && extensions.contains(flow);
}

// Python takes a third of a second to start: such an observable is tried in any flow, but not in all
// surroundings.
bool takes_python(const ObservableKind& observable) { return std::string_view(observable.name) == "measure"; }

bool has_turned_cell(const std::string& flow) {
  return flow == "extension" || flow == "uniaxial" || flow == "biaxial";
}

// True if these surroundings exclude an observable that the flow alone allows.
bool is_forbidden(const std::string& around, const std::string& flow, const std::string& observable) {
  const bool mari = around.starts_with("mari"), quiet = around.ends_with("without noise") && flow != "peclet";
  const bool is_linear = observable == "linear_response";
  if (quiet && flow == "rest" && (is_linear || observable == "stress_correlation")) return true;
  if (around == "friction" && flow == "rest" && is_linear) return true;
  if (around == "no contact" && observable == "contact_network") return true;
  // Strain rates of pairs contribute a stress that does not come from forces.
  if (mari && (observable == "oscillation" || observable == "transient")) return true;
  if (mari && !quiet && flow == "stress") return true;
  if (mari && flow == "rest" && is_linear) return true;
  return around == "height" && has_turned_cell(flow);
}

class AdmittedScene : public PythonOfDebian {
 protected:
  // Returns the reason of a refusal, or nothing if the scene is admitted and completes.
  std::string refusal(Json document, const std::string& name) {
    const auto& list = document["observables"];
    const auto lists = [&](const char* observable) {
      return std::find(list.begin(), list.end(), observable) != list.end();
    };
    for (const char* settings : {"pair_distribution", "transient", "measure"}) {
      if (!lists(settings)) document.erase(settings);
    }
    // Its window needs at least 512 steps.
    if (lists("linear_response")) document["duration"]["production"]["time"] = 12;
    try {
      const Scene scene = read_scene(document, "scene.json");
      check_fit(scene, make_schedule(scene, "scene.json"), "scene.json");
      if (scene.start) placed_spheres(scene, usual_seed, "scene.json");
    } catch (const InputError& error) {
      EXPECT_TRUE(error.pointer().starts_with('/') || error.file() != "scene.json") << name << error.what();
      EXPECT_NE(error.allowed(), "") << name;
      return error.what();
    }
    const JobSpecification job = job_of(document, (folder_ / "job.").string());
    try {
      const Json result = run_job(job, {}).value();
      EXPECT_EQ(result["ending"]["cause"], "completed") << name << ": " << result["ending"];
    } catch (const std::exception& error) {
      ADD_FAILURE() << name << " was admitted: " << error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(AdmittedScene, OfAnyFlowWithAnyObservableRunsToItsEnd) {
  for (const auto& [flow, of_flow] : flows()) {
    for (const ObservableKind& entry : observable_kinds()) {
      Json document = tiny_scene();
      document.merge_patch(of_flow);
      document["observables"] = {"stress", entry.name};
      const std::string name = fmt::format("{} + {}", flow, entry.name);
      const std::string reason = refusal(document, name);
      EXPECT_EQ(!reason.empty(), is_refused(flow, entry.name)) << name << ' ' << reason;
    }
  }
}

TEST_F(AdmittedScene, OfAnyFlowAndObservableInAnySurroundingsRunsToItsEnd) {
  for (const auto& [around, patch] : surroundings()) {
    for (const auto& [flow, of_flow] : flows()) {
      Json document = tiny_scene();
      document.merge_patch(patch);
      document.merge_patch(of_flow);
      for (const ObservableKind& entry : observable_kinds()) {
        if (takes_python(entry)) continue;
        document["observables"] = {entry.name};
        const std::string name = fmt::format("{} + {}", flow, entry.name);
        const std::string reason = refusal(document, fmt::format("{} + {}", around, name));
        EXPECT_EQ(!reason.empty(), is_refused(flow, entry.name) || is_forbidden(around, flow, entry.name))
            << around << " + " << name << ' ' << reason;
      }
    }
  }
}

// Starts from the file of another flow and of the same one. Only a box sheared along x is read from a file,
// and turned cells do not start from one.
TEST_F(AdmittedScene, OfAnyFlowThatBeginsInAFileRunsToItsEnd) {
  for (const auto& [before, of_before] : flows()) {
    Json first = tiny_scene();
    first.merge_patch(of_before);
    first["observables"] = {"trajectory"};
    ASSERT_EQ(refusal(first, before), "");
    for (const char* file : {"job.final.xyz", "job.trajectory.gsd"}) {
      const std::string kept = (folder_ / (std::string("start.") + file)).string();
      std::filesystem::copy_file(folder_ / file, kept, std::filesystem::copy_options::overwrite_existing);
      for (const auto& [flow, of_flow] : flows()) {
        Json document = tiny_scene();
        document.merge_patch(of_flow);
        document["observables"] = {"contact_network"};
        document["start"] = {{"file", kept}, {"sha256", sha256_of_file(kept)}};
        const std::string name = fmt::format("{} after {} of {}", flow, file, before);
        const std::string reason = refusal(document, name);
        const bool fits = !has_turned_cell(flow) && !has_turned_cell(before) && before != "across";
        EXPECT_EQ(reason.empty(), fits) << name << ' ' << reason;
      }
    }
  }
}

// The observables that a flow allows do not depend on the start.
TEST_F(AdmittedScene, OfAnyFlowAndObservableAndMethodThatBeginsInAFileRunsToItsEnd) {
  Json first = tiny_scene();
  first["observables"] = {"trajectory"};
  ASSERT_EQ(refusal(first, "first"), "");
  const std::string kept = (folder_ / "start.gsd").string();
  std::filesystem::copy_file(folder_ / "job.trajectory.gsd", kept);
  const Json start = {{"file", kept}, {"sha256", sha256_of_file(kept)}};
  for (const char* method : {"explicit", "implicit"}) {
    for (const auto& [flow, of_flow] : flows()) {
      for (const ObservableKind& entry : observable_kinds()) {
        if (takes_python(entry)) continue;
        Json document = tiny_scene();
        document.merge_patch(of_flow);
        document["integrator"] = {{"method", method}, {"timestep", method[0] == 'e' ? 0.0004 : 0.002}};
        document["observables"] = {entry.name};
        document["start"] = start;
        const std::string name = fmt::format("{} + {}", flow, entry.name);
        const std::string reason = refusal(document, fmt::format("{} + {}", method, name));
        EXPECT_EQ(!reason.empty(), is_refused(flow, entry.name) || has_turned_cell(flow))
            << name << ' ' << reason;
      }
    }
  }
}

}  // namespace
}  // namespace peclet::engine
