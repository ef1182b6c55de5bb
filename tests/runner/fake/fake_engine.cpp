// Fake engine without physics that speaks the frames: the runner knows no engine from inside.
//
// A realisation is a chain of mixed 64-bit states, started by point and seed. Its relative viscosity is a
// normal variate of the last state. It depends on every step, so a resume at the wrong place would show.
//
//   PECLET_FAKE_STEPS (10), PECLET_FAKE_STEP_MS (0)     length of a realisation
//   PECLET_FAKE_MEAN (10), PECLET_FAKE_DEVIATION (1)    mean and deviation of the relative viscosity
//   PECLET_FAKE_PADDING (0)                             numbers that make its result longer
//   PECLET_FAKE_TIMES                                   a file that gets a line a job, in nanoseconds of the
//                                                       monotonic clock: when the job was taken up, and when
//                                                       its result was durable and announced
//   PECLET_FAKE_FILES (0)                               number of files state-0.txt ... beside its result
//   PECLET_FAKE_PRINTED (0)                             bytes that it prints at every step
//   PECLET_FAKE_IDENTITY ("fake")                       text whose hash is given as that of its binary
//   PECLET_FAKE_DRIFT                                   if set, results differ from those without it
//   PECLET_FAKE_AHEAD                                   if set, it takes a job ahead
//   PECLET_FAKE_STEPLESS                                if set, it says that it has no time step
//   PECLET_FAKE_HOLD, PECLET_FAKE_HOLD_SEED (0)         a file: while it exists, this and later seeds stop at
//                                                       half of their steps, but hear the owner
//   PECLET_FAKE_FAULTS, PECLET_FAKE_CRASH_PROBABILITY   see fake_faults.h
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "contract/sha256.h"
#include "tests/runner/fake/fake_faults.h"
#include "tests/runner/fake/fake_result.h"

