#include "runner/scene_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "contract/input_error.h"
#include "runner/blame.h"

namespace peclet::runner {
namespace {

constexpr std::chrono::minutes patience{1};

// Somebody may kill the engine that is asked; that says nothing about the scenes.
constexpr int most_tries = 10;
struct KilledFromOutside {};

// What an engine prints while it is asked, in memory: nothing may be written before the scenes are known to
// be sound.
class Printed {
 public:
  Printed() : descriptor_(memfd_create("peclet engine", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  }
  ~Printed() { close(descriptor_); }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;

  // A name that the child can open too, until it becomes the engine.
  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  std::string last_lines() const {
    constexpr std::size_t most_lines = 5;
    std::string text = read_file(path());
    while (text.ends_with('\n')) text.pop_back();
    std::size_t begin = text.size();
    for (std::size_t lines = 0; lines < most_lines && begin != std::string::npos && begin > 0; ++lines)
      begin = text.rfind('\n', begin - 1);
    return begin == std::string::npos ? text : text.substr(begin == 0 ? 0 : begin + 1);
  }

 private:
  int descriptor_;
};

// One engine that is asked questions.
class Conversation {
 public:
  explicit Conversation(const EngineCommand& command)
      : command_(command), process_(command, printed_.path()), channel_(process_.descriptor()) {
    const Json hello = receive();
    if (hello.at("type") != "hello" || hello.at("protocol") != 1) {
      unsuitable("does not say hello in protocol 1");
    }
    identity_ = hello.at("engine");
  }

  Json ask(const Json& question) {
    try {
      channel_.send(question);
    } catch (const std::system_error&) {
      gone();
    }
    return receive();
  }

  const Json& identity() const { return identity_; }

 private:
  Json receive() {
    Json message;
    try {
      switch (channel_.receive(message, patience)) {
        case FrameChannel::Status::message:
          return message;
        case FrameChannel::Status::nothing:
          unsuitable("does not answer");
        case FrameChannel::Status::closed:
          gone();
      }
    } catch (const FrameError& error) {
      unsuitable(error.what());
    } catch (const std::system_error&) {
      gone();
    }
    return message;
  }

  [[noreturn]] void gone() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (std::chrono::steady_clock::now() < end) {
      if (const std::optional<ExitStatus> ending = process_.reap()) {
        if (outcome_of(*ending) == AttemptOutcome::killed) throw KilledFromOutside{};
        unsuitable("left without an answer, with " + to_string(*ending));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    unsuitable("hung up without an answer");
  }

  [[noreturn]] void unsuitable(const std::string& why) const {
    const std::string printed = printed_.last_lines();
    throw std::runtime_error(fmt::format("{}: {}; is it an engine that speaks peclet's frames?{}",
                                         command_.program.string(), why,
                                         printed.empty() ? "" : " It printed:\n" + printed));
  }

  EngineCommand command_;
  Printed printed_;
  EngineProcess process_;
  FrameChannel channel_;
  Json identity_;
};

// An engine that says what it will measure spares us the first seed of a misspelt observable.
void check_observable(const Json& answer, const Campaign& campaign,
                      const std::filesystem::path& campaign_file) {
  if (!answer.contains("observables")) return;
  const auto names = answer.at("observables").get<std::vector<std::string>>();
  const std::string& wanted = campaign.target.observable;
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return;
  throw InputError(campaign_file.string(), "/target/observable", wanted,
                   fmt::format("must be a number that the results will have: {}", fmt::join(names, ", ")));
}

SceneAnswer read_answer(const Json& message, const Json& identity) {
  SceneAnswer answer;
  if (const Json& timestep = message.at("timestep"); !timestep.is_null())
    answer.timestep = timestep.get<double>();
  answer.steps = message.at("steps").get<double>();
  answer.particles = message.at("particles").get<std::int64_t>();
  answer.derived = message.at("derived");
  for (const Json& warning : message.at("warnings")) answer.warnings.push_back(warning.at("message"));
  answer.identity = identity;
  return answer;
}

std::vector<SceneAnswer> ask_once(const Campaign& campaign, const std::filesystem::path& campaign_file,
                                  const EngineCommand& command) {
  Conversation engine(command);
  std::vector<SceneAnswer> answers;
  for (const StatePoint& point : campaign.points) {
    const Json answer =
        engine.ask({{"type", "validate"}, {"request", answers.size()}, {"scene", point.scene}});
    if (answer.at("type") == "refused") {
      const std::string of_point = point.label.empty() ? "" : fmt::format(" (in the point {})", point.label);
      throw InputError("", answer.at("pointer").get<std::string>(), answer.at("value").get<std::string>(),
                       answer.at("allowed").get<std::string>() + of_point)
          .within(campaign_file.string(), "/scene");
    }
    check_observable(answer, campaign, campaign_file);
    answers.push_back(read_answer(answer, engine.identity()));
  }
  return answers;
}

}  // namespace

std::vector<SceneAnswer> check_scenes(const Campaign& campaign, const std::filesystem::path& campaign_file,
                                      const EngineCommand& command) {
  for (int tries = 1; tries < most_tries; ++tries) {
    try {
      return ask_once(campaign, campaign_file, command);
    } catch (const KilledFromOutside&) {
      continue;
    } catch (const Json::exception& error) {
      throw std::runtime_error(
          fmt::format("{}: gives an answer of the wrong form: {}", command.program.string(), error.what()));
    }
  }
  throw std::runtime_error(command.program.string() + ": is killed again and again before it can answer");
}

std::vector<double> particle_steps(const std::vector<SceneAnswer>& answers) {
  std::vector<double> work;
  for (const SceneAnswer& answer : answers) {
    work.push_back(answer.steps * static_cast<double>(answer.particles));
    if (!(work.back() > 0)) return {};
  }
  return work;
}

}  // namespace peclet::runner
