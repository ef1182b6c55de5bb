#include "engine/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "contract/input_error.h"
#include "contract/provenance.h"
#include "engine/simulation.h"

namespace peclet::engine {
namespace {

struct Case {
  const char* name;
  const char* meaning;
  double peclet;  // 0: no temperature
  double friction;
};

// All of them: 1000 spheres of radii 1 and 1.4 in equal volumes at volume fraction 0.5, gaps 1e-3 to 0.05,
// rate 0.045.
constexpr Case catalogue[] = {
    {"frictionless", "contact and lubrication", 0, 0},
    {"friction", "contact, sliding friction with history and lubrication", 0, 0.5},
    {"brownian", "contact, lubrication, pairwise and one-body noise at Pe = 10", 10, 0},
};

constexpr int repetitions = 21;
constexpr std::uint64_t steps_per_repetition = 250;
// The packing's contacts must have given way to those of the flow.
constexpr double warm_up_strain = 0.2;

Scene scene_of(const Case& wanted) {
  Json scene = Json::parse(R"({
    "particles": { "count": 1000, "density": 0.1,
      "species": [ { "radius": 1.0, "volume_share": 0.5 }, { "radius": 1.4, "volume_share": 0.5 } ] },
    "volume_fraction": 0.5,
    "fluid": { "viscosity": 0.1 },
    "contact": { "normal_stiffness": 1e4 },
    "lubrication": { "form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05 },
    "duration": { "equilibration": { "strain": 1 }, "production": { "strain": 1000 } } })");
  if (wanted.peclet > 0) {
    scene["peclet"] = wanted.peclet;
    scene["limits"] = {{"shear_rate", 0.045}, {"thermal_energy", 1.0}};
  } else {
    scene["flow"] = {{"shear_rate", 0.045}};
  }
  if (wanted.friction > 0) {
    scene["contact"]["friction"] = wanted.friction;
  }
  return read_scene(scene, wanted.name);
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void measure(const Case& wanted) {
  const Scene scene = scene_of(wanted);
  Simulation simulation(scene, make_schedule(scene, wanted.name), 0, 1, wanted.name);
  simulation.start();
  simulation.advance(
      static_cast<std::uint64_t>(warm_up_strain / scene.physics.shear_rate / simulation.schedule().timestep));
  const std::uint64_t builds = simulation.system().list.builds();
  std::vector<double> nanoseconds;
  for (int r = 0; r < repetitions; ++r) {
    const double start = thread_seconds();
    simulation.advance(steps_per_repetition);
    const double each = static_cast<double>(steps_per_repetition * scene.particles.count);
    nanoseconds.push_back(1e9 * (thread_seconds() - start) / each);
  }
  std::sort(nanoseconds.begin(), nanoseconds.end());
  const double pairs = static_cast<double>(simulation.system().list.pairs().size());
  fmt::print("{:<14} {:>7.1f}   {:>7.1f} .. {:<7.1f}   {:>5.2f}   {:>9.0f}   {}\n", wanted.name,
             nanoseconds[repetitions / 2], nanoseconds.front(), nanoseconds.back(),
             pairs / static_cast<double>(scene.particles.count),
             static_cast<double>(repetitions * steps_per_repetition) /
                 std::max(1.0, static_cast<double>(simulation.system().list.builds() - builds)),
             wanted.meaning);
  std::fflush(stdout);
}

}  // namespace

int run_benchmarks(const std::vector<std::string>& names) {
  std::vector<Case> wanted;
  for (const std::string& name : names) {
    const Case* found = std::find_if(std::begin(catalogue), std::end(catalogue),
                                     [&](const Case& candidate) { return candidate.name == name; });
    if (found == std::end(catalogue)) {
      throw InputError("", "", name, "must be a case of the catalogue: frictionless, friction, brownian");
    }
    wanted.push_back(*found);
  }
  if (wanted.empty()) {
    wanted.assign(std::begin(catalogue), std::end(catalogue));
  }
  const Json& build = provenance();
  fmt::print("peclet-engine {}  commit {}  {}  one thread\n", version(),
             build.at("git_commit").get<std::string>(), build.at("cpu").get<std::string>());
  fmt::print("{} repetitions of {} steps, N = 1000, volume fraction 0.5, after a strain of {}\n\n",
             repetitions, steps_per_repetition, warm_up_strain);
  fmt::print("{:<14} {:>7}   {:^18}   {:>5}   {:>9}   {}\n", "case", "median", "smallest .. largest", "pairs",
             "steps per", "terms");
  fmt::print("{:<14} {:>7}   {:^18}   {:>5}   {:>9}\n", "", "ns per", "particle and step", "per N",
             "rebuild");
  for (const Case& each : wanted) {
    measure(each);
  }
  return 0;
}

}  // namespace peclet::engine
