// Chooses the steps and the random numbers of a realisation, finds why it ends, and checks that a scene can
// be run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/frames.h"
#include "engine/integrators/integrator.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Step size and number of steps of the two phases. The step size is constant.
struct Schedule {
  double timestep = 0;
  std::uint64_t equilibration = 0, production = 0;
  const char* timestep_limit = "";  // what keeps the step from being longer, in a word

  std::uint64_t total() const { return equilibration + production; }
};

// Returns the schedule of a scene; `file` is the scene's name in messages. Throws InputError if the step is
// too large, the production window is shorter than its 32 blocks, or a phase has too many steps.
Schedule make_schedule(const Scene& scene, const std::string& file);

// Returns the warning `long` if a seed takes months.
std::vector<Warning> schedule_warnings(const Scene& scene, const Schedule& schedule);

// Returns the SHA-256 of the scene without durations, observables and files, and of the size of the step.
std::string motion_of(const Scene& scene, const Schedule& schedule);

// Returns the key of the random numbers of a realisation: with seeds in common its seed, otherwise 64 bits of
// the SHA-256 of its motion and its seed. Two scenes then share no numbers, and their results are
// independent.
std::uint64_t random_key(const Scene& scene, const Schedule& schedule, std::uint64_t seed);

// Why, and at which step, a realisation ended.
struct Ending {
  enum class Cause { completed, jammed, overlap, displacement, non_finite, packing, timestep, script };
  Cause cause = Cause::completed;
  std::uint64_t step = 0;
  std::string message;
};

const char* name_of(Ending::Cause cause);

// Returns true if a realisation with this ending has means.
inline bool is_measured(Ending::Cause cause) { return has_results(name_of(cause)); }

// Returns the ending if the last step gave numbers that are not finite, or violates the guard. Displacements
// are in units of the smallest radius of all, overlaps in units of the smaller radius of the pair.
std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius);

// Checks a scene in milliseconds, without placing spheres. Throws InputError if a species has no sphere, the
// box is smaller than the range of the forces, or an observable does not fit.
void check_fit(const Scene& scene, const Schedule& schedule, const std::string& file);

}  // namespace peclet::engine
