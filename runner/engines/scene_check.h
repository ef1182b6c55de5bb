// What the engine says about the scenes of a campaign before anything runs.
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
  std::optional<double> timestep;  // none: the engine knows of none
  double steps = 0;                // estimate of the whole realisation
  std::int64_t particles = 0;
  Json derived;
  std::vector<std::string> warnings;        // in words
  Json identity;                            // of the engine that says so
  std::shared_ptr<const Vocabulary> words;  // of the engine, the same of all scenes
};

// Asks an engine process about every point; answers in the order of the points. Writes nothing.
// Throws InputError at /scene... of `campaign_file`, naming the point, for a scene that the engine refuses,
// and at /target/observable for one that the engine says it will not measure; std::runtime_error for an
// engine that cannot be started or does not answer within a minute.
std::vector<SceneAnswer> check_scenes(const Campaign& campaign, const fs::path& campaign_file,
                                      const EngineCommand& command);

// Work of a realisation of each point; nothing unless the engine knows all of them.
std::vector<double> particle_steps(const std::vector<SceneAnswer>& answers);

struct CostTrial {
  std::optional<double> seconds{};  // of a worker for one realisation of the scene
  std::string broke_off{};          // "packing: ..." where the realisation ended early; "" where it did not
};

// Tries what a realisation may cost where nothing is known yet: the engine runs seed 0 in a folder of its own
// that is removed again, and is killed when it has said after two seconds how far it is. No seconds when the
// engine does not get that far within ten seconds, when the realisation ends early, as one that jams, or when
// the engine cannot run the scene.
CostTrial try_cost(const Json& scene, const EngineCommand& command);

}  // namespace peclet::runner
