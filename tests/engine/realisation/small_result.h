// Results of the small scene.
#pragma once

#include "contract/json.h"
#include "engine/realisation/job.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {

constexpr std::uint64_t seed = 2;

inline Json result_of(const Json& patch) {
  JobSpecification job;
  job.header = {"point", seed};
  job.scene = small_scene(patch);
  job.scene_name = "scene.json";
  return run_job(job, {}).value();
}

inline const Json& usual_result() {
  static const Json result = result_of(Json::object());
  return result;
}

}  // namespace peclet::engine
