#include "engine/jobs/job.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/input_error.h"
#include "contract/key_table.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/output/final_configuration.h"
#include "engine/start/packing.h"

namespace peclet::engine {
namespace {

using Clock = std::chrono::steady_clock;

// Fewer particles per thread than this lose more by waiting for each other than they gain; so do more threads
// than processors. The result is the same.
constexpr std::size_t fewest_particles_per_thread = 4000;

// How soon a checkpoint is tried again that did not fit onto the disk.
constexpr std::chrono::duration<double> when_full{5};

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// What this realisation has cost, in this process and in those before it.
class Meter {
 public:
  explicit Meter(Spent before) : before_(before), processor_(processor_seconds()), start_(Clock::now()) {}

  Spent spent() const {
    return {before_.processor_seconds + processor_seconds() - processor_,
            before_.wall_seconds + std::chrono::duration<double>(Clock::now() - start_).count()};
  }
  void add(const Spent& earlier) {
    before_.processor_seconds += earlier.processor_seconds;
    before_.wall_seconds += earlier.wall_seconds;
  }

 private:
  Spent before_;
  double processor_;
  Clock::time_point start_;
};

Progress progress_of(const Simulation& simulation) {
  const std::uint64_t step = simulation.system().step;
  return {step < simulation.schedule().equilibration ? "equilibration" : "production", step,
          simulation.schedule().total(), simulation.system().box.strain()};
}

class Job {
 public:
  Job(const JobSpecification& job, const JobEvents& events)
      : job_(job),
        events_(events),
        meter_(Spent{}),
        scene_(read_scene(job.scene, job.scene_name)),
        schedule_(make_schedule(scene_, job.scene_name)),
        identity_{sha256(canonical_json(scene_.document)), job.header.seed,
                  provenance().at("binary_sha256").get<std::string>()} {}

  std::optional<Json> run() {
    if (scene_.final_configuration && job_.files.empty()) {
      throw InputError(job_.scene_name, "/files", shortened(scene_.document["files"]),
                       "must be left out where files cannot be left: `peclet-engine run` needs --output with "
                       "the name of a file, beside which they are put");
    }
    std::optional<Ending> ending;
    try {
      begin();
      ending = loop();
    } catch (const PackingError& error) {
      return make_unpacked_result(job_.header, scene_, schedule_, error.what(), meter_.spent());
    }
    if (!ending) {
      if (!save(job_.checkpoint))
        events_.remark("no room for a checkpoint: what came after the last one is lost");
      return std::nullopt;
    }
    std::string state;
    if (!save_state(*ending, state)) return std::nullopt;
    Json result = make_result(job_.header, scene_, *simulation_, *ending, state, meter_.spent());
    if (scene_.final_configuration && ending->cause == Ending::Cause::completed) {
      if (!leave("final.xyz", extended_xyz(simulation_->system()), result)) return std::nullopt;
    }
    return result;
  }

 private:
  // A file beside the result, which lists it. False: there is no room, and nobody wants to wait for it.
  bool leave(const std::string& name, const std::string& bytes, Json& result) const {
    while (true) {
      try {
        write_durably(job_.files + name, bytes);
        break;
      } catch (const NoRoomError& error) {
        if (!events_.wait_for_room(error)) return false;
      }
    }
    result["files"].push_back({{"name", name}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}});
    return true;
  }

  void construct() {
    const std::size_t useful = std::max<std::size_t>(1, scene_.particles.count / fewest_particles_per_thread);
    const int allowed = std::min(job_.threads, omp_get_num_procs());
    const int threads = static_cast<int>(std::min(useful, static_cast<std::size_t>(allowed)));
    simulation_ = std::make_unique<Simulation>(scene_, schedule_, job_.header.seed, threads, job_.scene_name);
  }

  void begin() {
    construct();
    if (!job_.checkpoint.empty() && !kind_of(job_.checkpoint).empty() && resume()) {
      return;
    }
    events_.progress({"packing", 0, schedule_.total(), 0});
    simulation_->start();
  }

  bool resume() {
    try {
      meter_.add(read_checkpoint(job_.checkpoint, identity_, *simulation_));
      return true;
    } catch (const CheckpointError& error) {
      if (!job_.restart_on_bad_checkpoint) {
        throw;
      }
      // Results depend on scene, seed and binary alone, so starting again only costs time.
      events_.remark(std::string(error.what()) + ": set aside, the realisation starts again");
      std::filesystem::rename(job_.checkpoint, free_name(job_.checkpoint.string() + ".rejected"));
      construct();
      return false;
    }
  }

  // Until the end, or until a drain is requested.
  std::optional<Ending> loop() {
    // Some 65 000 particle-steps are about ten milliseconds.
    const std::uint64_t stride = std::max<std::uint64_t>(1, 65536 / scene_.particles.count);
    Clock::time_point next_checkpoint =
        Clock::now() +
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(job_.checkpoint_seconds));
    while (true) {
      if (std::optional<Ending> ending = simulation_->advance(stride)) {
        return ending;
      }
      events_.progress(progress_of(*simulation_));
      if (job_.checkpoint.empty()) {
        continue;
      }
      if (events_.drain_requested()) {
        return std::nullopt;
      }
      if (Clock::now() > next_checkpoint) next_checkpoint = Clock::now() + checkpoint_on_the_way();
    }
  }

  // Returns when the next one is due. Want of room is no reason to give up work that is in memory.
  Clock::duration checkpoint_on_the_way() {
    const std::chrono::duration<double> interval(job_.checkpoint_seconds);
    try {
      write_checkpoint(job_.checkpoint, identity_, meter_.spent(), *simulation_);
      return std::chrono::duration_cast<Clock::duration>(interval);
    } catch (const NoRoomError& error) {
      events_.skipped(error);
      return std::chrono::duration_cast<Clock::duration>(std::min(interval, when_full));
    }
  }

  // False: there is no room, and nobody wants to wait for it.
  bool save(const std::filesystem::path& path) const {
    for (;;) {
      try {
        write_checkpoint(path, identity_, meter_.spent(), *simulation_);
        return true;
      } catch (const NoRoomError& error) {
        if (!events_.wait_for_room(error)) return false;
      }
    }
  }

  // A realisation that broke off leaves its last state where people can look at it: `name` in the folder of
  // failures. False: there was no room.
  bool save_state(const Ending& ending, std::string& name) const {
    if (ending.cause == Ending::Cause::completed || job_.failures.empty()) return true;
    name = job_.header.point.substr(0, 12) + "-" + std::to_string(job_.header.seed) + ".state";
    return save(job_.failures / name);
  }

  const JobSpecification& job_;
  const JobEvents& events_;
  Meter meter_;
  Scene scene_;
  Schedule schedule_;
  CheckpointIdentity identity_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

std::optional<Json> run_job(const JobSpecification& job, const JobEvents& events) {
  return Job(job, events).run();
}

}  // namespace peclet::engine
