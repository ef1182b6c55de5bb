// What a realisation may cost, from two seconds of it, where nothing is known yet.
#pragma once

#include <optional>
#include <string>

#include "runner/engines/engine_process.h"

namespace peclet::runner {

struct CostTrial {
  std::optional<double> seconds{};  // of a worker for one realisation of the scene
  std::string broke_off{};          // "packing: ..." where the realisation ended early; "" where it did not
};

// The engine runs seed 0 in a folder of its own that is
// removed again, and is killed when it has said after two seconds how far it is. So it is a guess, from the
// beginning of one realisation. No seconds when the engine does not get that far within ten seconds, when the
// realisation ends early, as one that jams, or when the engine cannot run the scene.
CostTrial try_cost(const Json& scene, const EngineCommand& command);

}  // namespace peclet::runner
