#include "runner/engines/scene_check.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include "contract/documents.h"
#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/frames.h"
#include "contract/json.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/worker_process.h"
#include "runner/statistics/quantities.h"
#include "runner/store/blame.h"
#include "runner/store/realisation_result.h"

namespace peclet::runner {

namespace {

constexpr std::chrono::minutes patience{1};
// Interval at which the engine's output is checked for its length.
constexpr std::chrono::milliseconds glance{20};

// Tries with an engine that is killed from outside, which says nothing about the scenes.
constexpr int most_tries = 10;
struct KilledFromOutside {};

// The output of an engine that is asked, in memory: nothing is written before scenes are known to be valid.
class Printed {
 public:
  Printed() : file_(memfd_create("peclet engine", MFD_CLOEXEC)) {
    if (file_.number() < 0 || fcntl(file_.number(), F_SETFL, O_APPEND) != 0)
      throw std::system_error(errno, std::generic_category(), "memfd_create");
  }

  const Descriptor& file() const { return file_; }

  // Drops the output if it is longer than 1 MiB, because an engine may print without end.
  void keep_short() const {
    struct stat about {};
    constexpr off_t longest = 1 << 20;
    if (fstat(file_.number(), &about) == 0 && about.st_size > longest && ftruncate(file_.number(), 0) != 0) {
      throw std::system_error(errno, std::generic_category(), "ftruncate");
    }
  }

  std::string last_lines() const {
    constexpr std::size_t most_lines = 5, longest_line = 80;
    std::string lines;
    std::size_t count = 0;
    const std::string text = end();
    for (std::string_view rest = text; !rest.empty() && count < most_lines; ++count) {
      while (rest.ends_with('\n')) rest.remove_suffix(1);
      const std::size_t before = rest.rfind('\n');
      const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
      lines = plain(rest.substr(begin), longest_line) + (lines.empty() ? "" : "\n") + lines;
      rest = rest.substr(0, begin);
    }
    return lines;
  }

 private:
  std::string end() const {
    std::string text(4096, '\0');
    struct stat about {};
    if (fstat(file_.number(), &about) != 0) return "";
    const off_t begin = std::max<off_t>(0, about.st_size - static_cast<off_t>(text.size()));
    const ssize_t count = pread(file_.number(), text.data(), text.size(), begin);
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return text;
  }

