#include "engine/realisation/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "engine/observables/production.h"
#include "engine/stability/stability.h"

namespace peclet::engine {
namespace {

// Of an oscillating flow, whose cycles have whole numbers of steps. Of implicit steps moduli are sums over
// mid-steps: their errors are of second order, (w dt)^2 / 24 = 1e-4 of each other here.
constexpr double least_steps_of_cycle = 128;

// Thousands of years of computing; step counters hold far more.
constexpr double most_steps = 1e15;

// Steps of the phase called `name`, which begins then. Throws InputError when there are too many to count.
std::uint64_t steps_of(const Duration& duration, double from, const char* name, const Scene& scene,
                       double timestep, const std::string& file) {
  // A duration that is a whole number of steps must not gain one by rounding.
  const double steps = std::ceil(time_of(duration, scene, from) / timestep * (1 - 1e-12));
  if (!(steps <= most_steps)) {
    throw InputError(file, std::string("/duration/") + name, scene.document.at("duration").at(name).dump(),
                     fmt::format("must last at most {:g} steps of {:.4g}", most_steps, timestep));
  }
  return static_cast<std::uint64_t>(steps);
}

}  // namespace

Schedule make_schedule(const Scene& scene, const std::string& file) {
  const double begin = time_of(scene.equilibration, scene);  // of the window
  Schedule schedule;
  schedule.timestep = resolved_timestep(scene, file);
  if (!scene.timestep) {
    // A short window is divided into as many steps as it needs.
    schedule.timestep =
        std::min(schedule.timestep, time_of(scene.production, scene, begin) / count_of_blocks);
  }
  if (const std::optional<double> period = scene.physics.flow.period()) {
    const double steps = std::ceil(std::max(*period / schedule.timestep * (1 - 1e-12), least_steps_of_cycle));
    schedule.timestep = *period / steps;
  }
  if (!std::isnormal(schedule.timestep)) {
    throw InputError(
        file, "/integrator/timestep", fmt::format("{}", schedule.timestep),
        "must come out as a number above 0: sizes, forces or durations of the scene are beyond what "
        "can be computed with; choose other units");
  }
  schedule.equilibration = steps_of(scene.equilibration, 0, "equilibration", scene, schedule.timestep, file);
  schedule.production = steps_of(scene.production, begin, "production", scene, schedule.timestep, file);
  if (schedule.production < count_of_blocks) {
    throw InputError(file, "/duration/production", scene.document.at("duration").at("production").dump(),
                     fmt::format("must last at least {} steps of {:.4g}, one for each block", count_of_blocks,
                                 schedule.timestep));
  }
  return schedule;
}

}  // namespace peclet::engine
