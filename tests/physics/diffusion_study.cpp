// Self-diffusion in a suspension at rest: diffusion_study METHOD PHI FIRST_SEED LAST_SEED
//
// The scene is Table 4.1 of Li's thesis at low Péclet numbers without flow: radii 1 and 1.4 in equal volumes,
// eta = rho = 0.1, kT = 0.017, k_n = 1e4, gaps 1e-3 to 0.05, N = 250, 10 Brownian times of equilibration and
// 60 of production. Prints for each seed:
//   - the slope of the mean squared displacement between one and two Brownian times, over that of a free unit
//     sphere, kT / (pi eta a); mean over all particles and over origins half a Brownian time apart
//   - its processor time
// README.md lists the results.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "tests/physics/estimates.h"

namespace {

using namespace peclet::engine;

constexpr double thermal_energy = 0.017, viscosity = 0.1, brownian_time = viscosity / thermal_energy;
constexpr int samples_per_brownian_time = 2, equilibration = 10, window = 60;

Scene scene_at_rest(const char* method, double volume_fraction) {
  peclet::Json document = peclet::Json::parse(R"({
    "particles": {"count": 250, "density": 0.1,
                  "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "flow": {"shear_rate": 0},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"brownian_times": 10}, "production": {"brownian_times": 60}}})");
  document["fluid"] = {{"viscosity", viscosity}, {"thermal_energy", thermal_energy}};
  document["volume_fraction"] = volume_fraction;
  document["integrator"] = {{"method", method}};
  return read_scene(document, "scene.json");
}

std::vector<Vector3> places(const System& system) {
  std::vector<Vector3> result(system.particles.count());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[system.particles.id[i]] =
        system.particles.position[i] + system.box.displacement(system.particles.image[i]);
  }
  return result;
}

// Returns the mean squared displacement relative to the mean displacement of all particles.
double squared_displacement(const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
  Vector3 mean;
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector3 way = to[i] - from[i];
    mean += way;
    sum += dot(way, way);
  }
  const auto count = static_cast<double>(from.size());
  return sum / count - dot(mean, mean) / (count * count);
}

// Returns D / D_0 of one realisation.
double diffusion(const Scene& scene, std::uint64_t seed) {
  const Schedule schedule = make_schedule(scene, "scene.json");
  const double between = brownian_time / samples_per_brownian_time;
  Simulation simulation(scene, schedule, seed, 1, "scene.json");
  simulation.start();
  std::vector<std::vector<Vector3>> sampled;
  for (int sample = 0; sample <= (equilibration + window) * samples_per_brownian_time; ++sample) {
    const auto due = static_cast<std::uint64_t>(std::llround(sample * between / schedule.timestep));
    if (due > simulation.system().step) {
      const auto ending = simulation.advance(due - simulation.system().step);
      if (ending && ending->cause != Ending::Cause::completed) throw std::runtime_error(ending->message);
    }
    if (sample >= equilibration * samples_per_brownian_time) sampled.push_back(places(simulation.system()));
  }
  const auto mean_square = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = 0; k + lag < sampled.size(); ++k) {
      sum += squared_displacement(sampled[k], sampled[k + lag]);
    }
    return sum / static_cast<double>(sampled.size() - lag);
  };
  const std::size_t lag = samples_per_brownian_time;
  const double slope = (mean_square(2 * lag) - mean_square(lag)) / brownian_time;
  return slope / (thermal_energy / (std::numbers::pi * viscosity));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    fmt::print(stderr, "diffusion_study explicit|implicit PHI FIRST_SEED LAST_SEED\n");
    return 2;
  }
  const Scene scene = scene_at_rest(arguments[1], std::atof(arguments[2]));
  std::vector<double> values;
  for (int seed = std::atoi(arguments[3]); seed <= std::atoi(arguments[4]); ++seed) {
    const std::clock_t begin = std::clock();
    values.push_back(diffusion(scene, static_cast<std::uint64_t>(seed)));
    fmt::print("seed {}: D / D_0 = {:.4f}, {:.1f} s\n", seed, values.back(),
               static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    std::fflush(stdout);
  }
  const Estimate mean = estimate(values);
  fmt::print("{} phi {}: D / D_0 = {:.4f} +- {:.4f}\n", arguments[1], arguments[2], mean.mean, mean.error);
  return 0;
}
