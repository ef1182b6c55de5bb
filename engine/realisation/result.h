// Makes the JSON result of a realisation, which schema/result.schema.json describes, and its summary.
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
  std::string ensemble = {};  // name of the ensemble that the process has; empty: it has none
  bool in_ensemble = false;   // the ensemble makes the steps, not the processor
};

// Returns the result: means over the production window and over its blocks. Stresses are in units of
// viscosity * shear_rate, or of the scene if the rate is zero. Unless the window is complete or the flow has
// jammed, "mean" and "blocks" are null.
Json make_result(const ResultHeader& header, const Scene& scene, const Simulation& simulation,
                 const Ending& ending, const std::string& saved_state, const Spent& spent);

// Returns the result of a realisation whose spheres could not be packed.
Json make_unpacked_result(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                          const std::string& message, const Spent& spent);

// Returns the sorted names of the numbers that may be a campaign's target (targets_in()). Some may be
// undefined in a configuration, such as friction without a contact.
std::vector<std::string> names_of_targets(const Scene& scene, const Schedule& schedule);

// Returns advice about targets that results do not have, by name. Each is the rest of a sentence that begins
// with the name, and is also valid for names below it.
Json target_hints(const Scene& scene);

// Returns the provenance of this engine, with the instruction set that its results depend on.
const Json& engine_identity();
// Returns the provenance of a process with an ensemble. It has one identity, with the name of the ensemble
// before the instruction set, which packs the spheres and computes what the ensemble cannot.
Json engine_identity(const std::string& ensemble);

// Returns a summary of a result with means, in about ten lines that end with a newline: means with their
// standard errors within this run (from block means and their statistical inefficiency), steps, warnings,
// cost, and `place`, the name of the result's file.
std::string summary(const Json& result, const std::string& place);

// Returns the text of a result: first the keys that identify the run and the means, last the long blocks.
std::string result_text(const Json& result);

}  // namespace peclet::engine