namespace peclet::fake {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::string text_setting(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

class Engine {
 public:
  int run() {
    say_hello();
    Json message;
    while (!leave_ && next(message)) {
      const std::string type = message.at("type");
      if (type == "validate") validate(message);
      if (type == "job") run_job(message);
      if (type == "drain" || type == "stop") break;
    }
    return 0;
  }

 private:
  void say_hello() {
    Json hello{{"type", "hello"}, {"protocol", 1}, {"program", "fake-engine"}, {"engine", engine()}};
    if (takes_ahead_) hello["ahead"] = true;
    channel_.send(hello);
  }

  // Returns false if the owner is gone.
  bool next(Json& message) {
    if (waiting_job_) {
      message = *std::exchange(waiting_job_, std::nullopt);
      return true;
    }
    return channel_.receive(message, milliseconds(-1)) == FrameChannel::Status::message;
  }

  // Waits for what the owner says while a job runs. A further job is kept, and the wait continues.
  FrameChannel::Status hear(Json& message, milliseconds patience) {
    const auto end = steady_clock::now() + patience;
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
      const FrameChannel::Status status = channel_.receive(message, std::max(milliseconds(0), left));
      if (status != FrameChannel::Status::message || message.at("type") != "job") return status;
      if (!takes_ahead_ || waiting_job_) throw FrameError("one job too many");
      waiting_job_ = message;
    }
  }

  void validate(const Json& message) {
    const Json::json_pointer viscosity("/fluid/viscosity");
    const Json& scene = message.at("scene");
    if (scene.contains(viscosity) && scene.at(viscosity).is_number() && scene.at(viscosity) <= 0) {
      channel_.send({{"type", "refused"},
                     {"request", message.at("request")},
                     {"pointer", viscosity.to_string()},
                     {"value", scene.at(viscosity).dump()},
                     {"allowed", "must be a number > 0"}});
      return;
    }
    const bool stepless = std::getenv("PECLET_FAKE_STEPLESS") != nullptr;
    channel_.send({{"type", "validated"},
                   {"observables", {"relative_viscosity"}},
                   {"request", message.at("request")},
                   {"timestep", stepless ? Json(nullptr) : Json(0.001)},
                   {"steps", steps_},
                   {"particles", 1},
                   {"derived", Json::object()},
                   {"warnings", Json::array()}});
  }

  void run_job(const Json& job) {
    const auto begun = steady_clock::now();
    const std::string point = job.at("point");
    const int seed = job.at("seed");
    const std::filesystem::path checkpoint(job.at("checkpoint").get<std::string>());
    const Fault fault = fault_of(point, seed, count_try(job.at("failures").get<std::string>(), point, seed));
    State state{mix(first_bits(point) ^ static_cast<std::uint64_t>(seed)), 0};
    if (std::filesystem::exists(checkpoint)) {
      const Json saved = Json::parse(read_file(checkpoint));
      state = {saved.at("value").get<std::uint64_t>(), saved.at("step").get<int>()};
    }
    if (std::getenv("PECLET_FAKE_DRIFT") != nullptr) state.value = mix(state.value);
    auto saved = begun, told = begun;
    for (; state.step < steps_; ++state.step) {
      if (state.step >= fault_step_) go_wrong(fault, job);
      if (told_to_leave(job, state, checkpoint)) return;
      state.value = mix(state.value + static_cast<std::uint64_t>(state.step));
      std::fputs(printed_.c_str(), stderr);
      const auto now = steady_clock::now();
      if (std::chrono::duration<double>(now - told).count() >= job.at("progress_seconds").get<double>()) {
        told = now;
        progress(job, state.step + 1);
      }
      if (std::chrono::duration<double>(now - saved).count() >= job.at("checkpoint_seconds").get<double>()) {
        saved = now;
        save(job, {state.value, state.step + 1}, checkpoint);
      }
    }
    finish(job, state, fault, begun);
    note_times(begun);
  }

  void go_wrong(Fault fault, const Json& job) {
    if (fault == Fault::crash) std::abort();
    if (fault == Fault::exit) std::_Exit(3);
    if (fault == Fault::kill) kill(getpid(), SIGKILL);
    if (fault == Fault::garble && write(0, "this is no frame", 16) < 0) std::abort();
    if (fault == Fault::rehello) say_hello();
    if (fault == Fault::hang || fault == Fault::garble || fault == Fault::rehello) {
      for (;;) {
        std::this_thread::sleep_for(milliseconds(20));
        if (fault == Fault::hang) progress(job, fault_step_);  // alive, but without a new step
      }
    }
  }

  void progress(const Json& job, int step) {
    channel_.send({{"type", "progress"},
                   {"job", job.at("job")},
                   {"phase", "production"},
                   {"step", step},
                   {"steps", steps_},
                   {"strain", 0.1 * step}});
  }

  bool is_held(const Json& job, const State& state) const {
    return !hold_.empty() && job.at("seed").get<int>() >= hold_seed_ && state.step >= half_ &&
           std::filesystem::exists(hold_);
  }

  // Waits for one step's time, or as long as the job is held, and hears the owner meanwhile.
  bool told_to_leave(const Json& job, const State& state, const std::filesystem::path& checkpoint) {
    Json message;
    FrameChannel::Status status = hear(message, step_time_);
    while (status == FrameChannel::Status::nothing && is_held(job, state)) {
      status = hear(message, milliseconds(5));
    }
    if (status == FrameChannel::Status::nothing) return false;
    leave_ = true;
    if (status == FrameChannel::Status::message && message.at("type") == "stop") return true;
    save(job, state, checkpoint);
    if (status == FrameChannel::Status::message) {
      leave_ = false;
      give_back(job, state);
    }
    return true;
  }

  // Becomes idle. Another drain follows, on which it leaves, or a job.
  void give_back(const Json& job, const State& state) {
    waiting_job_.reset();
    channel_.send({{"type", "drained"}, {"job", job.at("job")}, {"step", state.step}});
  }

  // If there is no room, the work continues and the last checkpoint stays.
  void save(const Json& job, const State& state, const std::filesystem::path& checkpoint) {
    try {
      write_durably(checkpoint, Json{{"value", state.value}, {"step", state.step}}.dump());
    } catch (const NoRoomError& error) {
      if (!leave_) say_no_room(job, error);
    }
  }

  void say_no_room(const Json& job, const NoRoomError& error) {
    channel_.send({{"type", "no-room"},
                   {"job", job.at("job")},
                   {"path", error.path().string()},
                   {"bytes", error.bytes()}});
  }

  // Leaves files beside the result, which lists them. Returns false if the engine has to leave before.
  bool leave_files(const Json& job, const State& state, Fault fault, Json& result) {
    for (int number = 0; number < files_; ++number) {
      const std::string name = "state-" + std::to_string(number) + ".txt";
      const std::string text = std::to_string(mix(state.value + static_cast<std::uint64_t>(number))) + '\n';
      if (fault != Fault::lose && !spool(job, job.at("files").get<std::string>() + name,
                                         fault == Fault::tamper ? "something else" : text)) {
        return false;
      }
      result["files"].push_back({{"name", fault == Fault::escape ? "../" + name : name},
                                 {"bytes", fault == Fault::tamper ? 14 : text.size()},
                                 {"sha256", sha256(text)}});
    }
    return true;
  }

  // Keeps the text until there is room for it. Returns false if the engine has to leave before.
  bool spool(const Json& job, const std::string& path, const std::string& text) {
    for (;;) {
      try {
        write_durably(path, text);
        return true;
      } catch (const NoRoomError& error) {
        say_no_room(job, error);
        Json message;
        const FrameChannel::Status status = hear(message, milliseconds(200));
        if (status == FrameChannel::Status::nothing) continue;
        leave_ = status == FrameChannel::Status::closed || message.at("type") == "stop";
        return false;
      }
    }
  }

  // Notes how long a job took, independently of the owner.
  static void note_times(steady_clock::time_point begun) {
    const char* const path = std::getenv("PECLET_FAKE_TIMES");
    if (path == nullptr) return;
    const auto nanoseconds = [](steady_clock::time_point time) {
      return std::to_string(std::chrono::nanoseconds(time.time_since_epoch()).count());
    };
    std::ofstream(path, std::ios::app) << nanoseconds(begun) + ' ' + nanoseconds(steady_clock::now()) + '\n';
  }

  void finish(const Json& job, const State& state, Fault fault, steady_clock::time_point begun) {
    const double wall_seconds = std::chrono::duration<double>(steady_clock::now() - begun).count();
    if (fault == Fault::refuse) {
      channel_.send(
          {{"type", "failed"}, {"job", job.at("job")}, {"message", "this engine does not want to"}});
      return;
    }
    Json result = outcome(job, state, fault == Fault::overlap);
    result["cost"] = {{"cpu_seconds", wall_seconds}, {"wall_seconds", wall_seconds}};
    if (fault == Fault::swap) result["seed"] = job.at("seed").get<int>() + 1;
    if (fault != Fault::overlap && !leave_files(job, state, fault, result)) {
      if (!leave_) give_back(job, state);
      return;
    }
    std::string text = result.dump();
    // JSON has no NaN; an engine that prints it all the same does not write JSON.
    if (fault == Fault::nan)
      text.replace(text.find("\"relative_viscosity\":"), 21, "\"relative_viscosity\":nan,\"x\":");
    const Json frame{{"type", "result"},
                     {"job", job.at("job")},
                     {"spool", job.at("spool")},
                     {"sha256", sha256(fault == Fault::lie ? "something else" : text)}};
    if (fault == Fault::early) announce(frame, fault);
    if (!spool(job, job.at("spool"), text)) {
      if (!leave_) give_back(job, state);
      return;
    }
    if (fault == Fault::mute) std::abort();
    announce(frame, fault);
    if (fault == Fault::twice) channel_.send(frame);
    if (fault == Fault::late) progress(job, steps_);
  }

  void announce(const Json& frame, Fault fault) {
    if (fault == Fault::truncate) {
      const std::string bytes = encode_frame(frame);
      if (write(0, bytes.data(), bytes.size() / 2) < 0) std::abort();
      std::_Exit(0);
    }
    if (fault == Fault::oversize && write(0, "PCF1\x00\x00\x40\x06", 8) < 0) std::abort();
    channel_.send(frame);
  }

  FrameChannel channel_{0};
  int steps_ = static_cast<int>(setting("PECLET_FAKE_STEPS", 10));
  int half_ = steps_ / 2;
  int fault_step_ = static_cast<int>(setting("PECLET_FAKE_FAULT_STEP", half_));
  const int files_ = static_cast<int>(setting("PECLET_FAKE_FILES", 0));
  milliseconds step_time_{static_cast<int>(setting("PECLET_FAKE_STEP_MS", 0))};
  const std::filesystem::path hold_ = text_setting("PECLET_FAKE_HOLD");
  const int hold_seed_ = static_cast<int>(setting("PECLET_FAKE_HOLD_SEED", 0));
  const std::string printed_ = std::string(static_cast<std::size_t>(setting("PECLET_FAKE_PRINTED", 0)), 'x');
  const bool takes_ahead_ = std::getenv("PECLET_FAKE_AHEAD") != nullptr;
  std::optional<Json> waiting_job_;  // a job that came while another one ran
  bool leave_ = false;
};

}  // namespace
}  // namespace peclet::fake

int main() {
  try {
    return peclet::fake::Engine().run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fake engine: %s\n", error.what());
    return 1;
  }
}
