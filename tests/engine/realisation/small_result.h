// Jobs, realisations and results of the small scene.
#pragma once

#include <vector>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/job.h"
#include "tests/contract/refusal.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {

constexpr std::uint64_t usual_seed = 2;

inline JobSpecification job_of(const Json& scene, const std::string& files = "",
                               std::uint64_t of_seed = usual_seed) {
  JobSpecification job;
  job.header = {"point", of_seed};
  job.scene = scene;
  job.scene_name = "scene.json";
  job.files = files;
  return job;
}

inline Json result_of_scene(const Json& scene) { return run_job(job_of(scene), {}).value(); }
inline Json result_of(const Json& patch) { return result_of_scene(small_scene(patch)); }

inline const Json& usual_result() {
  static const Json result = result_of(Json::object());
  return result;
}

inline Json without_cost(Json result) {
  result.erase("cost");
  return result;
}

inline Scene scene_from(const Json& patch = Json::object()) {
  return read_scene(small_scene(patch), "scene.json");
}

inline Simulation simulation_of(const Scene& scene, std::uint64_t of_seed, int threads = 1) {
  return {scene, make_schedule(scene, "scene.json"), of_seed, threads, "scene.json"};
}

inline Simulation started(const Scene& scene, std::uint64_t of_seed, int threads = 1) {
  Simulation simulation = simulation_of(scene, of_seed, threads);
  simulation.start();
  return simulation;
}

inline std::string bytes_of(const Simulation& simulation) {
  ArchiveWriter archive;
  simulation.save(archive);
  return archive.bytes();
}

// Loads a saved state, and expects that saving loses nothing of it.
inline void load(Simulation& simulation, const std::string& bytes) {
  ArchiveReader reader(bytes);
  simulation.load(reader);
  EXPECT_TRUE(reader.at_end());
  EXPECT_TRUE(bytes_of(simulation) == bytes);
}

// A step at which a run is cut, and the threads of the rest.
struct Cut {
  std::uint64_t step;
  int threads;
};

// Expects that a run ends in the bits of the uncut one wherever it was cut.
inline void expect_the_end_of_the_uncut(const Scene& scene, std::uint64_t of_seed,
                                        const std::vector<Cut>& cuts) {
  Simulation uncut = started(scene, of_seed);
  const std::uint64_t total = uncut.schedule().total();
  const std::optional<Ending> whole = uncut.advance(total);
  ASSERT_TRUE(whole.has_value());
  ASSERT_EQ(whole->cause, Ending::Cause::completed) << whole->message;
  for (const auto& [step, threads] : cuts) {
    Simulation before = started(scene, of_seed), after = simulation_of(scene, of_seed, threads);
    before.advance(step);
    load(after, bytes_of(before));
    const std::optional<Ending> ending = after.advance(total);
    ASSERT_TRUE(ending.has_value());
    EXPECT_EQ(ending->cause, Ending::Cause::completed);
    EXPECT_TRUE(bytes_of(after) == bytes_of(uncut)) << "cut at " << step;
  }
}

}  // namespace peclet::engine
