// Why a realisation is over.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/endings.h"
#include "engine/integrators/integrator.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

struct Ending {
  enum class Cause { completed, jammed, overlap, displacement, non_finite, packing, timestep };
  Cause cause = Cause::completed;
  std::uint64_t step = 0;
  std::string message;
};

// "completed", "jammed", "overlap", "displacement", "non-finite", "packing", "timestep"
const char* name_of(Ending::Cause cause);

inline bool is_measured(Ending::Cause cause) { return has_results(name_of(cause)); }

// What the guard, or arithmetic, has against the step that was just made. Displacements and overlaps are in
// units of the smallest radius of all, and of the smaller one of the pair.
std::optional<Ending> ending_of(const StepReport& report, const System& system, const Guard& guard,
                                double smallest_radius);

}  // namespace peclet::engine
