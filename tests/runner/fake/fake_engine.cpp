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
//   PECLET_FAKE_CAPACITY (1)                            number of jobs that it runs at once, each a step in
//   turn;
//                                                       above 1, jobs miss turns, so that later ones may end
//                                                       first
//   PECLET_FAKE_NO_DEVICE                               if set, it refuses PECLET_DEVICE=cuda
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
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <list>
#include <stdexcept>
#include <thread>

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

// A job that runs.
struct Running {
  Json job;
  std::filesystem::path checkpoint;
  Fault fault;
  State state;
  steady_clock::time_point begun, saved, told;
};

class Engine {
 public:
  int run() {
    if (std::getenv("PECLET_FAKE_NO_DEVICE") != nullptr && text_setting("PECLET_DEVICE") == "cuda") {
      throw std::runtime_error("there is no device here");
    }
    say_hello();
    while (!leave_) {
      const bool is_idle = jobs_.empty() && waiting_.empty();
      hear(is_idle ? milliseconds(-1) : milliseconds(0));
      if (drained_ && jobs_.empty() && waiting_.empty()) break;
      begin_jobs();
      take_turn();
      if (drained_) give_all_back();
    }
    return 0;
  }

 private:
  void say_hello() {
    Json hello{{"type", "hello"}, {"protocol", 1}, {"program", "fake-engine"}, {"engine", engine()}};
    if (takes_ahead_) hello["ahead"] = true;
    if (capacity_ > 1) hello["capacity"] = capacity_;
    channel_.send(hello);
  }

  // Hears what the owner says until the patience ends; at least all that has been said.
  void hear(milliseconds patience) {
    const auto end = steady_clock::now() + patience;
    Json message;
    while (!leave_ && !drained_) {
      const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
      const auto status =
          channel_.receive(message, patience < milliseconds(0) ? patience : std::max(milliseconds(0), left));
      if (status == FrameChannel::Status::nothing) return;
      if (status == FrameChannel::Status::closed) {
        leave_ = true;
        for (const Running& one : jobs_) save(one);
      } else {
        handle(message);
      }
      patience = std::max(milliseconds(0), patience);
    }
  }

