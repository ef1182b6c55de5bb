#include "engine/realisation/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/errors.h"
#include "contract/sha256.h"
#include "engine/integrators/derived_groups.h"
#include "engine/integrators/stability.h"
#include "engine/kernels/pair_kinds.h"
#include "engine/observables/observable.h"
#include "engine/observables/production.h"
#include "engine/realisation/packing.h"
#include "engine/scene/composition.h"

namespace peclet::engine {
namespace {

// Smallest number of steps of a cycle of an oscillating flow. Cycles have whole numbers of steps. Moduli from
// implicit steps are sums over mid-steps, with errors of second order: (w dt)^2 / 24 = 1e-4 here.
constexpr double least_steps_of_cycle = 128;

// Largest number of steps of a phase: thousands of years of computing. Step counters hold far more.
constexpr double most_steps = 1e15;

// Returns the steps of the phase `name`, which begins at time `from`. Throws InputError if they are too many.
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

// Returns the distinct radii of the spheres. Throws InputError if the radius of a species has no sphere.
std::vector<double> present_radii(const Particles& particles, const std::string& file) {
  const std::vector<std::size_t> number = species_numbers(particles);
  std::vector<double> present;
  for (std::size_t s = 0; s < number.size(); ++s) {
    if (number[s] > 0) present.push_back(particles.species[s].radius);
  }
  present = distinct_radii(present);
  for (std::size_t s = 0; s < number.size(); ++s) {
    const double radius = particles.species[s].radius;
    if (!std::binary_search(present.begin(), present.end(), radius)) {
      const std::size_t enough = smallest_count(particles);
      throw InputError(
          file, "/particles/count", std::to_string(particles.count),
          fmt::format("must be large enough for one sphere of radius {}, whose share is that of {:.2g} "
                      "spheres; {}{}",
                      radius, exact_numbers(particles)[s],
                      enough > 0 ? fmt::format("{} would do for all sizes", enough)
                                 : fmt::format("not even {} would do for all sizes", most_particles),
                      particles.distributed ? ", and `peclet-engine sizes` merges thin ones" : ""));
    }
  }
  return present;
}

}  // namespace

Schedule make_schedule(const Scene& scene, const std::string& file) {
  const double begin = time_of(scene.equilibration, scene);  // of the window
  Schedule schedule;
  Timestep step = resolved_timestep(scene, file);
  if (!scene.timestep) {
    // A short window gets smaller steps, one for each block.
    step.stay_below(time_of(scene.production, scene, begin) / count_of_blocks, "window");
  }
  if (const std::optional<double> period = scene.physics.flow.period()) {
    step.stay_below(*period / least_steps_of_cycle, "cycle");
    step.value = *period / std::ceil(*period / step.value * (1 - 1e-12));
  }
  schedule.timestep = step.value;
  schedule.timestep_limit = step.limit;
  if (!std::isnormal(schedule.timestep)) {
    throw InputError(file, "/integrator/timestep", fmt::format("{}", schedule.timestep),
                     "must be a normal floating-point number above 0: sizes, forces or durations of the "
                     "scene are too small or too large for double precision; choose other units");
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

std::vector<Warning> schedule_warnings(const Scene& scene, const Schedule& schedule) {
  constexpr double most = 1e13, a_second = 1e6;  // steps of a sphere; docs/speed.md
  const auto steps = static_cast<double>(schedule.total());
  const double work = steps * static_cast<double>(scene.particles.count);
  std::vector<Warning> warnings;
  if (work > most) {
    warn(warnings, "long",
         "a seed has {:.2g} steps of {} spheres, of the order of {:.1g} years of a processor: are "
         "all numbers in one system of units?",
         steps, scene.particles.count, work / a_second / (365 * 24 * 3600.0));
  }
  return warnings;
}

std::string motion_of(const Scene& scene, const Schedule& schedule) {
  Json document = scene.document;
  for (const char* key : {"duration", "observables", "files"}) document.erase(key);
  for (const auto& [name, settings] : scene.observables) document.erase(name);
  document["integrator"]["timestep"] = schedule.timestep;
  return sha256(canonical_json(document));
}

std::uint64_t random_key(const Scene& scene, const Schedule& schedule, std::uint64_t seed) {
  if (scene.seeds_in_common) return seed;
  const std::string hash = sha256(fmt::format("{} {}", motion_of(scene, schedule), seed));
  return std::stoull(hash.substr(0, 16), nullptr, 16);
}

const char* name_of(Ending::Cause cause) {
  constexpr const char* names[] = {"completed",  "jammed",  "overlap",  "displacement",
                                   "non-finite", "packing", "timestep", "script"};
  static_assert(std::size(names) == static_cast<std::size_t>(Ending::Cause::script) + 1);
  return names[static_cast<std::size_t>(cause)];
}

std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius) {
  const double displacement = report.largest_displacement / smallest_radius;
  if (!std::isfinite(displacement) || !report.sums.finite) {
    return Ending{Ending::Cause::non_finite, system.step, "a position or velocity is not finite"};
  }
  // Whatever the guard, spheres must not pass each other in a step: the integrator then evaluates no forces.
  const double largest =
      std::min(guard.largest_displacement, 0.5 * system.list.ranges().largest() / smallest_radius);
  if (displacement > largest) {
    const std::string part =
        report.division == 0 ? "one step" : fmt::format("1/{} of a step", 1 << report.division);
    return Ending{
        Ending::Cause::displacement, system.step,
        fmt::format("a particle moved {:.3g} radii in {}, more than {:.3g}", displacement, part, largest)};
  }
  if (report.sums.largest_overlap > guard.largest_overlap) {
    return Ending{Ending::Cause::overlap, system.step,
                  fmt::format("two particles overlap by {:.3g} radii, more than {:.3g}: jammed, or too soft",
                              report.sums.largest_overlap, guard.largest_overlap)};
  }
  return std::nullopt;
}

void check_fit(const Scene& scene, const Schedule& schedule, const std::string& file) {
  const std::vector<double> sizes = present_radii(scene.particles, file);
  const Vector3 box = box_lengths(scene, cube_edge(scene.particles, scene.volume_fraction));
  const double nearest = scene.physics.flow.deformation().nearest_image() * std::min({box.x, box.y, box.z});
  const double range = range_table(make_pair_kinds(scene.physics, sizes), sizes.size()).largest();
  if (!(nearest > range)) {
    throw InputError(file, "/particles/count", std::to_string(scene.particles.count),
                     fmt::format("must fill a box larger than the range of the forces, {:.4g}, at this "
                                 "volume fraction (its nearest images would be {:.4g} apart)",
                                 range, nearest));
  }
  make_observables(scene, {schedule.timestep, schedule.production, box}, file);
}

}  // namespace peclet::engine
