// Why a realisation is over.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/integrators/integrator.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

struct Ending {
  enum class Cause { completed, jammed, overlap, displacement, non_finite, packing, timestep };
  Cause cause = Cause::completed;
  std::uint64_t step = 0;
  std::string message;
};

// Whether it has results: what jams under a stress has, too.
inline bool is_measured(Ending::Cause cause) {
  return cause == Ending::Cause::completed || cause == Ending::Cause::jammed;
}

// "completed", "jammed", "overlap", "displacement", "non-finite", "packing", "timestep"
const char* name_of(Ending::Cause cause);

// What the guard, or arithmetic, has against the step that was just made. Displacements and overlaps are in
// units of the smallest radius of all, and of the smaller one of the pair.
std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius);

}  // namespace peclet::engine
