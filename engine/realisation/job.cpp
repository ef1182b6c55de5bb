#include "engine/realisation/job.h"

#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/key_table.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/growing_file.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/placed_spheres.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

// With fewer particles per thread, threads lose more by waiting than they gain; results do not change.
constexpr std::size_t fewest_particles_per_thread = 4000;

// Delay before a checkpoint that did not fit onto the disk is tried again [s].
constexpr std::chrono::duration<double> when_full{5};

// Time after which frames of a realisation whose steps are made elsewhere are moved from memory to their
// file.
constexpr std::chrono::seconds between_looks_at_frames{10};

// Time spent on the realisation, in this process and in earlier ones. With one thread this is the time of the
// thread that runs the job, because other threads may run other jobs.
class Meter {
 public:
  explicit Meter(int threads)
      : clock_(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID),
        processor_(processor_seconds()),
        start_(Clock::now()) {}

  Spent spent() const {
    return {before_.processor_seconds + processor_seconds() - processor_,
            before_.wall_seconds + std::chrono::duration<double>(Clock::now() - start_).count()};
  }
  void start_after(const Spent& earlier) { before_ = earlier; }
  void add(double seconds) { before_.processor_seconds += seconds; }

 private:
  double processor_seconds() const {
    timespec now{};
    clock_gettime(clock_, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  clockid_t clock_;
  Spent before_;
  double processor_;
  Clock::time_point start_;
};

// Returns the program that makes the steps of a job, as its checkpoints name it.
std::string program_of(const ResultHeader& header) {
  const auto binary = provenance().at("binary_sha256").get<std::string>();
  return header.in_ensemble ? binary + ' ' + header.ensemble : binary;
}

class Job {
 public:
  Job(const JobSpecification& job, const JobEvents& events, const StepsElsewhere& elsewhere)
      : job_(job),
        events_(events),
        elsewhere_(elsewhere),
        meter_(job.threads),
        scene_(read_scene(job.scene, job.scene_name)),
        schedule_(make_schedule(scene_, job.scene_name)),
        identity_{sha256(canonical_json(scene_.document)), job.header.seed, program_of(job.header),
                  motion_of(scene_, schedule_)} {
    if (!job.extended.empty()) plan_extension();
  }

  std::optional<Json> run() {
    if (job_.files.empty()) {
      if (scene_.final_configuration || scene_.final_checkpoint) refuse_files("/files", "must be left out");
      if (scene_.observables.contains("trajectory")) refuse_files("/observables", "must not list trajectory");
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
        events_.remark("no room for a checkpoint: the work since the last one is lost");
      return std::nullopt;
    }
    std::string state;
    if (!save_state(*ending, state)) return std::nullopt;
    Json result = make_result(job_.header, scene_, *simulation_, *ending, state, meter_.spent());
    if (scene_.final_configuration && is_measured(ending->cause)) {
      const auto write = [&](const fs::path& path) {
        write_durably(path, extended_xyz(simulation_->system()));
      };
      if (!leave("final.xyz", write, result)) return std::nullopt;
    }
    if (scene_.final_checkpoint && ending->cause == Ending::Cause::completed) {
      const auto write = [&](const fs::path& path) {
        write_checkpoint(path, identity_, meter_.spent(), *simulation_);
      };
      if (!leave("final.checkpoint", write, result)) return std::nullopt;
    }
    if (frames_file_) {
      const auto write = [&](const fs::path& path) {
        frames_file_->take(*simulation_->frames());
        frames_file_->finish(*simulation_->frames(), path);
      };
      if (!leave("trajectory.gsd", write, result)) return std::nullopt;
    }
    return result;
  }

 private:
  [[noreturn]] void refuse_files(const char* pointer, const char* rule) const {
    throw InputError(
        job_.scene_name, pointer, shortened(scene_.document.at(Json::json_pointer(pointer))),
        std::string(rule) +
            ", because there is no place for files: `peclet-engine run` puts them beside --output, "
            "which must name a file");
  }

  // Repeats write() while the disk is full and the caller waits for room. Returns false if it does not wait;
  // throws NoRoomError then if the job has no checkpoint to resume from.
  template <class Write>
  bool write_patiently(const Write& write) const {
    while (true) {
      try {
        write();
        return true;
      } catch (const NoRoomError& error) {
        if (events_.wait_for_room(error)) continue;
        if (job_.checkpoint.empty()) throw;
        return false;
      }
    }
  }

  // Writes a file beside the result and lists it in the result. Returns false as write_patiently().
  template <class Write>
  bool leave(const std::string& name, const Write& write, Json& result) const {
    const fs::path path = job_.files + name;
    if (!write_patiently([&] { write(path); })) return false;
    result["files"].push_back(
        {{"name", name}, {"bytes", fs::file_size(path)}, {"sha256", sha256_of_file(path)}});
    return true;
  }

  void construct() {
    const std::size_t useful = std::max<std::size_t>(1, scene_.particles.count / fewest_particles_per_thread);
    const int allowed = std::min(job_.threads, omp_get_num_procs());
    const int threads = static_cast<int>(std::min(useful, static_cast<std::size_t>(allowed)));
    simulation_ = std::make_unique<Simulation>(scene_, schedule_, job_.header.seed, threads, job_.scene_name);
  }

  // Opens the file for frames, if the scene has a trajectory, and checks the frames written so far.
  void open_frames_file() {
    const gsd::Frames* const frames = simulation_->frames();
    if (frames == nullptr) return;
    frames_file_.reset();
    if (job_.checkpoint.empty()) {
      frames_file_.emplace(fmt::format("{}trajectory.gsd.{}.tmp", job_.files, ::getpid()),
                           /*has_name=*/false);
    } else {
      frames_file_.emplace(job_.checkpoint.string() + "@growing");
    }
    frames_file_->go_on(*frames);
  }

  void begin() {
    construct();
    if (!job_.checkpoint.empty() && !kind_of(job_.checkpoint).empty() && resume()) return;
    open_frames_file();
    if (!job_.extended.empty()) {
      extend_checkpoint(job_.extended, identity_, *simulation_);
      return;
    }
    std::uint64_t made = 0;
    events_.progress({"packing", made, 0, 0});
    if (scene_.start) {
      const PlacedSpheres placed = placed_spheres(scene_, job_.header.seed, job_.scene_name);
      simulation_->start(placed.system, placed.in_motion);
    } else {
      simulation_->start([&] { events_.progress({"packing", ++made, 0, 0}); });
    }
  }

  // Moves the beginning of the window to the extended checkpoint, if that is later. The identity then
  // includes this step, so that checkpoints of the scene's own window do not match.
  void plan_extension() {
    const auto progressed = [&] {
      try {
        return read_progress(job_.extended, identity_, scene_.particles.count);
      } catch (const CheckpointError& error) {
        throw InputError("--extend", "", "", error.what());
      }
    }();
    const std::uint64_t total = schedule_.total();
    if (progressed.step + count_of_blocks > total) {
      throw InputError(
          job_.scene_name, "/duration", fmt::format("{} steps", total),
          fmt::format("must be {} steps at least: {} that the checkpoint has made, and one for each "
                      "block of the window",
                      progressed.step + count_of_blocks, progressed.step));
    }
    if (progressed.step > schedule_.equilibration) {
      refuse_part_of_cycle(progressed.step);
      schedule_.equilibration = progressed.step;
      schedule_.production = total - progressed.step;
      identity_.scene_sha256 += fmt::format(" from step {}", progressed.step);
    }
    meter_.start_after(progressed.spent);
  }

  // Throws InputError if moduli, which are means over whole cycles, would begin within a cycle.
  void refuse_part_of_cycle(std::uint64_t step) const {
    const std::optional<double> period = scene_.physics.flow.period();
    if (!period || !scene_.observables.contains("oscillation")) return;
    const auto of_cycle = static_cast<std::uint64_t>(std::llround(*period / schedule_.timestep));
    if (step % of_cycle == 0) return;
    throw InputError(
        "--extend", "", "",
        fmt::format("{}: stands within a cycle, after {} of its {} steps; must be a checkpoint of "
                    "whole cycles, such as final.checkpoint",
                    job_.extended.string(), step % of_cycle, of_cycle));
  }

  // Resumes from the job's checkpoint. Returns false if that was unusable and has been set aside.
  bool resume() {
    try {
      const Spent spent = read_checkpoint(job_.checkpoint, identity_, *simulation_);
      open_frames_file();
      meter_.start_after(spent);
      return true;
    } catch (const CheckpointError& error) {
      if (!job_.restart_on_bad_checkpoint) throw;
      // Results depend on scene, seed and binary alone, so starting again only costs time.
      events_.remark(std::string(error.what()) + ": set aside, the realisation starts again");
      fs::rename(job_.checkpoint, free_name(job_.checkpoint.string() + ".rejected"));
      construct();
      return false;
    }
  }

  // Makes steps until the realisation ends. Returns nothing if the job was drained before.
  std::optional<Ending> loop() {
    Clock::time_point next_checkpoint =
        Clock::now() +
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(job_.checkpoint_seconds));
    while (true) {
      const std::optional<Ending> ending = make_steps(next_checkpoint);
      meter_.add(simulation_->take_seconds());
      if (ending) return ending;
      const System& system = simulation_->system();
      events_.progress(progress_of(*simulation_, system.step, system.box.net_strain()));
      if (!relieve_memory()) return std::nullopt;
      if (job_.checkpoint.empty()) continue;
      if (events_.drain_requested()) return std::nullopt;
      if (Clock::now() > next_checkpoint) next_checkpoint = Clock::now() + checkpoint_on_the_way();
    }
  }

  // Makes some of the steps, elsewhere at most until the next checkpoint; returns the ending as advance().
  std::optional<Ending> make_steps(Clock::time_point next_checkpoint) {
    if (!elsewhere_) {
      // 65536 particle-steps take about ten milliseconds.
      return simulation_->advance(std::max<std::uint64_t>(1, 65536 / scene_.particles.count));
    }
    Clock::time_point until = job_.checkpoint.empty() ? Clock::time_point::max() : next_checkpoint;
    if (frames_file_) until = std::min(until, Clock::now() + between_looks_at_frames);
    double spent = 0;
    std::optional<Ending> ending = elsewhere_(*simulation_, until, spent);
    meter_.add(spent);
    return ending;
  }

  // Writes frames to their file if they take much memory. Returns false as write_patiently().
  bool relieve_memory() {
    constexpr std::size_t many = std::size_t{8} << 20;
    if (!frames_file_ || simulation_->frames()->pending().size() < many) return true;
    return write_patiently([this] { frames_file_->take(*simulation_->frames()); });
  }

  // Writes a checkpoint, after the frames that it knows of are on disk.
  void put_checkpoint(const fs::path& path) {
    if (frames_file_) {
      frames_file_->take(*simulation_->frames());
      frames_file_->synchronise();
    }
    write_checkpoint(path, identity_, meter_.spent(), *simulation_);
  }

  // Writes a checkpoint, and returns the time until the next one. If the disk is full the job continues.
  Clock::duration checkpoint_on_the_way() {
    const std::chrono::duration<double> interval(job_.checkpoint_seconds);
    try {
      put_checkpoint(job_.checkpoint);
      return std::chrono::duration_cast<Clock::duration>(interval);
    } catch (const NoRoomError& error) {
      events_.skipped(error);
      return std::chrono::duration_cast<Clock::duration>(std::min(interval, when_full));
    }
  }

  // Returns false as write_patiently().
  bool save(const fs::path& path) {
    return write_patiently([&] { put_checkpoint(path); });
  }

  // Saves the last state of a realisation that broke off as `name`. Returns false as write_patiently().
  bool save_state(const Ending& ending, std::string& name) {
    if (is_measured(ending.cause) || job_.failures.empty()) return true;
    name = job_.header.point.substr(0, 12) + "-" + std::to_string(job_.header.seed) + ".state";
    return save(job_.failures / name);
  }

  const JobSpecification& job_;
  const JobEvents& events_;
  const StepsElsewhere& elsewhere_;
  Meter meter_;
  Scene scene_;
  Schedule schedule_;
  CheckpointIdentity identity_;
  std::unique_ptr<Simulation> simulation_;
  std::optional<GrowingFile> frames_file_;  // if the scene has a trajectory
};

}  // namespace

std::optional<Json> run_job(const JobSpecification& job, const JobEvents& events,
                            const StepsElsewhere& elsewhere) {
  return Job(job, events, elsewhere).run();
}

Progress progress_of(const Simulation& simulation, std::uint64_t step, double strain) {
  return {step < simulation.schedule().equilibration ? "equilibration" : "production", step,
          simulation.schedule().total(), strain};
}

}  // namespace peclet::engine