  Descriptor file_;
};

// An engine process that answers questions.
class Conversation {
 public:
  explicit Conversation(const EngineCommand& command)
      : command_(command),
        process_(command, printed_.file()),
        channel_(process_.descriptor(), largest_answer) {
    Json hello = receive();
    if (hello.at("type") != "hello" || hello.value("protocol", Json()) != 1) {
      unsuitable("does not say hello in protocol 1");
    }
    hello = checked_frame(std::move(hello));
    identity_ = hello["engine"];
    capacity_ = hello["capacity"].get<int>();
    words_ = std::make_shared<const Vocabulary>(hello);
    try {
      engine_identity(identity_);
    } catch (const ResultError& error) {
      unsuitable(fmt::format("does not say what it is: {}", error.what()));
    }
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
  int capacity() const { return capacity_; }
  const std::shared_ptr<const Vocabulary>& words() const { return words_; }

 private:
  Json receive() {
    Json message;
    try {
      const auto end = std::chrono::steady_clock::now() + patience;
      while (std::chrono::steady_clock::now() < end) {
        const FrameChannel::Status status = channel_.receive(message, glance);
        if (status == FrameChannel::Status::message) return message;
        if (status == FrameChannel::Status::closed) gone();
        printed_.keep_short();
      }
      unsuitable("does not answer");
    } catch (const FrameError& error) {
      unsuitable(plain(error.what()));
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
  int capacity_ = 1;
  std::shared_ptr<const Vocabulary> words_;
};

// Returns " of the point peclet=10", or "" if it is the only point.
std::string of_point(const Campaign& campaign, const StatePoint& point) {
  return campaign.points.size() == 1 ? "" : " of the point " + printable(point.label, 60);
}

// Throws InputError for an observable that the engine will not measure, if the engine says what it measures.
void check_observables(const Json& answer, const Campaign& campaign, const StatePoint& point,
                       const fs::path& campaign_file) {
  if (!answer.contains("observables")) return;
  const auto known = answer["observables"].get<std::vector<std::string>>();
  for (const std::string& wanted : campaign.target.observables()) {
    const auto is_it = [&](const std::string& pattern) { return matches(pattern, wanted); };
    if (std::any_of(known.begin(), known.end(), is_it)) continue;
    const std::string must =
        fmt::format("must be a number that the results{} will have: ", of_point(campaign, point));
    const Json hints = answer.value("hints", Json::object());
    for (const auto& [name, hint] : hints.items()) {
      if (wanted != name && !wanted.starts_with(name + '/')) continue;
      throw InputError(campaign_file.string(), pointer_of(campaign.target, wanted), wanted,
                       must + fmt::format("{} {}", wanted, hint.get_ref<const std::string&>()));
    }
    throw InputError(campaign_file.string(), pointer_of(campaign.target, wanted), wanted,
                     fmt::format("{}{}{}", must, fmt::join(known, ", "), suggestion(wanted, known)));
  }
}

SceneAnswer read_answer(const Json& message, const Json& identity) {
  constexpr std::size_t longest_warning = 1000;
  SceneAnswer answer;
  if (!message["timestep"].is_null()) answer.timestep = message["timestep"].get<double>();
  if (message.contains("timestep_limit"))
    answer.timestep_limit = plain(message["timestep_limit"].get<std::string>(), longest_warning);
  answer.steps = message["steps"].get<double>();
  answer.particles = message["particles"].get<std::int64_t>();
  answer.derived = message["derived"];
  for (const auto& [name, value] : answer.derived.items()) {
    if (plain(name) != name) throw FrameError("/derived: must have names without control characters");
  }
  for (const Json& warning : message["warnings"]) {
    answer.warnings.push_back(plain(warning["message"].get<std::string>(), longest_warning));
  }
  answer.identity = identity;
  return answer;
}

std::vector<SceneAnswer> ask_once(const Campaign& campaign, const fs::path& campaign_file,
                                  const EngineCommand& command) {
  Conversation engine(command);
  std::vector<SceneAnswer> answers;
  for (const StatePoint& point : campaign.points) {
    const Json answer = checked_frame(engine.ask({{"type", "validate"},
                                                  {"request", answers.size()},
                                                  {"scene", point.scene},
                                                  {"seeds", campaign.maximum_realisations}}));
    if (answer["type"] == "refused") {
      const std::string where =
          point.label.empty() ? "" : fmt::format(" (in the point {})", printable(point.label, 60));
      throw InputError("", answer["pointer"].get<std::string>(), answer["value"].get<std::string>(),
                       answer["allowed"].get<std::string>() + where)
          .within(campaign_file.string(), "/scene");
    }
    if (answer["type"] != "validated") throw FrameError("neither \"validated\" nor \"refused\"");
    check_observables(answer, campaign, point, campaign_file);
    answers.push_back(read_answer(answer, engine.identity()));
    answers.back().words = engine.words();
    answers.back().capacity = engine.capacity();
  }
  return answers;
}

using Clock = std::chrono::steady_clock;

class Trial {
 public:
  Trial(const Json& scene, int seeds) : scene_(scene), seeds_(seeds) {}

  // Returns false if the trial is over.
  bool hear(const WorkerEvent& event, WorkerPool& pool, const CampaignDirectory& directory) {
    if (const auto* const hello = std::get_if<Hello>(&event)) {
      for (int seed = 0; seed < std::min(seeds_, hello->capacity); ++seed)
        pool.assign(0, job(directory, seed));
      begun_ = Clock::now();
      return true;
    }
    if (is_of_another_seed(event)) return true;
    if (const auto* progressed = std::get_if<Progressed>(&event)) return hear(*progressed);
    if (const auto* spooled = std::get_if<ResultSpooled>(&event)) {
      found_.seconds.reset();
      const Json ending = checked_part(read_json(spooled->spool), "")["ending"];
      const auto cause = ending["cause"].get<std::string>();
      if (has_results(cause)) {
        found_.seconds = since_begun();
      } else {
        found_.broke_off = plain(fmt::format("{}: {}", cause, ending.value("message", "")));
      }
    }
    return false;
  }
  bool is_late() const { return since_begun() > longest; }
  const CostTrial& found() const { return found_; }

 private:
  static constexpr double long_enough = 2, longest = 10;

  static bool is_of_another_seed(const WorkerEvent& event) {
    return std::visit(
        [](const auto& happened) {
          if constexpr (requires { happened.job; }) {
            return happened.job != 1;
          } else {
            return false;
          }
        },
        event);
  }

  bool hear(const Progressed& progressed) {
    // The steps of packing are not those of the realisation.
    if (progressed.step == 0 || progressed.steps == 0 || progressed.phase == 0) return true;
    if (!first_) {
      first_ = progressed.step;
      first_after_ = since_begun();
      return true;
    }
    const double measured = since_begun() - first_after_;
    const auto steps = static_cast<double>(progressed.step - *first_);
    if (steps <= 0) return true;
    found_.seconds = first_after_ + measured / steps * static_cast<double>(progressed.steps - *first_);
    return since_begun() < long_enough;
  }
  double since_begun() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  Job job(const CampaignDirectory& directory, int seed) const {
    Job job;
    job.attempt = seed + 1;
    job.point = sha256(canonical_json(scene_));
    job.seed = seed;
    job.scene = scene_;
    job.checkpoint = directory.checkpoint(job.point, seed);
    job.spool = directory.spool_file(job.point, seed, job.attempt);
    job.failures = directory.failures();
    job.progress_seconds = 0.2;
    return job;
  }

  const Json& scene_;
  int seeds_;
  Clock::time_point begun_ = Clock::now();
  std::optional<std::int64_t> first_;
  double first_after_ = 0;
  CostTrial found_;
};

}  // namespace

std::vector<SceneAnswer> check_scenes(const Campaign& campaign, const fs::path& campaign_file,
                                      const EngineCommand& command) {
  for (int tries = 1; tries < most_tries; ++tries) {
    try {
      return ask_once(campaign, campaign_file, command);
    } catch (const KilledFromOutside&) {
      continue;
    } catch (const FrameError& error) {
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

CostTrial try_cost(const Json& scene, const EngineCommand& command, int seeds) {
  const ScratchFolder folder("peclet-trial");
  const CampaignDirectory directory(folder.path());
  create_folders(directory);
  StopSignals signals;
  ProcessPool pool({command}, directory, signals);
  Trial trial(scene, seeds);
  pool.start(0);
  bool goes_on = true;
  while (goes_on && !trial.is_late()) {
    for (const WorkerEvent& event : pool.wait(std::chrono::milliseconds(100))) {
      goes_on = goes_on && trial.hear(event, pool, directory);
    }
  }
  pool.kill(0);
  return trial.found();
}

}  // namespace peclet::runner
