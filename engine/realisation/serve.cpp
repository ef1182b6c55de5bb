// The engine as a worker: receives jobs and reports results over a socket.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/documents.h"
#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/frames.h"
#include "contract/key_table.h"
#include "contract/sha256.h"
#include "engine/integrators/derived_groups.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/job.h"
#include "engine/realisation/placed_spheres.h"
#include "engine/realisation/result.h"
#include "engine/realisation/schedule.h"

namespace peclet::engine {
namespace {

using Clock = std::chrono::steady_clock;

// Interval at which a running job reads the socket.
constexpr std::chrono::milliseconds attention{100};

// Delay before a file that did not fit onto the disk is tried again, and the number of tries before exiting.
constexpr std::chrono::seconds until_next_try{1};
constexpr int last_tries = 5;

// Writes a line to standard error; errors are ignored, because a log must not end a job.
void log_line(const std::string& text) {
  std::fputs((text + "\n").c_str(), stderr);
  std::fflush(stderr);
}

class Worker {
 public:
  explicit Worker(int descriptor) : channel_(descriptor) {}

  int run() {
    channel_.send({{"type", "hello"},
                   {"protocol", 1},
                   {"program", "peclet-engine"},
                   {"engine", engine_identity()},
                   {"ahead", true},
                   {"scene_schema", scene_keys().json_schema("scene.schema.json")},
                   {"derived", names_of_groups()}});
    Json message;
    while (!leave_) {
      if (waiting_job_) {
        message = *std::exchange(waiting_job_, std::nullopt);
      } else if (channel_.receive(message, std::chrono::milliseconds(-1)) == FrameChannel::Status::closed) {
        return 0;
      }
      handle(message);
    }
    return 0;
  }

 private:
  // Sends a message. A lost peer is not an error: results are in files, a running job writes a checkpoint.
  void tell(const Json& message) {
    if (abandoned_) return;
    try {
      channel_.send(message);
    } catch (const std::system_error&) {
      abandoned_ = true;
    }
  }

  void handle(Json given) {
    const Json message = checked_frame(std::move(given));
    const auto type = message["type"].get<std::string>();
    if (type == "validate") {
      validate(message);
    } else if (type == "job") {
      run(message);
    } else if (type == "drain" || type == "stop") {
      leave_ = true;  // nothing is running
    } else {
      throw FrameError("a message of type \"" + type + "\" is not for an engine");
    }
  }

  void validate(const Json& message) {
    Json answer = {{"request", message["request"]}};
    try {
      const Scene scene = read_scene(message["scene"], "scene");
      const Schedule schedule = make_schedule(scene, "scene");
      check_fit(scene, schedule, "scene");
      if (scene.start) check_start_of_campaign(scene, "scene", message["seeds"].get<std::int64_t>());
      answer["type"] = "validated";
      answer["timestep"] = schedule.timestep;
      answer["steps"] = schedule.total();
      answer["particles"] = scene.particles.count;
      answer["derived"] = to_json(derived_groups(scene));
      answer["observables"] = names_of_targets(scene, schedule);
      answer["hints"] = target_hints(scene);
      answer["warnings"] = Json::array();
      for (const std::vector<Warning>& warnings : {scene_warnings(scene), warnings_before_run(scene)}) {
        for (const Warning& warning : warnings) answer["warnings"].push_back(warning);
      }
    } catch (const InputError& error) {
      answer["type"] = "refused";
      answer["pointer"] = error.pointer();
      answer["value"] = error.value();
      answer["allowed"] = error.allowed();
    }
    tell(answer);
  }

  void run(const Json& message) {
    const Json& id = message["job"];
    JobSpecification job;
    job.header = {message["point"].get<std::string>(), message["seed"].get<std::uint64_t>()};
    job.scene = message["scene"];
    job.scene_name = "scene";
    job.threads = message["threads"].get<int>();
    job.checkpoint = message["checkpoint"].get<std::string>();
    job.checkpoint_seconds = message["checkpoint_seconds"].get<double>();
    job.files = message["files"].get<std::string>();
    job.failures = message["failures"].get<std::string>();
    job.restart_on_bad_checkpoint = true;
    told_to_leave_ = false;
    tries_left_ = last_tries;
    try {
      const std::optional<Json> result = run_job(job, events(id, message["progress_seconds"].get<double>()));
      if (result && deliver(id, *result, message["spool"].get<std::string>())) {
        leave_ = told_to_leave_;  // the runner repeats it only after "drained"
      } else {
        tell({{"type", "drained"}, {"job", id}, {"step", last_step_}});
      }
    } catch (const std::exception& error) {
      log_line(error.what());
      tell({{"type", "failed"}, {"job", id}, {"message", error.what()}});
      leave_ = told_to_leave_;
    }
    leave_ = leave_ || abandoned_;
  }

