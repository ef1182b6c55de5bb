// Runs one realisation from its scene to its result, with checkpoints.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "contract/durable_file.h"
#include "engine/realisation/result.h"

namespace peclet::engine {

// Scene, seed, settings and files of a job.
struct JobSpecification {
  ResultHeader header;
  Json scene;
  std::string scene_name;            // in messages
  int threads = 1;                   // at most; a small system uses fewer
  std::filesystem::path checkpoint;  // resumed from if it exists; empty: no checkpoints
  double checkpoint_seconds = 300;
  // Checkpoint from which the job continues if it has no checkpoint of its own; empty: it begins at the
  // start. Its scene may differ in durations, observables and files. The production window begins at this
  // checkpoint if the scene's window would begin before it.
  std::filesystem::path extended;
  std::filesystem::path failures;  // folder for the state of a realisation that broke off; empty: not saved
  std::string files;               // prefix of the names of files beside the result; empty: no files
  // An unusable checkpoint is renamed to .rejected and the job starts again; if false, the job ends.
  bool restart_on_bad_checkpoint = false;
};

struct Progress {
  const char* phase;  // "packing", "equilibration", "production"
  // Steps made and their total. While packing: steps of the minimisation, and 0.
  std::uint64_t step, steps;
  double strain;
};

// Callbacks of a running job, called several times a second.
struct JobEvents {
  // Returns true if the job shall write a checkpoint and end.
  std::function<bool()> drain_requested = [] { return false; };
  std::function<void(const Progress&)> progress = [](const Progress&) {};
  std::function<void(const std::string&)> remark = [](const std::string&) {};  // for a log
  // A checkpoint did not fit onto the disk; the job continues, and tries again some seconds later.
  std::function<void(const NoRoomError&)> skipped = [](const NoRoomError&) {};
  // A file that the job needs at its end did not fit. Returns true to try again now, false to end without it.
  std::function<bool(const NoRoomError&)> wait_for_room = [](const NoRoomError&) { return false; };
};

// Makes the steps of a realisation elsewhere. Returns its ending once it has ended; nothing if it has not at
// `until`, or if the job shall write a checkpoint and end. The realisation is then at home, in its
// Simulation. Adds to `processor_seconds` its share of the time that other threads have spent on it.
using StepsElsewhere = std::function<std::optional<Ending>(
    Simulation&, std::chrono::steady_clock::time_point until, double& processor_seconds)>;

// Returns the result, or nothing if the job was drained. Its checkpoint is then on disk, or, if the disk was
// full, the previous one. The job makes its steps itself unless it is told where they are made. Throws
// InputError, CheckpointError, std::system_error.
std::optional<Json> run_job(const JobSpecification& job, const JobEvents& events,
                            const StepsElsewhere& elsewhere = nullptr);

// Returns the progress of a realisation that has made `step` steps, to a net strain.
Progress progress_of(const Simulation& simulation, std::uint64_t step, double strain);

}  // namespace peclet::engine
