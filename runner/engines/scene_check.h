// Asks the engine about the scenes of a campaign before anything runs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/engines/engine_process.h"
#include "runner/store/point_store.h"

namespace peclet::runner {

struct SceneAnswer {
  std::optional<double> timestep;  // absent if the engine has none
  std::string timestep_limit;      // what keeps it from being longer; "" if the engine does not say
  double steps = 0;                // estimate for the whole realisation
  std::int64_t particles = 0;
  Json derived;  // numbers that follow from the scene, by name
  std::vector<std::string> warnings;
  Json identity;                            // that of the engine
  int capacity = 1;                         // realisations that an engine runs at once
  std::shared_ptr<const Vocabulary> words;  // that of the engine, shared by all answers
};

// Asks an engine process about every point; answers in the order of the points. Writes nothing.
// Throws InputError at /scene... of `campaign_file`, naming the point, for a scene that the engine refuses,
// and at /target/observable for one that the engine says it will not measure; std::runtime_error for an
// engine that cannot be started or does not answer within a minute.
std::vector<SceneAnswer> check_scenes(const Campaign& campaign, const fs::path& campaign_file,
                                      const EngineCommand& command);

// Returns the work of a realisation of each point [steps x particles]; empty if one of them is unknown.
std::vector<double> particle_steps(const std::vector<SceneAnswer>& answers);

struct CostTrial {
  std::optional<double> seconds{};  // time of a worker for one realisation of the scene
  std::string broke_off{};          // "packing: ..." where the realisation ended early; "" where it did not
};

// Estimates the cost of a realisation. The engine runs seed 0 in a temporary folder and is killed after two
// seconds, from which the time of the whole is extrapolated. Beside it run the next of `seeds` seeds, as many
// as the engine runs at once. `seconds` is absent if there is no progress within ten seconds, or if the
// realisation fails or ends early, as one that jams.
CostTrial try_cost(const Json& scene, const EngineCommand& command, int seeds = 1);

}  // namespace peclet::runner
