// The steps of a realisation: how many, of which size, why they end, and whether the scene fits them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/frames.h"
#include "engine/integrators/integrator.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

// Steps of the two phases; the step size is constant, so they are known before the first one.
struct Schedule {
  double timestep = 0;
  std::uint64_t equilibration = 0, production = 0;

  std::uint64_t total() const { return equilibration + production; }
};

// Throws InputError when the step is too large, the production window shorter than its 32 blocks, or a phase
// longer than can be counted.
Schedule make_schedule(const Scene& scene, const std::string& file);

// Why a realisation is over.
struct Ending {
  enum class Cause { completed, jammed, overlap, displacement, non_finite, packing, timestep };
  Cause cause = Cause::completed;
  std::uint64_t step = 0;
  std::string message;
};

const char* name_of(Ending::Cause cause);

inline bool is_measured(Ending::Cause cause) { return has_results(name_of(cause)); }

// What the guard, or arithmetic, has against the step that was just made. Displacements and overlaps are in
// units of the smallest radius of all, and of the smaller one of the pair.
std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius);

// Checks whether spheres, box and observables of a scene go together, as far as that can be known without
// placing a sphere: within milliseconds for the largest scene. Throws InputError where a species has no
// sphere, where the box is smaller than the range of the forces, and where an observable does not fit.
void check_fit(const Scene& scene, const Schedule& schedule, const std::string& file);

}  // namespace peclet::engine