  void handle(const Json& message) {
    const std::string type = message.at("type");
    if (type == "validate") validate(message);
    if (type == "stop") leave_ = true;
    if (type == "drain") drained_ = true;
    if (type != "job") return;
    if (jobs_.size() + waiting_.size() >= capacity_ + (takes_ahead_ ? 1 : 0))
      throw FrameError("one job too many");
    waiting_.push_back(message);
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

  void begin_jobs() {
    while (!leave_ && !waiting_.empty() && jobs_.size() < capacity_) {
      const Json job = waiting_.front();
      waiting_.pop_front();
      begin(job);
    }
  }

  void begin(const Json& job) {
    const auto now = steady_clock::now();
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
    jobs_.push_back({job, checkpoint, fault, state, now, now, now});
  }

  // Each job makes a step, or ends.
  void take_turn() {
    bool is_waited_for = false;  // the time of a step, which is that of all jobs
    for (auto one = jobs_.begin(); one != jobs_.end() && !leave_ && !drained_;) {
      if (one->state.step < steps_) {
        if (one->state.step >= fault_step_) go_wrong(one->fault, one->job);
        if (!is_waited_for) wait_for_a_step();
        is_waited_for = true;
        if (leave_ || drained_) return;
        if (!misses_turn(*one)) advance(*one);
        ++one;
      } else {
        if (!finish(*one)) return;
        note_times(one->begun);
        one = jobs_.erase(one);
      }
    }
  }

  // Waits for one step's time, or as long as all jobs are held, and hears the owner meanwhile.
  void wait_for_a_step() {
    const std::size_t known = waiting_.size();
    hear(step_time_);
    const auto held = [this](const Running& one) { return is_held(one); };
    while (!leave_ && !drained_ && waiting_.size() == known &&
           std::all_of(jobs_.begin(), jobs_.end(), held)) {
      hear(milliseconds(5));
    }
  }

  bool misses_turn(const Running& one) {
    if (is_held(one)) return true;
    return capacity_ > 1 && mix(one.state.value + ++turns_) % 2 == 0;
  }

  void advance(Running& one) {
    State& state = one.state;
    state.value = mix(state.value + static_cast<std::uint64_t>(state.step));
    ++state.step;
    std::fputs(printed_.c_str(), stderr);
    const auto now = steady_clock::now();
    const auto is_due = [&](steady_clock::time_point last, const char* interval) {
      return std::chrono::duration<double>(now - last).count() >= one.job.at(interval).get<double>();
    };
    if (is_due(one.told, "progress_seconds")) {
      one.told = now;
      progress(one.job, state.step);
    }
    if (is_due(one.saved, "checkpoint_seconds")) {
      one.saved = now;
      save(one);
    }
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

  bool is_held(const Running& one) const {
    return !hold_.empty() && one.job.at("seed").get<int>() >= hold_seed_ && one.state.step >= half_ &&
           std::filesystem::exists(hold_);
  }

  // Becomes idle. Another drain follows, on which it leaves, or a job.
  void give_all_back() {
    begin_jobs();  // a job that has a place is answered
    waiting_.clear();
    for (const Running& one : jobs_) {
      if (one.state.step < steps_) save(one);
      channel_.send({{"type", "drained"}, {"job", one.job.at("job")}, {"step", one.state.step}});
    }
    leave_ = jobs_.empty();  // the last one ended
    jobs_.clear();
    drained_ = false;
  }

  // If there is no room, the work continues and the last checkpoint stays.
  void save(const Running& one) {
    try {
      write_durably(one.checkpoint, Json{{"value", one.state.value}, {"step", one.state.step}}.dump());
    } catch (const NoRoomError& error) {
      if (!leave_) say_no_room(one.job, error);
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

  // Keeps the text until there is room for it. Returns false if the job is given up before.
  bool spool(const Json& job, const std::string& path, const std::string& text) {
    for (;;) {
      try {
        write_durably(path, text);
        return true;
      } catch (const NoRoomError& error) {
        say_no_room(job, error);
        hear(milliseconds(200));
        if (leave_ || drained_) return false;
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

  // Returns false if the job is given up before its result is on disk.
  bool finish(const Running& one) {
    const Json& job = one.job;
    const State& state = one.state;
    const Fault fault = one.fault;
    const double wall_seconds = std::chrono::duration<double>(steady_clock::now() - one.begun).count();
    if (fault == Fault::refuse) {
      channel_.send(
          {{"type", "failed"}, {"job", job.at("job")}, {"message", "this engine does not want to"}});
      return true;
    }
    Json result = outcome(job, state, fault == Fault::overlap);
    result["cost"] = {{"cpu_seconds", wall_seconds}, {"wall_seconds", wall_seconds}};
    if (fault == Fault::swap) result["seed"] = job.at("seed").get<int>() + 1;
    if (fault != Fault::overlap && !leave_files(job, state, fault, result)) return false;
    std::string text = result.dump();
    // JSON has no NaN; an engine that prints it all the same does not write JSON.
    if (fault == Fault::nan)
      text.replace(text.find("\"relative_viscosity\":"), 21, "\"relative_viscosity\":nan,\"x\":");
    const Json frame{{"type", "result"},
                     {"job", job.at("job")},
                     {"spool", job.at("spool")},
                     {"sha256", sha256(fault == Fault::lie ? "something else" : text)}};
    if (fault == Fault::early) announce(frame, fault);
    if (!spool(job, job.at("spool"), text)) return false;
    if (fault == Fault::mute) std::abort();
    announce(frame, fault);
    if (fault == Fault::twice) channel_.send(frame);
    if (fault == Fault::late) progress(job, steps_);
    return true;
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
  const std::size_t capacity_ = static_cast<std::size_t>(setting("PECLET_FAKE_CAPACITY", 1));
  std::list<Running> jobs_;
  std::deque<Json> waiting_;  // jobs that have not begun
  std::uint64_t turns_ = 0;
  bool leave_ = false, drained_ = false;
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
