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

// Returns what the result of a complete realisation says in ten lines: its means, each with its standard
// error within this run (of the block means, by their statistical inefficiency), its steps, warnings and
// cost, and `place`, where the result lies. Ends with a newline.
std::string summary(const Json& result, const std::string& place);

// The text of a result: the keys that tell which run it is and the means first, the long lists of blocks
// last. The order has no meaning to a reader of JSON, nor to canonical_json().
std::string result_text(const Json& result);

}  // namespace peclet::engine
