#include "tests/bench/engine/catalogue.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <algorithm>
#include <iterator>

#include "contract/errors.h"
#include "engine/observables/scene_reading.h"

namespace peclet::engine {
namespace {

// Returns the scene that every case patches: radii 1 and 1.4 in equal volumes, volume fraction 0.5 and shear
// rate 0.045, a Stokes number of 0.045.
Json reference_document(std::size_t count) {
  Json scene = Json::parse(R"({
    "particles": { "density": 0.1,
      "species": [ { "radius": 1.0, "volume_share": 0.5 }, { "radius": 1.4, "volume_share": 0.5 } ] },
    "volume_fraction": 0.5,
    "fluid": { "viscosity": 0.1 },
    "flow": { "shear_rate": 0.045 },
    "contact": { "normal_stiffness": 1e4 },
    "lubrication": { "form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05 },
    "integrator": { "method": "explicit" },
    "duration": { "equilibration": { "strain": 1 }, "production": { "strain": 1000 } } })");
  scene["particles"]["count"] = count;
  return scene;
}

// `patch` is a JSON merge patch: null removes a key.
Contestant contestant(const std::string& name, const std::string& meaning, std::size_t count,
                      const char* patch = "{}") {
  Json document = reference_document(count);
  document.merge_patch(Json::parse(patch));
  return {name, meaning, read_scene(document, name), 1, 1};
}

constexpr const char* brownian = R"({ "flow": null, "peclet": 10,
  "limits": { "shear_rate": 0.045, "thermal_energy": 1.0 } })";
constexpr const char* brownian_friction = R"({ "flow": null, "peclet": 10,
  "limits": { "shear_rate": 0.045, "thermal_energy": 1.0 }, "contact": { "friction": 0.5 } })";

Group reference() {
  return {
      "reference",
      "What does a particle cost?",
      {contestant("frictionless", "contact and lubrication", 1000),
       contestant("friction", "and sliding friction with history", 1000,
                  R"({ "contact": { "friction": 0.5 } })"),
       contestant("brownian", "without friction, pairwise and one-body noise at Pe = 10", 1000, brownian)}};
}

Group size() {
  Group group{"size", "What does a particle cost in a larger system?", {}};
  const auto add = [&](Contestant base, int tiles) {
    base.tiles = tiles;
    group.contestants.push_back(std::move(base));
  };
  add(contestant("size-1024", "frictionless", 1024), 1);
  add(contestant("size-8192", "", 1024), 2);
  add(contestant("size-65536", "", 1024), 4);
  add(contestant("size-1024000", "", 1024), 10);
  add(contestant("brownian-1024", "noise and friction", 1024, brownian_friction), 1);
  add(contestant("brownian-1024000", "", 1024, brownian_friction), 10);
  return group;
}

constexpr const char* four_sizes = R"({ "particles": { "species": [
  { "radius": 1, "volume_share": 0.25 }, { "radius": 1.4, "volume_share": 0.25 },
  { "radius": 5, "volume_share": 0.25 }, { "radius": 7, "volume_share": 0.25 } ] } })";

// Production begins with the first step, so that iterations are counted and samples are taken.
Contestant implicit_contestant(const std::string& name, const std::string& meaning, std::size_t count,
                               const std::string& patch = "{}") {
  Json document = reference_document(count);
  document["integrator"]["method"] = "implicit";
  document["duration"]["equilibration"]["strain"] = 0;
  document.merge_patch(Json::parse(patch));
  return {name, meaning, read_scene(document, name), 1, 1};
}

// Cases for the solver: links, preconditioner, iterations; with noise two systems per step.
Group implicit() {
  const auto at_peclet = [](int peclet) {
    return fmt::format(R"({{ "flow": null, "peclet": {},
      "limits": {{ "shear_rate": 0.009, "thermal_energy": 0.017 }} }})",
                       peclet);
  };
  return {"implicit",
          "What does an implicit step cost?",
          {implicit_contestant("implicit", "contact and lubrication", 1000),
           implicit_contestant("implicit-friction", "and sliding friction, coefficient 1", 1000,
                               R"({ "contact": { "friction": 1 } })"),
           implicit_contestant("implicit-four-sizes", "radii 1, 1.4, 5, 7, equal volumes", 3000, four_sizes),
           implicit_contestant("implicit-peclet-1", "without friction, noise at Pe = 1", 1000, at_peclet(1)),
           implicit_contestant("implicit-peclet-100", "at Pe = 100", 1000, at_peclet(100))}};
}

