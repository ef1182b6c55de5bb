// What the engine says about the scenes of a campaign before anything runs.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/campaign.h"
#include "runner/engines/engine_process.h"
#include "runner/store/vocabulary.h"

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
std::vector<SceneAnswer> check_scenes(const Campaign& campaign, const std::filesystem::path& campaign_file,
                                      const EngineCommand& command);

// Work of a realisation of each point; nothing unless the engine knows all of them.
std::vector<double> particle_steps(const std::vector<SceneAnswer>& answers);

}  // namespace peclet::runner
