#include "engine/serve.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "contract/input_error.h"
#include "contract/key_table.h"
#include "contract/sha256.h"
#include "engine/job.h"

namespace peclet::engine {
namespace {

using Clock = std::chrono::steady_clock;

// How often a running job looks at the socket.
constexpr std::chrono::milliseconds attention{100};

void log_line(const std::string& text) {
  fmt::print(stderr, "{}\n", text);
  std::fflush(stderr);
}

class Worker {
 public:
  explicit Worker(int descriptor) : channel_(descriptor) {}

  int run() {
    channel_.send(
        {{"type", "hello"}, {"protocol", 1}, {"program", "peclet-engine"}, {"engine", engine_identity()}});
    Json message;
    while (!leave_) {
      if (channel_.receive(message, std::chrono::milliseconds(-1)) == FrameChannel::Status::closed) {
        return 0;
      }
      try {
        handle(message);
      } catch (const Json::exception& error) {
        throw FrameError(fmt::format("the message {} is incomplete: {}", shortened(message), error.what()));
      }
    }
    return 0;
  }

 private:
  // A peer that is gone is no error: what is finished lies in the spool, what is not goes to a checkpoint.
  void tell(const Json& message) {
    if (abandoned_) {
      return;
    }
    try {
      channel_.send(message);
    } catch (const std::system_error&) {
      abandoned_ = true;
    }
  }

  void handle(const Json& message) {
    const auto type = message.at("type").get<std::string>();
    if (type == "validate") {
      validate(message);
    } else if (type == "job") {
      run(message);
    } else if (type == "drain" || type == "stop") {
      leave_ = true;  // nothing is running
    } else {
      throw FrameError("a message of type \"" + type + "\" is none that this engine knows");
    }
  }

  void validate(const Json& message) {
    Json answer = {{"request", message.at("request")}};
    try {
      const Scene scene = read_scene(message.at("scene"), "scene");
      const Schedule schedule = make_schedule(scene, "scene");
      const Simulation check_of_the_box(scene, schedule, 0, 1, "scene");
      answer["type"] = "validated";
      answer["timestep"] = schedule.timestep;
      answer["steps"] = schedule.total();
      answer["particles"] = scene.particles.count;
      answer["derived"] = to_json(derived_groups(scene));
      answer["warnings"] = Json::array();
      for (const Warning& warning : scene_warnings(scene)) {
        answer["warnings"].push_back({{"code", warning.code}, {"message", warning.message}});
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
    const Json& id = message.at("job");
    JobSpecification job;
    job.header = {message.at("point").get<std::string>(), message.at("seed").get<std::uint64_t>()};
    job.scene = message.at("scene");
    job.scene_name = "scene";
    job.threads = message.value("threads", 1);
    job.checkpoint = message.at("checkpoint").get<std::string>();
    job.checkpoint_seconds = message.value("checkpoint_seconds", job.checkpoint_seconds);
    job.failures = message.value("failures", "");
    job.restart_on_bad_checkpoint = true;
    try {
      if (const std::optional<Json> result =
              run_job(job, events(id, message.value("progress_seconds", 1.0)))) {
        const std::string text = result->dump(1) + "\n";
        const auto spool = message.at("spool").get<std::string>();
        write_durably(spool, text);
        tell({{"type", "result"}, {"job", id}, {"spool", spool}, {"sha256", sha256(text)}});
      } else {
        tell({{"type", "drained"}, {"job", id}, {"step", last_step_}});
      }
    } catch (const std::exception& error) {
      log_line(error.what());
      tell({{"type", "failed"}, {"job", id}, {"message", error.what()}});
    }
    leave_ = leave_ || abandoned_;
  }

  JobEvents events(const Json& id, double progress_seconds) {
    JobEvents events;
    events.drain_requested = [this] { return drain_requested(); };
    events.remark = log_line;
    events.progress = [this, id, progress_seconds](const Progress& progress) {
      last_step_ = progress.step;
      const Clock::time_point now = Clock::now();
      if (std::chrono::duration<double>(now - last_progress_).count() < progress_seconds) {
        return;
      }
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

  // Asked at every turn of the time loop; looks at the socket only now and then.
  bool drain_requested() {
    const Clock::time_point now = Clock::now();
    if (now - last_look_ < attention) {
      return abandoned_;
    }
    last_look_ = now;
    Json message;
    switch (channel_.receive(message, std::chrono::milliseconds(0))) {
      case FrameChannel::Status::nothing:
        return false;
      case FrameChannel::Status::closed:
        abandoned_ = true;
        return true;  // the owner is gone: keep the work
      case FrameChannel::Status::message:
        break;
    }
    const auto type = message.at("type").get<std::string>();
    if (type == "stop") {
      std::exit(0);
    }
    if (type != "drain") {
      throw FrameError("a message of type \"" + type + "\" while a job is running");
    }
    return true;
  }

  FrameChannel channel_;
  bool leave_ = false;
  bool abandoned_ = false;
  std::uint64_t last_step_ = 0;
  Clock::time_point last_progress_{}, last_look_{};
};

}  // namespace

int serve(int descriptor) { return Worker(descriptor).run(); }

}  // namespace peclet::engine