// Large systems are packed as they are. Copies of a small system would move alike and need its iterations.
Group implicit_size() {
  Group group{"implicit-size", "What does an implicit step cost in a larger system?", {}, 9};
  for (const std::size_t count : {1000U, 4000U, 16384U, 65536U}) {
    group.contestants.push_back(
        implicit_contestant(fmt::format("implicit-{}", count), "contact and lubrication", count));
  }
  return group;
}

Group implicit_threads() {
  Group group{"implicit-threads", "How much faster are implicit steps on several threads?", {}, 9};
  for (int threads = 1; threads <= omp_get_num_procs(); threads *= 2) {
    group.contestants.push_back(
        implicit_contestant(fmt::format("implicit-threads-{}", threads), "contact and lubrication", 16384));
    group.contestants.back().threads = threads;
  }
  return group;
}

Group species() {
  return {"species",
          "What does a near pair cost among small and large spheres?",
          {contestant("two-sizes", "radii 1, 1.4", 10000),
           contestant("four-sizes", "radii 1, 1.4, 5, 7, equal volumes", 10000, four_sizes)}};
}

Group threads() {
  Group group{"threads", "How much faster are several threads?", {}};
  for (int threads = 1; threads <= omp_get_num_procs(); threads *= 2) {
    group.contestants.push_back(contestant(fmt::format("threads-{}", threads), "frictionless", 1024));
    group.contestants.back().tiles = 4;
    group.contestants.back().threads = threads;
  }
  return group;
}

// Cases of a block that is absent, present with strength zero, and present.
Group term(const std::string& name, const char* without, const char* zero, const char* present) {
  return {"term-" + name,
          "What does " + name + " cost?",
          {contestant(name + "-absent", "the block is not there", 1000, without),
           contestant(name + "-zero", "it is there with a strength of zero", 1000, zero),
           contestant(name + "-present", "it acts", 1000, present)}};
}

std::vector<Group> catalogue() {
  return {
      reference(),
      implicit(),
      implicit_size(),
      implicit_threads(),
      size(),
      species(),
      threads(),
      term("friction", "{}", R"({ "contact": { "friction": 0 } })", R"({ "contact": { "friction": 0.5 } })"),
      term("rolling", R"({ "contact": { "friction": 0.5 } })",
           R"({ "contact": { "friction": 0.5, "rolling_stiffness": 0 } })",
           R"({ "contact": { "friction": 0.5, "rolling_stiffness": 2000 } })"),
      term("damping", "{}", R"({ "contact": { "normal_damping": 0 } })",
           R"({ "contact": { "normal_damping": 1 } })"),
      term(
          "repulsion", "{}",
          R"({ "repulsion": { "form": "exponential", "strength": 0, "relative_length": 0.002, "cutoff_lengths": 20 } })",
          R"({ "repulsion": { "form": "exponential", "strength": 0.01, "relative_length": 0.002, "cutoff_lengths": 20 } })"),
      term("noise", "{}", R"({ "fluid": { "thermal_energy": 0 } })", brownian),
  };
}

std::string names_of(const std::vector<Group>& groups) {
  std::vector<std::string> names;
  for (const Group& group : groups) {
    names.push_back(group.name);
    for (const Contestant& each : group.contestants) names.push_back(each.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<Group> chosen_groups(const std::vector<std::string>& names) {
  const std::vector<Group> all = catalogue();
  const auto asked = [&](const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& name : names) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const Group& group) {
      return group.name == name || std::any_of(group.contestants.begin(), group.contestants.end(),
                                               [&](const Contestant& each) { return each.name == name; });
    });
    if (!known) throw InputError("", "", name, "must be in the catalogue: " + names_of(all));
  }
  std::vector<Group> chosen;
  for (const Group& group : all) {
    Group part = group;
    if (!asked(group.name)) {
      std::erase_if(part.contestants, [&](const Contestant& each) { return !asked(each.name); });
    }
    if (!part.contestants.empty()) chosen.push_back(std::move(part));
  }
  return chosen;
}

}  // namespace peclet::engine
