#include "engine/realisation/serve.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
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
#include "engine/realisation/crew.h"
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
  Worker(int descriptor, Ensemble* ensemble, Device device)
      : channel_(descriptor), ensemble_(ensemble), device_(device) {}

  int run() {
    Json hello = {{"type", "hello"},
                  {"protocol", 1},
                  {"program", "peclet-engine"},
                  {"engine", ensemble_ == nullptr ? engine_identity() : engine_identity(ensemble_->name())},
                  {"ahead", ensemble_ == nullptr},
                  {"scene_schema", scene_keys().json_schema("scene.schema.json")},
                  {"derived", names_of_groups()}};
    if (ensemble_ != nullptr) hello["capacity"] = ensemble_->jobs();
    channel_.send(hello);
    return ensemble_ != nullptr ? run_many() : run_one_by_one();
  }

 private:
  // A job that has been given.
  struct Given {
    Json id;
    std::string spool;
    double progress_seconds;
    Clock::time_point last_progress;
    std::uint64_t last_step = 0;
    int tries_left = last_tries;  // tries to write a file before leaving
  };

  int run_one_by_one() {
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

  int run_many() {
    Crew crew(*ensemble_, device_);
    crew_ = &crew;
    try {
      take_turns();
    } catch (...) {
      told_to_leave_ = true;  // the jobs write checkpoints and end before the crew is gone
      throw;
    }
    return 0;
  }

  // Takes turns with the crew until it is time to leave and all jobs have ended.
  void take_turns() {
    while (true) {
      const bool is_idle = crew_->active() == 0;
      if (is_idle && is_leaving()) return;
      hear_all(is_idle ? std::chrono::milliseconds(-1) : std::chrono::milliseconds(0));
      if (is_leaving()) crew_->drain();
      if (crew_->active() > 0) crew_->turn();
    }
  }

  // Handles all messages that have arrived, after `patience` for the first one.
  void hear_all(std::chrono::milliseconds patience) {
    for (Json message;; patience = std::chrono::milliseconds(0)) {
      switch (channel_.receive(message, patience)) {
        case FrameChannel::Status::nothing:
          return;
        case FrameChannel::Status::closed:
          abandoned_ = true;  // the runner is gone: write checkpoints
          return;
        case FrameChannel::Status::message:
          break;
      }
      if (message.at("type") == "drain") {
        told_to_leave_ = true;
      } else if (message.at("type") == "stop") {
        ::_exit(0);  // other threads still use what exit() would destroy
      } else {
        handle(message);
      }
    }
  }

  bool is_leaving() const { return told_to_leave_ || abandoned_; }

  // Sends a message. A lost peer is not an error: results are in files, a running job writes a checkpoint.
  void tell(const Json& message) {
    const std::lock_guard lock(sending_);
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
    } else if (type == "job" && crew_ != nullptr) {
      begin(message);
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
      if (ensemble_ != nullptr && device_ != Device::automatic) {
        if (const std::optional<InputError> refusal = ensemble_->refusal(scene, "scene")) throw *refusal;
      }
      answer["type"] = "validated";
      answer["timestep"] = schedule.timestep;
      answer["timestep_limit"] = schedule.timestep_limit;
      answer["steps"] = schedule.total();
      answer["particles"] = scene.particles.count;
      answer["derived"] = to_json(derived_groups(scene));
      answer["observables"] = names_of_targets(scene, schedule);
      answer["hints"] = target_hints(scene);
      answer["warnings"] = Json::array();
      for (const std::vector<Warning>& warnings :
           {scene_warnings(scene), warnings_before_run(scene), schedule_warnings(scene, schedule)}) {
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
    told_to_leave_ = false;
    Given given = given_by(message, last_progress_);
    if (work(message, given)) leave_ = told_to_leave_;  // the runner repeats it only after "drained"
    last_progress_ = given.last_progress;
    leave_ = leave_ || abandoned_;
  }

  // Lets the crew do a job, unless it has as many as it may have.
  void begin(const Json& message) {
    if (jobs_of_crew_ >= ensemble_->jobs()) {
      const char* const reason = "is a job more than the engine may have";
      log_line(reason);
      tell({{"type", "failed"}, {"job", message["job"]}, {"message", reason}});
      return;
    }
    ++jobs_of_crew_;
    crew_->begin([this, message] {
      Given given = given_by(message, {});
      work(message, given);
    });
  }

  static Given given_by(const Json& message, Clock::time_point last_progress) {
    return {message["job"], message["spool"].get<std::string>(), message["progress_seconds"].get<double>(),
            last_progress};
  }

  // Sends the last message about a job.
  void answer(const Json& message) {
    if (crew_ != nullptr) --jobs_of_crew_;
    tell(message);
  }

  // Does a job and answers. Returns false if it was drained.
  bool work(const Json& message, Given& given) {
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
    try {
      const JobEvents events = events_of(given);
      const std::optional<Json> result = crew_ != nullptr ? crew_->run(job, events) : run_job(job, events);
      if (result && deliver(given, *result)) return true;
      answer({{"type", "drained"}, {"job", given.id}, {"step", given.last_step}});
      return false;
    } catch (const std::exception& error) {
      log_line(error.what());
      answer({{"type", "failed"}, {"job", given.id}, {"message", error.what()}});
      return true;
    }
  }

  // Writes and reports the result. Returns false if the disk was full until the engine had to leave.
  bool deliver(Given& given, const Json& result) {
    const std::string text = result_text(result);
    for (;;) {
      try {
        write_durably(given.spool, text);
        break;
      } catch (const NoRoomError& error) {
        if (!wait_for_room(given, error)) return false;
      }
    }
    answer({{"type", "result"}, {"job", given.id}, {"spool", given.spool}, {"sha256", sha256(text)}});
    return true;
  }

  void say_no_room(const Given& given, const NoRoomError& error) {
    tell({{"type", "no-room"}, {"job", given.id}, {"path", error.path().string()}, {"bytes", error.bytes()}});
  }

  // Waits before the next try to write. Returns false after `last_tries` if the engine is to leave; otherwise
  // the work stays in memory for as long as the disk is full.
  bool wait_for_room(Given& given, const NoRoomError& error) {
    if (is_leaving()) {
      if (given.tries_left-- == 0) {
        log_line(error.what());
        return false;
      }
      std::this_thread::sleep_for(until_next_try);
      return true;
    }
    say_no_room(given, error);
    if (crew_ != nullptr) {
      std::this_thread::sleep_for(until_next_try);
    } else {
      hear(until_next_try);
    }
    return true;
  }

  JobEvents events_of(Given& given) {
    JobEvents events;
    events.drain_requested = [this] { return drain_requested(); };
    events.remark = log_line;
    events.skipped = [this, &given](const NoRoomError& error) { say_no_room(given, error); };
    events.wait_for_room = [this, &given](const NoRoomError& error) { return wait_for_room(given, error); };
    events.progress = [this, &given](const Progress& progress) {
      given.last_step = progress.phase == std::string_view("packing") ? 0 : progress.step;
      const Clock::time_point now = Clock::now();
      if (std::chrono::duration<double>(now - given.last_progress).count() < given.progress_seconds) return;
      given.last_progress = now;
      tell({{"type", "progress"},
            {"job", given.id},
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
    if (crew_ != nullptr || now - last_look_ < attention) return is_leaving();
    last_look_ = now;
    hear(std::chrono::milliseconds(0));
    return is_leaving();
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
  std::mutex sending_;
  Ensemble* const ensemble_;
  const Device device_;
  std::optional<Json> waiting_job_;  // received while another job was running
  bool leave_ = false;
  std::atomic<bool> abandoned_ = false;
  std::atomic<bool> told_to_leave_ = false;    // by a drain during the present job, or the jobs of the crew
  std::atomic<std::size_t> jobs_of_crew_ = 0;  // not answered
  Clock::time_point last_progress_{}, last_look_{};
  Crew* crew_ = nullptr;  // if there is an ensemble
};

}  // namespace

int serve(int descriptor, Ensemble* ensemble, Device device) {
  return Worker(descriptor, ensemble, device).run();
}

}  // namespace peclet::engine
