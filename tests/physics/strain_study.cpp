// Temperature and diffusion of the strain at a given stress:
//   strain_study PHI COUNT STRESS FIRST_SEED LAST_SEED WINDOW
//
// The scene is Table 4.1 of Li's thesis: radii 1 and 1.4 in equal volumes, eta = rho = 0.1, kT = 0.017,
// k_n = 1e4, gaps 1e-3 to 0.05. STRESS is sigma a^3 / kT; WINDOW [Brownian times] follows 20 Brownian times
// of equilibration. Prints for each seed, with m the mean rate and M the inertia at each step:
//   - <(rate - m)^2> M / kT, which must be 1
//   - D V eta / kT, which must be 1 / eta_r at small stress, with the variance of strains over parts of 6
//     Brownian times
//   - the smallest and the largest M / (V dt eta)
//   - the strain
// README.md lists the results.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/driver.h"
#include "engine/realisation/simulation.h"

namespace {

using namespace peclet::engine;

constexpr double thermal_energy = 0.017, viscosity = 0.1, brownian_time = viscosity / thermal_energy;
constexpr int equilibration = 20, part = 6;

Scene scene_at_stress(double volume_fraction, int count, double stress, int window) {
  peclet::Json document = peclet::Json::parse(R"({
    "particles": {"density": 0.1,
                  "species": [{"radius": 1, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05}})");
  document["particles"]["count"] = count;
  document["fluid"] = {{"viscosity", viscosity}, {"thermal_energy", thermal_energy}};
  document["volume_fraction"] = volume_fraction;
  // Jamming is disabled: a slow flow has not jammed.
  document["flow"] = {{"stress", stress * thermal_energy}, {"jammed_viscosity", 1e12}};
  document["duration"] = {{"equilibration", {{"brownian_times", equilibration}}},
                          {"production", {{"brownian_times", window}}}};
  return read_scene(document, "scene.json");
}

double inertia_of(const Simulation& simulation) {
  return dynamic_cast<const StressControl&>(simulation.driver()).inertia();
}

void advance(Simulation& simulation, std::uint64_t steps) {
  const auto ending = simulation.advance(steps);
  if (ending && ending->cause != Ending::Cause::completed) throw std::runtime_error(ending->message);
}

void study(const Scene& scene, std::uint64_t seed, int window) {
  const Schedule schedule = make_schedule(scene, "scene.json");
  Simulation simulation(scene, schedule, seed, 1, "scene.json");
  simulation.start();
  advance(simulation, schedule.equilibration);
  const double volume = simulation.system().box.volume();
  const auto steps_of_part = static_cast<int>(part * brownian_time / schedule.timestep);
  const int parts = window / part, steps = parts * steps_of_part;
  double rates = 0, energies = 0, momenta = 0, inertias = 0, least = 1e300, largest = 0;
  std::vector<double> strains;
  double before = simulation.system().box.strain();
  const double begin = before;
  for (int n = 0; n < steps; ++n) {
    advance(simulation, 1);
    const double rate = simulation.system().box.velocity_gradient().column[1].x;
    const double inertia = inertia_of(simulation);
    rates += rate / steps;
    energies += inertia * rate * rate / steps;
    momenta += inertia * rate / steps;
    inertias += inertia / steps;
    least = std::min(least, inertia);
    largest = std::max(largest, inertia);
    if ((n + 1) % steps_of_part == 0) {
      strains.push_back(simulation.system().box.strain() - before);
      before = simulation.system().box.strain();
    }
  }
  const double temperature = energies - 2 * rates * momenta + rates * rates * inertias;
  const double mean = (before - begin) / parts;
  double squares = 0;
  for (const double strain : strains) squares += (strain - mean) * (strain - mean) / (parts - 1);
  const double diffusion = squares / (2 * schedule.timestep * steps_of_part);
  fmt::print("{} {:.4f} {:.4f} {:.4g} {:.4g} {:.4g}\n", seed, temperature * volume / thermal_energy,
             diffusion * volume * viscosity / thermal_energy, least / (schedule.timestep * viscosity),
             largest / (schedule.timestep * viscosity), before - begin);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) try {
  if (count != 7) {
    fmt::print(stderr, "strain_study PHI COUNT STRESS FIRST_SEED LAST_SEED WINDOW\n");
    return 2;
  }
  const int window = std::atoi(words[6]);
  const Scene scene = scene_at_stress(std::atof(words[1]), std::atoi(words[2]), std::atof(words[3]), window);
  const std::uint64_t last = std::strtoull(words[5], nullptr, 10);
  for (std::uint64_t seed = std::strtoull(words[4], nullptr, 10); seed <= last; ++seed) {
    study(scene, seed, window);
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "strain_study: {}\n", error.what());
  return 1;
}