  // Writes and reports the result. Returns false if the disk was full until the engine had to leave.
  bool deliver(const Json& id, const Json& result, const std::string& spool) {
    const std::string text = result_text(result);
    for (;;) {
      try {
        write_durably(spool, text);
        break;
      } catch (const NoRoomError& error) {
        if (!wait_for_room(id, error)) return false;
      }
    }
    tell({{"type", "result"}, {"job", id}, {"spool", spool}, {"sha256", sha256(text)}});
    return true;
  }

  void say_no_room(const Json& id, const NoRoomError& error) {
    tell({{"type", "no-room"}, {"job", id}, {"path", error.path().string()}, {"bytes", error.bytes()}});
  }

  // Waits before the next try to write. Returns false after `last_tries` if the engine is to leave; otherwise
  // the work stays in memory for as long as the disk is full.
  bool wait_for_room(const Json& id, const NoRoomError& error) {
    if (told_to_leave_ || abandoned_) {
      if (tries_left_-- == 0) {
        log_line(error.what());
        return false;
      }
      std::this_thread::sleep_for(until_next_try);
      return true;
    }
    say_no_room(id, error);
    hear(until_next_try);
    return true;
  }

  JobEvents events(const Json& id, double progress_seconds) {
    JobEvents events;
    events.drain_requested = [this] { return drain_requested(); };
    events.remark = log_line;
    events.skipped = [this, id](const NoRoomError& error) { say_no_room(id, error); };
    events.wait_for_room = [this, id](const NoRoomError& error) { return wait_for_room(id, error); };
    events.progress = [this, id, progress_seconds](const Progress& progress) {
      last_step_ = progress.phase == std::string_view("packing") ? 0 : progress.step;
      const Clock::time_point now = Clock::now();
      if (std::chrono::duration<double>(now - last_progress_).count() < progress_seconds) return;
      last_progress_ = now;
      tell({{"type", "progress"},
            {"job", id},
            {"phase", progress.phase},
            {"step", progress.step},
            {"steps", progress.steps},
            {"strain", progress.strain}});
    };
    return events;
  }

  // Returns true if the job shall end. Called at every turn of the time loop; reads the socket at intervals.
  bool drain_requested() {
    const Clock::time_point now = Clock::now();
    if (now - last_look_ < attention) return told_to_leave_ || abandoned_;
    last_look_ = now;
    hear(std::chrono::milliseconds(0));
    return told_to_leave_ || abandoned_;
  }

  // Handles a message of the runner during a job. Throws FrameError for a message that is not allowed then.
  void hear(std::chrono::milliseconds patience) {
    Json message;
    switch (channel_.receive(message, patience)) {
      case FrameChannel::Status::nothing:
        return;
      case FrameChannel::Status::closed:
        abandoned_ = true;  // the runner is gone: write a checkpoint
        return;
      case FrameChannel::Status::message:
        break;
    }
    const auto type = message.at("type").get<std::string>();
    if (type == "stop") std::exit(0);
    if (type == "job" && !waiting_job_ && !told_to_leave_) {
      waiting_job_ = message;
      hear(std::chrono::milliseconds(0));  // a drain may follow
      return;
    }
    if (type != "drain") {
      throw FrameError("a message of type \"" + type + "\" while a job is running" +
                       (waiting_job_ ? " and another one waits" : ""));
    }
    told_to_leave_ = true;
    waiting_job_.reset();  // the runner gives it to another worker
  }

  FrameChannel channel_;
  std::optional<Json> waiting_job_;  // received while another job was running
  bool leave_ = false;
  bool abandoned_ = false;
  bool told_to_leave_ = false;  // by a drain during the present job
  int tries_left_ = 0;          // tries to write a file before leaving
  std::uint64_t last_step_ = 0;
  Clock::time_point last_progress_{}, last_look_{};
};

}  // namespace

int serve(int descriptor) { return Worker(descriptor).run(); }

}  // namespace peclet::engine
