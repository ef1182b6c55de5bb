// The JSON that a realisation leaves behind; schema/result.schema.json describes it.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"
#include "engine/realisation/checkpoint.h"
#include "engine/realisation/simulation.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

struct ResultHeader {
  std::string point;  // identity of the state point in its campaign; empty for a single run
  std::uint64_t seed = 0;
};

// Means over the production window, in all and in its blocks. Stresses are divided by viscosity * shear_rate,
// or are in the scene's units where the rate is zero. Unless the window is completed, or the flow has jammed
// in it, "mean" and "blocks" are null: never a number.
Json make_result(const ResultHeader& header, const Scene& scene, const Simulation& simulation,
                 const Ending& ending, const std::string& saved_state, const Spent& spent);

// Of a realisation whose spheres could not be packed.
Json make_unpacked_result(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                          const std::string& message, const Spent& spent);

// Names of the numbers in the result of a completed realisation at which a campaign may aim, sorted
// (targets_in()). One that the configuration may leave undefined (friction without a contact) is among them.
std::vector<std::string> names_of_targets(const Scene& scene, const Schedule& schedule);

// What to do about targets that the results do not have: by name, also for what lies below it, the rest of a
// sentence that begins with the name.
Json target_hints(const Scene& scene);

// Provenance of this engine with the instruction set that its results depend on.
const Json& engine_identity();

}  // namespace peclet::engine
